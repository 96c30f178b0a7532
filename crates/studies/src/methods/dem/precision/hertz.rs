//! Restitution of elastic grains with damping: error against step and run time.

use super::restitution::{ROUNDS, Trial, measure};
use crate::bench::study::{CONTACT, Point, Study};
use crate::methods::dem::cases::hertz::{RESOLUTIONS, errors};
use crate::methods::dem::cases::strike::Strike;
use granular_core::{D2, D3, Dim, Solver, StepError};
use granular_dem::Tension;
use granular_driver::failure::Failure;
use granular_driver::statistics::order;
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// Restitution asked for, as in the study of linear contacts.
const RESTITUTION: f64 = 0.75;
/// Relative speed \[m/s\].
const SPEED: f64 = 0.1;

/// An impact in one dimension.
struct InDimension<D>(Strike, PhantomData<D>);

impl<D: Dim> Trial for InDimension<D> {
    fn dt(&self) -> f64 {
        self.0.dt::<D>()
    }

    fn resolution(&self) -> f64 {
        self.0.duration::<D>() / self.0.dt::<D>()
    }

    fn errors(&self, count: usize) -> Result<Vec<f64>, StepError> {
        errors::<D>(self.0, count)
    }

    fn begin(&self, gap: f64) -> (Box<dyn Solver>, u64) {
        (Box::new(self.0.grains::<D>(gap)), self.0.steps_needed::<D>(gap))
    }
}

pub(super) fn study() -> Result<Study, Failure> {
    let (mut points, mut orders) = (Vec::new(), BTreeMap::new());
    for (tension, name) in [(Tension::Cut, "tension cut"), (Tension::Kept, "tension kept")] {
        line::<D2>(tension, name, &mut points, &mut orders)?;
        line::<D3>(tension, name, &mut points, &mut orders)?;
    }
    let notes = vec![
        format!(
            "e = {RESTITUTION} at {SPEED} m/s; root mean square over random gaps; the band is its standard error"
        ),
        "no step divides the contact time; orders are least squares in the logarithms of step and error"
            .to_owned(),
        format!(
            "wall time of the steps of one impact of two grains on one thread, median of {ROUNDS} rounds"
        ),
    ];
    let error = "error of the restitution [-]";
    Ok(Study { case: "hertz", error, resolution: CONTACT, points, orders, notes }.mark_front())
}

fn line<D: Dim>(
    tension: Tension,
    name: &str,
    points: &mut Vec<Point>,
    orders: &mut BTreeMap<String, f64>,
) -> Result<(), Failure> {
    let scheme = format!("{}s, {name}", D::BALL);
    let mut curve = Vec::new();
    for steps in RESOLUTIONS {
        let strike = Strike::of_glass(RESTITUTION, tension, SPEED, steps);
        let point = measure(&InDimension::<D>(strike, PhantomData), &scheme)?;
        curve.push((point.dt, point.error));
        points.push(Point { problem: format!("{}s", D::BALL), ..point });
    }
    orders.insert(scheme, order(&curve));
    Ok(())
}
