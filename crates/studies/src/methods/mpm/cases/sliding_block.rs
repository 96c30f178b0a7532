//! A block at rest on a floor with friction, once gravity leans.

use crate::methods::mpm::names::{SHAPES, said};
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver};
use granular_driver::failure::Failure;
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};

const GRAVITY: f64 = 9.81;
/// Share of forces that damps, while the block comes to rest or is to stay so.
const DAMPING: f64 = 0.3;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for (name, shape) in SHAPES {
        for (degrees, friction) in [(30.0_f64, 0.466), (45.0, 0.1)] {
            let angle = degrees.to_radians();
            let expected = GRAVITY * (angle.sin() - friction * angle.cos());
            let [whole, level] = slide(degrees, friction, false, shape)?;
            let metric = format!("acceleration at {degrees} degrees, friction {friction}, {name} [m/s²]");
            let why = "it hops: while it rises the floor carries more than its weight";
            rows.add(Measure::relative(Tier::ClosedForm, metric, whole, expected, 0.05).note(why));
            let metric = format!("the same, had it kept its height, {name} [m/s²]");
            // With other shape functions than blocks part of its base sticks now and then.
            let allowed = if shape == ShapeFunctions::UniformGimp { 0.01 } else { 0.02 };
            rows.add(Measure::relative(Tier::ClosedForm, metric, level, expected, allowed));
        }
        // The arc tangent of 0.466 is 24.99 degrees.
        let creep = slide(24.0, 0.466, true, shape)?[0] / (GRAVITY * 24.0_f64.to_radians().sin());
        let metric = format!("acceleration at 24 degrees, friction 0.466, over that without any, {name}");
        rows.add(Measure::absolute(Tier::ClosedForm, metric, creep, 0.0, 1e-3));
    }
    Ok(())
}

/// A soft block of 8 x 4 cells.
fn block(friction: f64, shape: ShapeFunctions) -> Result<Mpm2, SetupError> {
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, Condition::frictional(friction))?;
    let scheme = Scheme::ModifiedStressLast;
    let options = Options { local_damping: DAMPING, shape, scheme, ..Options::default() };
    let gravity = DVec2::new(0.0, -GRAVITY);
    let mut mpm = Mpm2::new(Setup { gravity, walls: vec![floor], options, ..Setup::new(0.1) })?;
    let particles = Particle::<D2>::filling(DVec2::ZERO, DVec2::new(0.8, 0.4), 0.05);
    mpm.body(LinearElastic::new(2e6, 0.3)?, 1000.0, &particles)?;
    Ok(mpm)
}

/// Acceleration along the floor in half a second, and the same as if the block had kept its height, by the friction that the change
/// of its momentum across the floor took \[m/s^2\].
fn slide(degrees: f64, friction: f64, is_damped: bool, shape: ShapeFunctions) -> Result<[f64; 2], Failure> {
    let mut mpm = block(friction, shape).map_err(said)?;
    let dt = mpm.recommended_step();
    let steps = |time: f64| (time / dt) as u64;
    mpm.advance(dt, steps(0.2))?;
    mpm.set_local_damping(if is_damped { DAMPING } else { 0.0 }).map_err(said)?;
    let (sine, cosine) = degrees.to_radians().sin_cos();
    mpm.set_gravity(DVec2::new(sine, -cosine) * GRAVITY).map_err(said)?;
    // By then all of its base slides, or all of it rests.
    mpm.advance(dt, steps(0.5))?;
    mpm.set_local_damping(0.0).map_err(said)?;
    let (before, start) = (mpm.momentum() / mpm.mass(), mpm.time());
    mpm.advance(dt, steps(0.5))?;
    let change = (mpm.momentum() / mpm.mass() - before) / (mpm.time() - start);
    Ok([change.x, change.x + friction * change.y])
}
