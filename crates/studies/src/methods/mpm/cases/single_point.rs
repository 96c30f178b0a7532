//! One particle in one cell, whose free node swings it to and fro.

use crate::methods::mpm::names::{SCHEMES, said};
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::Solver;
use granular_core::glam::DVec2;
use granular_driver::failure::Failure;
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};
use std::f64::consts::{PI, TAU};

const SPEED: f64 = 0.01;
const DT: f64 = 2.5e-4;
const PERIODS: u32 = 10;
/// Time between looks \[s\]: a call for one step would cost more than the step.
const LOOK: f64 = 20.0 * DT;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for (name, scheme) in SCHEMES {
        let found = swing(scheme)?;
        let metric = format!("period, {name} [s]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.period, 1.0, 0.01));
        let metric = format!("largest error of the place over the amplitude in {PERIODS} periods, {name}");
        let place = Measure::absolute(Tier::ClosedForm, metric, found.place, 0.0, 0.01);
        let metric = format!("speed after {PERIODS} periods, {name} [m/s]");
        let speed = Measure::relative(Tier::ClosedForm, metric, found.speed, SPEED, 0.01);
        if scheme == Scheme::StressLast {
            let why = "the scheme takes energy out of waves, the less the shorter the step";
            rows.add(place.claim().note(why));
            rows.add(speed.claim().note(why));
        } else {
            rows.add(place);
            rows.add(speed);
        }
    }
    Ok(())
}

struct Swung {
    period: f64,
    /// Largest distance from where it should be, over the amplitude.
    place: f64,
    /// At the end, where it is the largest.
    speed: f64,
}

/// A particle of mass and volume 1 in the middle of a cell of 1 m, of which one side is free.
fn swing(scheme: Scheme) -> Result<Swung, Failure> {
    let planes = [
        ("end", DVec2::ZERO, DVec2::X),
        ("side", DVec2::ZERO, DVec2::Y),
        ("other side", DVec2::Y, -DVec2::Y),
    ];
    let wall = |(name, at, normal)| Wall::plane(name, at, normal, Condition::Slip);
    let walls = planes.into_iter().map(wall).collect::<Result<_, _>>().map_err(said)?;
    let options = Options { shape: ShapeFunctions::Linear, scheme, ..Options::default() };
    let mut mpm = Mpm2::new(Setup { walls, options, ..Setup::new(1.0) }).map_err(said)?;
    let particle = Particle::at(DVec2::splat(0.5), 1.0).moving(DVec2::new(SPEED, 0.0));
    let spring = LinearElastic::new(4.0 * PI * PI, 0.0).map_err(said)?;
    mpm.body(spring, 1.0, &[particle]).map_err(said)?;
    let (mut crossings, mut last, mut place) = (Vec::new(), SPEED, 0.0_f64);
    while mpm.time() < f64::from(PERIODS) - 0.5 * DT {
        mpm.advance(DT, 20)?;
        let now = mpm.particle(0);
        let expected = 0.5 * (SPEED / TAU * (TAU * mpm.time()).sin()).exp();
        place = place.max((now.position.x - expected).abs() / (0.5 * SPEED / TAU));
        if last * now.velocity.x < 0.0 {
            crossings.push(mpm.time() - LOOK * now.velocity.x / (now.velocity.x - last));
        }
        last = now.velocity.x;
    }
    let count = crossings.len();
    let period = 2.0 * (crossings[count - 1] - crossings[0]) / (count - 1) as f64;
    Ok(Swung { period, place, speed: last })
}
