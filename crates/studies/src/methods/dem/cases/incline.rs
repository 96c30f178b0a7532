//! A disk and a sphere on an incline of 45 degrees \[KeBray1995; Kumar2014, section 3.5.4\].

use super::plane::Ball;
use crate::validate::Effort;
use crate::validate::reference::columns;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, StepError};
use granular_dem::Material;
use granular_driver::failure::Failure;
use granular_validation_data::{BALL_ON_INCLINE, DISK_ON_INCLINE};
use std::f64::consts::FRAC_1_SQRT_2;

/// Step \[s\], and steps up to the time at which the angle is read, 0.2 s.
const DT: f64 = 5e-6;
const STEPS: u64 = 40_000;
/// Stiffness of a body of stone \[N/m\]: friction needs some way to come up, and 1e9 N/m, where it
/// takes 2 ms of the 200, leaves 0.8 % of the angle of the closed form for rigid bodies.
const STIFFNESS: f64 = 1e12;
/// Slip over the second half of the time above which the ball slips \[m\].
const SLIPS: f64 = 1e-5;

pub(super) fn disk(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    incline::<D2>(rows, DISK_ON_INCLINE, effort)
}

pub(super) fn sphere(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    incline::<D3>(rows, BALL_ON_INCLINE, effort)
}

fn incline<D: Dim>(rows: &mut Rows, reference: &str, _: Effort) -> Result<(), Failure> {
    let data = columns(reference, ["friction_angle_deg", "friction", "angle_rad"]);
    let plateau = data.iter().map(|row| row[2]).fold(0.0, f64::max);
    for [degrees, friction, angle] in data {
        let turned = roll::<D>(friction)?.angle;
        let metric = format!("angle after 0.2 s, friction angle {degrees} deg [rad]");
        let scale = if angle == 0.0 { plateau } else { angle };
        let error = (turned - angle).abs() / scale;
        rows.add(Measure::judged(Tier::ClosedForm, metric, [turned, angle], error, 1e-3));
    }
    let limit = (1.0 / (1.0 + 1.0 / D::BALL_INERTIA)).atan().to_degrees();
    let found = kink::<D>()?;
    let metric = format!("friction angle from which a {} rolls [deg]", D::BALL);
    rows.add(Measure::relative(Tier::ClosedForm, metric, found, limit, 1e-3).note("by bisection"));
    Ok(())
}

/// Smallest friction angle \[degrees\] at which the ball rolls.
fn kink<D: Dim>() -> Result<f64, StepError> {
    let (mut low, mut high) = (10.0_f64, 25.0_f64);
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        let slips = roll::<D>(middle.to_radians().tan())?.late_slip > SLIPS;
        *(if slips { &mut low } else { &mut high }) = middle;
    }
    Ok(0.5 * (low + high))
}

/// What a ball did.
struct Outcome {
    /// Angle turned \[rad\].
    angle: f64,
    /// Way that the contact point slid in the second half of the time \[m\].
    late_slip: f64,
}

/// Lets a ball go from rest.
fn roll<D: Dim>(friction: f64) -> Result<Outcome, StepError> {
    let material =
        Material { normal_stiffness: STIFFNESS, restitution: 0.2, friction, ..Material::default() };
    let pull = 9.81 * FRAC_1_SQRT_2;
    let ball = Ball { radius: 1.0, material, gap: 0.0, velocity: [0.0; 2], gravity: [pull, -pull] };
    let mut rolling = ball.at_rest_on_plane::<D>().on_plane::<D>();
    let mut outcome = Outcome { angle: 0.0, late_slip: 0.0 };
    let mut before = 0.0;
    for step in 1..=STEPS {
        rolling.step(DT)?;
        let turning = rolling.turning();
        outcome.angle += 0.5 * DT * (before + turning);
        before = turning;
        if step > STEPS / 2 {
            outcome.late_slip += DT * rolling.slip();
        }
    }
    Ok(outcome)
}
