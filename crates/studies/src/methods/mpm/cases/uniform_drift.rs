//! Blocks under one stress everywhere, and without any, at all places between nodes.

use crate::methods::mpm::names::{SHAPES, said};
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver, SymmetricTensor};
use granular_driver::failure::Failure;
use granular_mpm::{Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions};

/// Edge of the block in cells of 1 m, and what lies as deep is inside.
const SIDE: f64 = 8.0;
const DEEP: f64 = 3.0;
/// Places of the block between two nodes.
const SHIFTS: u32 = 23;
const DT: f64 = 0.1;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for (name, shape) in SHAPES {
        let push = (0..SHIFTS).try_fold(0.0_f64, |most, shift| {
            pushed(shape, f64::from(shift) / f64::from(SHIFTS)).map(|push| most.max(push))
        });
        let metric = format!("largest force inside over stress and area of a cell, {name}");
        let row = |tolerance| {
            Measure::absolute(
                Tier::ClosedForm,
                metric.clone(),
                push.clone().unwrap_or(f64::NAN),
                0.0,
                tolerance,
            )
        };
        match shape {
            ShapeFunctions::UniformGimp => rows.add(row(1e-12)),
            ShapeFunctions::QuadraticBspline => {
                rows.add(row(0.02).note("the sum of two points an edge is no integral"))
            }
            ShapeFunctions::Linear => {
                let why = "hat functions of points push whenever a cell holds more points than its neighbour";
                rows.add(row(1e-12).claim().note(why));
            }
        }
        push.map_err(said)?;
        let metric = format!("largest change of a velocity over 20 cells without stress, {name}");
        let change = drifted(shape)?;
        rows.add(Measure::absolute(Tier::Identity, metric, change, 0.0, 1e-12));
    }
    Ok(())
}

fn block(
    shape: ShapeFunctions,
    low: DVec2,
    of: impl Fn(Particle<D2>) -> Particle<D2>,
) -> Result<Mpm2, SetupError> {
    let options = Options { shape, scheme: Scheme::StressLast, ..Options::default() };
    let mut mpm = Mpm2::new(Setup { options, ..Setup::new(1.0) })?;
    let particles = Particle::<D2>::filling(low, low + DVec2::splat(SIDE), 0.5);
    let particles: Vec<_> = particles.into_iter().map(of).collect();
    mpm.body(LinearElastic::new(1.0, 0.3)?, 1.0, &particles)?;
    Ok(mpm)
}

/// Largest acceleration inside of a block of density 1 under a stress of 1 Pa, at a place between nodes: forces over those of
/// the stress on a cell.
fn pushed(shape: ShapeFunctions, shift: f64) -> Result<f64, SetupError> {
    let low = DVec2::new(shift, 0.4 * shift);
    let stress = SymmetricTensor { xx: -1.0, yy: -0.5, zz: -0.7, xy: 0.2, ..SymmetricTensor::ZERO };
    let mut mpm = block(shape, low, |particle| particle.stressed(stress))?;
    mpm.step(DT).map_err(|error| SetupError::new(error.to_string(), DT, "a step that is taken"))?;
    let inside = |at: DVec2| (at - low).min_element() > DEEP && (low + SIDE - at).min_element() > DEEP;
    let particles = mpm.particles().filter(|(_, particle)| inside(particle.position));
    Ok(particles.map(|(_, particle)| particle.velocity.length() / DT).fold(0.0, f64::max))
}

/// Largest change of a velocity, over it, of a block that drifts.
fn drifted(shape: ShapeFunctions) -> Result<f64, Failure> {
    let velocity = DVec2::new(1.0, 0.37);
    let mut mpm = block(shape, DVec2::ZERO, |particle| particle.moving(velocity)).map_err(said)?;
    while mpm.time() < 20.0 {
        mpm.step(DT)?;
    }
    let change = mpm.particles().map(|(_, particle)| (particle.velocity - velocity).length());
    Ok(change.fold(0.0, f64::max) / velocity.length())
}
