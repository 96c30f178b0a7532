//! A free elastic disk that spins: angular momentum, size and stress.

use crate::methods::mpm::names::{SHAPES, said};
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver};
use granular_driver::failure::Failure;
use granular_mpm::{Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions};
use std::f64::consts::TAU;

/// Radius \[m\], density \[kg/m^3\], Young's modulus \[Pa\], Poisson's ratio; one turn a second.
const RADIUS: f64 = 0.5;
const DENSITY: f64 = 1000.0;
const YOUNG: f64 = 1e6;
const POISSON: f64 = 0.3;
const DT: f64 = 5e-4;
/// What is near the middle, over the radius.
const MIDDLE: f64 = 0.2;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    // (3 - 2 nu - 2 (r / R)^2) / (8 (1 - nu)) of rho w^2 R^2 at a radius r of a disk in plane strain, as a mean near the middle.
    let scale = DENSITY * (TAU * RADIUS).powi(2);
    let middle = scale * (3.0 - 2.0 * POISSON - MIDDLE.powi(2)) / (8.0 * (1.0 - POISSON));
    for (name, shape) in SHAPES {
        let [coarse, fine] = [5.0, 10.0].map(|cells| spin(shape, RADIUS / cells));
        let (coarse, fine) = (coarse?, fine?);
        for (cells, spun) in [(5, &coarse), (10, &fine)] {
            let metric = format!("angular momentum lost in a turn, radius of {cells} cells, {name}");
            let lost = Measure::absolute(Tier::Conservation, metric, spun.lost, 0.0, 1e-3);
            let why = "particles take the change of velocity only (FLIP): what the nodes at the rim do not see turns less";
            rows.add(lost.claim().note(why));
        }
        if shape != ShapeFunctions::Linear {
            let metric = format!("share of that loss that is left in half the cell, {name}");
            rows.add(Measure::absolute(Tier::Order, metric, fine.lost / coarse.lost, 0.25, 0.15));
        }
        let metric = format!("farthest particle over the radius, {name}");
        rows.add(Measure::relative(Tier::ClosedForm, metric, fine.reach / RADIUS, 1.0, 0.02));
        let metric = format!("largest stress over density and square of the speed of the rim, {name}");
        let largest = fine.largest / scale;
        let bound = Measure::judged(Tier::ClosedForm, metric, [largest, 1.0], largest, 1.0);
        let why =
            "a bound; what the rim loses stays with particles as stresses that differ from one to the next";
        rows.add(bound.claim().note(why));
        let metric = format!("mean stress in the middle, {name} [Pa]");
        let mean = Measure::relative(Tier::ClosedForm, metric, fine.middle, middle, 0.05);
        rows.add(if shape == ShapeFunctions::Linear {
            mean.claim().note("particles that cross cells press on one another")
        } else {
            mean
        });
    }
    Ok(())
}

struct Spun {
    /// Share of the angular momentum lost in a turn.
    lost: f64,
    /// Distance of the farthest particle from the middle \[m\].
    reach: f64,
    /// Largest stress in the plane that any particle had \[Pa\].
    largest: f64,
    /// Mean over time of the stress near the middle \[Pa\].
    middle: f64,
}

fn disk(shape: ShapeFunctions, cell: f64) -> Result<Mpm2, SetupError> {
    let options = Options { shape, scheme: Scheme::ModifiedStressLast, ..Options::default() };
    let mut mpm = Mpm2::new(Setup { options, ..Setup::new(cell) })?;
    let low = DVec2::splat(-RADIUS);
    let disk = Particle::<D2>::filling_part(low, -low, 0.5 * cell, |at| at.length() < RADIUS);
    let spinning = |particle: Particle<D2>| particle.moving(particle.position.perp() * TAU);
    let particles: Vec<_> = disk.into_iter().map(spinning).collect();
    mpm.body(LinearElastic::new(YOUNG, POISSON)?, DENSITY, &particles)?;
    Ok(mpm)
}

fn spin(shape: ShapeFunctions, cell: f64) -> Result<Spun, Failure> {
    let mut mpm = disk(shape, cell).map_err(said)?;
    let start = mpm.angular_momentum();
    let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for _ in 0..200 {
        mpm.advance(DT, 10)?;
        for (_, particle) in mpm.particles() {
            let stress = particle.stress;
            let (mean, half) = (0.5 * (stress.xx + stress.yy), 0.5 * (stress.xx - stress.yy));
            largest = largest.max(mean.abs() + half.hypot(stress.xy));
            if particle.position.length() < MIDDLE * RADIUS {
                (sum, count) = (sum + mean, count + 1);
            }
        }
    }
    let lost = 1.0 - mpm.angular_momentum() / start;
    let reach = mpm.particles().map(|(_, particle)| particle.position.length()).fold(0.0, f64::max);
    Ok(Spun { lost, reach, largest, middle: sum / f64::from(count) })
}
