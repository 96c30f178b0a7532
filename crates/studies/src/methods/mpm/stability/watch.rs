//! Steps bodies, and tells whether they stay calm, are stopped, or make no sense unnoticed.

use crate::validate::stability::watch::End;
use granular_core::{Solver, StepError};
use granular_mpm::Mpm2;

/// Steps between looks.
const BURST: u64 = 20;

/// Energy over that at the start from which what trembles gains by itself. Growth is exponential where a step is too long; schemes
/// that put stresses first gain a few hundredths.
pub(super) const TREMBLES: f64 = 2.0;
/// The same of what falls or flies apart. Velocities and stresses are half a step apart in two of the schemes, so that the sum of their
/// energies swings by a tenth where a step is half as long as it may be; it does not grow.
pub(super) const FALLS: f64 = 1.5;

/// Takes so many steps of what may be too long; what is stops it, or gains energy.
pub(super) fn gains(mpm: &mut Mpm2, dt: impl Fn(&Mpm2) -> f64, steps: u64, most: f64) -> End {
    // Beyond the limit is where this looks.
    mpm.allow_any_step();
    watched(mpm, dt, steps, most)
}

/// Takes so many recommended steps.
pub(super) fn finishes(mpm: &mut Mpm2, steps: u64, most: f64) -> End {
    watched(mpm, Mpm2::recommended_step, steps, most)
}

fn watched(mpm: &mut Mpm2, dt: impl Fn(&Mpm2) -> f64, steps: u64, most: f64) -> End {
    let (count, start) = (mpm.len(), energy(mpm));
    let mut taken = 0;
    while taken < steps {
        let burst = BURST.min(steps - taken);
        if let Err(error) = mpm.advance(dt(mpm), burst) {
            return named(&error);
        }
        taken += burst;
        if let Some(nonsense) = nonsense(mpm, count) {
            return End::Missed(nonsense);
        }
        let share = energy(mpm) / start;
        if share > most {
            return End::Stopped(format!(
                "it gains energy by itself, {share:.2} of the start after {taken} steps"
            ));
        }
    }
    End::Finished
}

/// Energy \[J/m\] but for the motion of the whole along a line, which no force changes here; in gravity all of it.
fn energy(mpm: &Mpm2) -> f64 {
    let energies = mpm.energies();
    if mpm.gravity().length() > 0.0 || !mpm.walls().is_empty() {
        return energies.mechanical();
    }
    let mean = mpm.momentum() / mpm.mass();
    let inner = |velocity: granular_core::glam::DVec2| 0.5 * (velocity - mean).length_squared();
    // Particles of one body have one mass.
    let each = mpm.mass() / mpm.len() as f64;
    let kinetic: f64 = mpm.particles().map(|(_, particle)| each * inner(particle.velocity)).sum();
    kinetic + energies.elastic
}

/// A guard says what it met; anything else is a guard that failed.
fn named(error: &StepError) -> End {
    match error {
        StepError::NotFinite { .. }
        | StepError::TooStiff { .. }
        | StepError::LeftDomain { .. }
        | StepError::Step { .. } => End::Stopped(error.to_string()),
        other => End::Missed(format!("the guard names nothing: {other}")),
    }
}

/// What no guard has seen.
fn nonsense(mpm: &Mpm2, count: usize) -> Option<String> {
    if mpm.len() != count {
        return Some(format!("{} of {count} particles are left", mpm.len()));
    }
    let wrong = mpm.particles().find(|(_, particle)| {
        let sum = particle.stress.trace() + particle.stress.xy;
        let is_finite = particle.position.is_finite() && particle.velocity.is_finite() && sum.is_finite();
        !(is_finite && particle.volume > 0.0)
    });
    wrong.map(|(id, _)| format!("particle {id} is not finite, or has no volume"))
}
