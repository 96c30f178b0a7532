//! Error against run time, with the Pareto front.

use super::study::Study;
use granular_io::figure::{Axis, Chart, Series, Style};

pub(super) fn chart(study: &Study) -> Chart {
    let title = format!("Error against run time: {}", study.case);
    let mut chart = Chart::new(title, Axis::log("wall time of a run [s]"), Axis::log(study.error));
    for problem in study.problems() {
        let best = study.points.iter().filter(|point| point.pareto && point.problem == problem);
        let mut front: Vec<[f64; 2]> = best.map(|point| [point.seconds, point.error]).collect();
        front.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let name = if problem.is_empty() { "Pareto front" } else { &format!("Pareto front, {problem}") };
        chart = chart.with(Series::new(name, front, Style::Dashed).colour(7));
    }
    for (colour, scheme) in study.schemes().into_iter().enumerate() {
        let points: Vec<_> = study.points.iter().filter(|point| point.scheme == scheme).collect();
        let places = points.iter().map(|point| [point.seconds, point.error]).collect::<Vec<_>>();
        let bands = points.iter().map(|point| point.band).collect();
        let order = study.orders.get(scheme).map_or(String::new(), |order| format!(", order {order:.2}"));
        let banded = points.iter().any(|point| point.band > 0.0);
        // A scheme may have one point only.
        let style = if banded { Style::Line } else { Style::LineAndMarkers };
        let line = Series::new(format!("{scheme}{order}"), places.clone(), style);
        chart = chart.with(line.colour(colour));
        if banded {
            chart = chart.with(Series::new("", places, Style::ErrorBars(bands)).colour(colour));
        }
    }
    chart
}
