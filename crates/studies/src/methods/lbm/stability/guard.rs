//! What makes no sense in the fields of a fluid.

use crate::validate::stability::watch::Watched;
use granular_core::{D2, StepError};
use granular_lbm::{D2Q9, Lbm, Lbm2};

impl Watched for Lbm2 {
    fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        let dt = self.setup().time_step;
        granular_core::Solver::advance(self, dt, steps)
    }

    fn nonsense(&self) -> Option<String> {
        nonsense(self)
    }
}

/// Density that is not positive, a speed of a cell a step or more, anything not finite.
fn nonsense(lbm: &Lbm<D2Q9, 9>) -> Option<String> {
    let setup: &granular_lbm::Setup<D2> = lbm.setup();
    let fastest = setup.lattice_speed();
    // Pressure at which nothing is left of the density.
    let void = -setup.density * fastest * fastest / 3.0;
    let [nx, ny, _] = setup.cells;
    for (x, y) in (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y))) {
        let Some(flow) = lbm.flow([x, y, 0]) else { continue };
        let (pressure, speed) = (flow.pressure, flow.velocity.length_squared().sqrt());
        // Not a number fails both comparisons.
        if !(pressure > void && pressure.is_finite() && speed < fastest) {
            return Some(format!("cell [{x}, {y}] has {pressure:.3e} Pa and {speed:.3e} m/s"));
        }
    }
    None
}
