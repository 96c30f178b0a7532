//! Oblique impact of a disk and a sphere on a plane \[ChungOoi2011; Maw1976\].

use super::plane::{Ball, Rolling};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, StepError};
use granular_dem::Material;
use granular_driver::failure::Failure;

/// Speed towards the plane \[m/s\]: slow, so that the overlap does not shorten lever arms.
const NORMAL: f64 = 1e-3;
const RADIUS: f64 = 0.5e-3;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    sliding::<D2>(rows)?;
    sliding::<D3>(rows)?;
    sticking::<D2>(rows)?;
    Ok(sticking::<D3>(rows)?)
}

/// The ball after an impact with this speed along the plane.
fn after<D: Dim>(material: Material, along: f64) -> Result<Rolling<D>, StepError> {
    let mut ball = Ball { radius: RADIUS, material, gap: 0.0, velocity: [along, -NORMAL], gravity: [0.0; 2] };
    let dt = 0.01 / ball.frequency::<D>();
    ball.gap = 1.3 * NORMAL * dt;
    let mut rolling = ball.on_plane::<D>();
    rolling.advance(dt, 400)?;
    Ok(rolling)
}

/// Friction is at its cap all the time.
fn sliding<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let (restitution, friction, gain) = (0.8, 0.3, 1.0 / D::BALL_INERTIA);
    let material = Material { restitution, friction, ..Material::default() };
    let loss = friction * (1.0 + restitution) * NORMAL;
    for times in [1.2, 3.0] {
        let along = times * (1.0 + gain) * loss;
        let rolling = after::<D>(material, along)?;
        let name = format!("{}, sliding, v_t = {times} of the limit", D::BALL);
        let speed = 1e3 * rolling.speed();
        let metric = format!("{name}: v_t' [mm/s]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, speed, 1e3 * (along - loss), 1e-3));
        let metric = format!("{name}: spin' [rad/s]");
        let spin = gain * loss / RADIUS;
        rows.add(Measure::relative(Tier::ClosedForm, metric, rolling.turning(), spin, 1e-3));
    }
    Ok(())
}

/// The contact point never slides, and both springs swing in step.
fn sticking<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let gain = 1.0 / D::BALL_INERTIA;
    let material = Material {
        restitution: 1.0,
        damping_ratio: 0.0,
        friction: 10.0,
        stiffness_ratio: 1.0 / (1.0 + gain),
        ..Material::default()
    };
    let along = 2.0 * NORMAL;
    let rolling = after::<D>(material, along)?;
    let metric = format!("{}, sticking: v_s'/v_s of the contact point", D::BALL);
    rows.add(Measure::relative(Tier::ClosedForm, metric, rolling.slip() / along, -1.0, 1e-3));
    let metric = format!("{}, sticking: v_t' [mm/s]", D::BALL);
    let expected = along * (1.0 - 2.0 / (1.0 + gain));
    rows.add(Measure::relative(Tier::ClosedForm, metric, 1e3 * rolling.speed(), 1e3 * expected, 1e-3));
    Ok(())
}
