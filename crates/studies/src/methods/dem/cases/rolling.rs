//! From sliding to rolling, and a bouncing ball \[MFiX tests DEM-04 and DEM-02\].

use super::plane::Ball;
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, StepError};
use granular_dem::Material;
use granular_driver::failure::Failure;

const GRAVITY: f64 = 9.81;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    rolls::<D2>(rows)?;
    Ok(rolls::<D3>(rows)?)
}

fn rolls<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let (start, friction, gain) = (0.5, 0.3, 1.0 / D::BALL_INERTIA);
    let material = Material { normal_stiffness: 1e8, friction, ..Material::default() };
    let velocity = [start, 0.0];
    let ball = Ball { radius: 0.05, material, gap: 0.0, velocity, gravity: [0.0, -GRAVITY] };
    let mut rolling = ball.at_rest_on_plane::<D>().on_plane::<D>();
    let expected = start / ((1.0 + gain) * friction * GRAVITY);
    let dt = 0.02 / ball.frequency::<D>();
    let (mut time, mut slip) = (0.0, rolling.slip());
    let mut rolls_from = f64::NAN;
    while time < 2.0 * expected {
        rolling.step(dt)?;
        let next = rolling.slip();
        if rolls_from.is_nan() && next <= 0.0 {
            rolls_from = time + dt * slip / (slip - next);
        }
        slip = next;
        time += dt;
    }
    let metric = format!("{}: time of sliding [ms]", D::BALL);
    rows.add(Measure::relative(Tier::ClosedForm, metric, 1e3 * rolls_from, 1e3 * expected, 1e-3));
    let metric = format!("{}: speed of rolling [m/s]", D::BALL);
    let speed = start * gain / (1.0 + gain);
    rows.add(Measure::relative(Tier::ClosedForm, metric, rolling.speed(), speed, 1e-3));
    Ok(())
}

pub(super) fn bounces(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    bouncing::<D2>(rows)?;
    Ok(bouncing::<D3>(rows)?)
}

fn bouncing<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let (restitution, height) = (0.8_f64, 0.1);
    let material = Material { normal_stiffness: 1e9, restitution, friction: 0.0, ..Material::default() };
    let ball = Ball { radius: 5e-3, material, gap: height, velocity: [0.0; 2], gravity: [0.0, -GRAVITY] };
    let mut rolling = ball.on_plane::<D>();
    let dt = 0.05 / ball.frequency::<D>();
    for bounce in 1..=5 {
        let expected = height * restitution.powi(2 * bounce);
        // Down, through the contact, and up to where the speed changes its sign.
        while rolling.rise() <= 0.0 {
            rolling.step(dt)?;
        }
        while rolling.rise() > 0.0 {
            rolling.step(dt)?;
        }
        let top = rolling.gap() + rolling.rise().powi(2) / (2.0 * GRAVITY);
        let metric = format!("{}: height after bounce {bounce} [mm]", D::BALL);
        rows.add(Measure::relative(Tier::ClosedForm, metric, 1e3 * top, 1e3 * expected, 1e-2));
    }
    Ok(())
}
