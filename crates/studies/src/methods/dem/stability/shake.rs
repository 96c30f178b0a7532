//! Steps samples of grains, and tells whether they stay calm, are stopped, or make no sense unnoticed.

use crate::validate::stability::watch::End;
use granular_core::{Solver, StepError};
use granular_dem::{Dem2, Shape};

/// Steps of a sample at rest: what grows by a hundredth in each is seen.
const STEPS: u64 = 3000;
/// Steps between looks.
const BURST: u64 = 50;
/// Kinetic energy over that of the contacts at rest from which a sample shakes.
const SHAKES: f64 = 0.1;
/// Bytes that the lists of a few hundred grains may take.
pub(super) const MOST_BYTES: usize = 4 << 20;

/// Takes steps from rest; a step that is too long shakes the sample by itself.
pub(super) fn shake(dem: &mut Dem2, dt: f64, energy: f64) -> End {
    // Beyond the limit is where this looks.
    dem.allow_any_step();
    for burst in 1..=STEPS / BURST {
        if let Some(end) = take(dem, dt, BURST) {
            return end;
        }
        let energies = dem.energies();
        let share = (energies.translational() + energies.rotational) / energy;
        if share > SHAKES {
            return End::Stopped(format!(
                "it shakes by itself, kinetic over contact energy {share:.2} after {} steps",
                burst * BURST
            ));
        }
    }
    End::Finished
}

/// Takes so many steps at most; the run is to end, or to be stopped with a reason.
pub(super) fn finishes(dem: &mut Dem2, dt: f64, steps: u64) -> End {
    let mut left = steps.max(1);
    while left > 0 {
        let burst = left.min(BURST);
        if let Some(end) = take(dem, dt, burst) {
            return end;
        }
        left -= burst;
    }
    End::Finished
}

/// How a run ended, if it did.
fn take(dem: &mut Dem2, dt: f64, steps: u64) -> Option<End> {
    match dem.advance(dt, steps) {
        Ok(()) => nonsense(dem).map(End::Missed),
        Err(error @ (StepError::TooStiff { .. } | StepError::NotFinite { .. })) => {
            Some(End::Stopped(error.to_string()))
        }
        Err(error) => Some(End::Missed(format!("the guard names nothing: {error}"))),
    }
}

/// What no guard has seen: motion that is not finite, a grain behind a wall.
fn nonsense(dem: &Dem2) -> Option<String> {
    for (id, grain) in dem.grains() {
        if !(grain.position.is_finite() && grain.velocity.is_finite() && grain.spin.is_finite()) {
            return Some(format!("the motion of grain {id} is not finite"));
        }
        for wall in dem.walls() {
            let is_plane = matches!(wall.shape, Shape::Plane { .. });
            if is_plane && wall.shape.distance(grain.position).0 < 0.0 {
                return Some(format!("grain {id} is behind wall `{}`", wall.name));
            }
        }
    }
    None
}
