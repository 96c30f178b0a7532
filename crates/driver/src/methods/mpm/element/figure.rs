//! Stress and volume over strain, and the path of stress.

use super::outcome::Element;
use super::plan::Test;
use granular_constitutive::element::ElementState;
use granular_io::figure::{Axis, Chart, Figure, Panels, Series, Style};

/// Points of a curve; more cannot be told apart.
const POINTS: usize = 1000;

/// A panel for the stress over strain, one for the volume where it is not prescribed, one for the path of stress.
pub(super) fn figure(element: &Element, states: &[ElementState]) -> Figure {
    let test = element.plan.test;
    let every = states.len().div_ceil(POINTS);
    let last = states.len() - 1;
    let kept = states.iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last);
    let kept: Vec<&ElementState> = kept.map(|(_, state)| state).collect();
    let chart = |x: &str, y: &str, of: &dyn Fn(&ElementState) -> [f64; 2]| {
        let points = kept.iter().map(|state| of(state)).collect();
        let chart = Chart::new("", Axis::linear(x), Axis::linear(y));
        chart.with(Series::new("", points, Style::Line).colour(0))
    };
    let mut charts = vec![chart(test.strain_label(), test.stress_label(), &|state| {
        [test.strain(state), test.stress(state)]
    })];
    if test == Test::Oedometer {
        charts.push(chart(test.strain_label(), test.ratio_label(), &|state| {
            [test.strain(state), test.ratio(state)]
        }));
    } else {
        charts.push(chart(test.strain_label(), "volumetric strain [-]", &|state| {
            [test.strain(state), state.volumetric_strain]
        }));
    }
    charts.push(chart("mean pressure p [Pa]", "deviator stress q [Pa]", &|state| {
        [state.mean_pressure, state.deviator_stress]
    }));
    let columns = charts.len();
    let mut panels = Panels::new(element.title(), columns, charts);
    panels.size = [400.0, 340.0];
    panels.figure()
}
