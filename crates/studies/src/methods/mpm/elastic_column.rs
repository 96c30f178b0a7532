//! A confined elastic column under its own weight, for each shape function.

use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::{Solver, glam::DVec2};
use granular_driver::failure::Failure;
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};

const YOUNG: f64 = 1.98e6;
const POISSON: f64 = 0.23;
const DENSITY: f64 = 1925.0;
const HEIGHT: f64 = 0.2;
const CELL: f64 = 0.01;
const GRAVITY: f64 = 9.81;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let modulus = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    // Splines reach behind the floor and feel it half a cell deeper.
    let shapes = [
        (ShapeFunctions::Linear, "linear", 0.01),
        (ShapeFunctions::UniformGimp, "GIMP", 0.01),
        (ShapeFunctions::QuadraticBspline, "quadratic B-spline", 0.035),
    ];
    for (shape, name, tolerance) in shapes {
        let [settled, material, base] = settle(shape).map_err(|error| Failure::Io(error.to_string()))?;
        let expected = DENSITY * GRAVITY / modulus * (HEIGHT * material - 0.5 * material * material);
        let metric = format!("settlement of the top, {name} [m]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, settled, expected, tolerance));
        let metric = format!("force on the base, {name} [N/m]");
        let weight = HEIGHT * CELL * DENSITY * GRAVITY;
        rows.add(Measure::relative(Tier::Conservation, metric, base, weight, 1e-3));
    }
    Ok(())
}

/// Settlement of the highest particle \[m\], its height before \[m\], and the force on the base \[N/m\].
fn settle(shape: ShapeFunctions) -> Result<[f64; 3], Box<dyn std::error::Error>> {
    let walls = vec![
        Wall::plane("base", DVec2::ZERO, DVec2::Y, Condition::Slip)?,
        Wall::plane("left", DVec2::ZERO, DVec2::X, Condition::Slip)?,
        Wall::plane("right", DVec2::X * CELL, -DVec2::X, Condition::Slip)?,
    ];
    let options = Options { shape, scheme: Scheme::ModifiedStressLast, ..Options::default() };
    let mut mpm = Mpm2::new(Setup { walls, options, ..Setup::new(CELL) })?;
    let particles = Particle::filling(DVec2::ZERO, DVec2::new(CELL, HEIGHT), 0.25 * CELL);
    mpm.body(LinearElastic::new(YOUNG, POISSON)?, DENSITY, &particles)?;
    // Gravity in ten parts, so that little is left to damp.
    mpm.set_local_damping(0.1)?;
    for tenth in 1..=10 {
        mpm.set_gravity(DVec2::new(0.0, -GRAVITY * 0.1 * f64::from(tenth)))?;
        mpm.advance(1e-4, 400)?;
    }
    mpm.advance(1e-4, 4000)?;
    let heights = particles.iter().map(|particle| particle.position.y).enumerate();
    let (top, material) = heights.max_by(|a, b| a.1.total_cmp(&b.1)).expect("the column has particles");
    let now = mpm.particle(top as u32).position.y;
    Ok([material - now, material, -mpm.wall_forces()[0].y])
}
