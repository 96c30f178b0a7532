//! The first mode of a bar that is held at one end, for one period.

use super::{About, Measured, Run, runs, study as study_of};
use crate::bench::study::Study;
use crate::methods::mpm::cases::Bar;
use crate::methods::mpm::names::said;
use granular_core::Solver;
use granular_driver::failure::Failure;
use granular_driver::statistics::root_mean_square;
use granular_mpm::Scheme;

/// Share of the time in which a wave crosses a cell that a step takes.
const COURANT: f64 = 0.2;
/// Looks in a period.
const LOOKS: u32 = 20;

pub(super) fn study() -> Result<Study, Failure> {
    let about = About {
        case: "vibrating-bar",
        error: "error of the velocity [-]",
        notes: vec![format!(
            "first mode of a bar of 25 m with waves of 10 m/s, strains of 1e-4, for one period; error: root mean square of \
             the velocities of particles, over particles and {LOOKS} times, over the largest speed; steps of {COURANT} of \
             the time in which a wave crosses a cell; velocities are those in the middle of steps"
        )],
    };
    study_of(about, &runs(&[10, 20, 40, 80, 160]), measure)
}

/// When velocities are those of, from the end of a step \[s\]: schemes are leapfrogs, in which velocities stand half a step before
/// stresses that follow them, and half a step after stresses that they follow. At the same time they would be off to first order.
fn level(scheme: Scheme, dt: f64) -> f64 {
    match scheme {
        Scheme::StressFirst => 0.5 * dt,
        Scheme::StressLast | Scheme::ModifiedStressLast => -0.5 * dt,
    }
}

pub(super) fn measure(run: &Run) -> Result<Measured, Failure> {
    let bar = Bar { mode: 1, shape: run.shape, scheme: run.when, cells: run.cells, along: run.along };
    let mut mpm = bar.build().map_err(said)?;
    let before = bar.particles();
    let look = bar.period() / f64::from(LOOKS);
    let steps = (look / (COURANT * bar.crossing())).ceil();
    let dt = look / steps;
    let start = mpm.energies().mechanical();
    let mut errors = Vec::new();
    for _ in 0..LOOKS {
        mpm.advance(dt, steps as u64)?;
        let time = mpm.time() + level(run.when, dt);
        errors.extend(mpm.particles().map(|(id, particle)| {
            let place = before[id as usize].position.x;
            (particle.velocity.x - bar.velocity(place, time)) / Bar::SPEED
        }));
    }
    let kept = mpm.energies().mechanical() / start - 1.0;
    let said = format!("energy after the period {:+.1e} of that at the start", kept);
    Ok(Measured { dt, error: root_mean_square(&errors), said })
}
