//! Two elastic disks that fly at each other \[Sulsky1994\].

use crate::methods::mpm::names::{SHAPES, said};
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver};
use granular_driver::failure::Failure;
use granular_mpm::{Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions};
use std::f64::consts::{PI, SQRT_2};

const RADIUS: f64 = 0.2;
const DENSITY: f64 = 1000.0;
const SPEED: f64 = 0.1;
const CELL: f64 = 0.05;
const DT: f64 = 1e-3;
/// Middles of the disks on the diagonal.
const MIDDLES: [f64; 2] = [0.2, 0.8];
/// Share of the kinetic energy whose loss says that they touch.
const TOUCH: f64 = 1e-3;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    // Each has half of m v^2, with two components of the velocity.
    let energy = 2.0 * PI * RADIUS.powi(2) * DENSITY * SPEED.powi(2);
    let gap = (MIDDLES[1] - MIDDLES[0]) * SQRT_2 - 2.0 * RADIUS;
    let touch = gap / (2.0 * SPEED * SQRT_2);
    for (name, shape) in SHAPES {
        let found = meet(shape)?;
        let metric = format!("kinetic energy at the start, {name} [J/m]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.start, energy, 0.01));
        let metric = format!("largest momentum, {name} [kg/s]");
        rows.add(Measure::absolute(Tier::Conservation, metric, found.momentum, 0.0, 1e-12));
        let metric = format!("energy when they have parted over that at the start, {name}");
        rows.add(Measure::relative(Tier::Conservation, metric, found.kept, 1.0, 0.02));
        let metric = format!("kinetic energy after the rebound over that before, {name}");
        let rebound = Measure::relative(Tier::OtherCode, metric, found.rebound, 1.0, 0.2);
        rows.add(rebound.claim().note("the rest swings in the disks"));
        let metric = format!("time at which they begin to push, {name} [s]");
        let why = "disks touch by nodes that both reach, one cell or more before their rims meet";
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.touch, touch, 0.05).claim().note(why));
    }
    Ok(())
}

struct Met {
    start: f64,
    momentum: f64,
    kept: f64,
    rebound: f64,
    touch: f64,
}

fn disks(shape: ShapeFunctions) -> Result<Mpm2, SetupError> {
    let options = Options { shape, scheme: Scheme::ModifiedStressLast, ..Options::default() };
    let mut mpm = Mpm2::new(Setup { options, ..Setup::new(CELL) })?;
    for (middle, speed) in MIDDLES.into_iter().zip([SPEED, -SPEED]) {
        let (middle, reach) = (DVec2::splat(middle), DVec2::splat(RADIUS));
        let inside = |at: DVec2| (at - middle).length() < RADIUS;
        let disk = Particle::<D2>::filling_part(middle - reach, middle + reach, 0.25 * CELL, inside);
        let disk: Vec<_> = disk.into_iter().map(|particle| particle.moving(DVec2::splat(speed))).collect();
        mpm.body(LinearElastic::new(1000.0, 0.3)?, DENSITY, &disk)?;
    }
    Ok(mpm)
}

fn meet(shape: ShapeFunctions) -> Result<Met, Failure> {
    let mut mpm = disks(shape).map_err(said)?;
    let start = mpm.energies().translational();
    let (mut momentum, mut touch) = (0.0_f64, f64::NAN);
    while mpm.time() < 3.5 {
        mpm.advance(DT, 10)?;
        momentum = momentum.max(mpm.momentum().length());
        if touch.is_nan() && mpm.energies().translational() < (1.0 - TOUCH) * start {
            touch = mpm.time();
        }
    }
    let energies = mpm.energies();
    let (kept, rebound) = (energies.mechanical() / start, energies.translational() / start);
    Ok(Met { start, momentum, kept, rebound, touch })
}
