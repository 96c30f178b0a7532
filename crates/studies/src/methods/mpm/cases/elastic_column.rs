//! A confined elastic column under its own weight, for each shape function.

use crate::methods::mpm::names::said;
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver};
use granular_driver::failure::Failure;
use granular_driver::statistics::root_mean_square;
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};

const YOUNG: f64 = 1.98e6;
const POISSON: f64 = 0.23;
const DENSITY: f64 = 1925.0;
const HEIGHT: f64 = 0.2;
const GRAVITY: f64 = 9.81;
/// Time in which gravity is raised, and for which it then rests \[s\].
const RAISED: f64 = 0.4;
const RESTED: f64 = 0.4;

/// A column one cell wide.
#[derive(Clone, Copy, Debug)]
pub(in crate::methods::mpm) struct Elastic {
    pub(in crate::methods::mpm) shape: ShapeFunctions,
    pub(in crate::methods::mpm) scheme: Scheme,
    /// Cells over the height.
    pub(in crate::methods::mpm) cells: usize,
    /// Particles along an edge of a cell.
    pub(in crate::methods::mpm) along: usize,
}

/// A column that has settled.
pub(in crate::methods::mpm) struct Settled {
    /// Step that was taken \[s\].
    pub(in crate::methods::mpm) dt: f64,
    /// Settlement of the highest particle, and what it should be \[m\].
    top: [f64; 2],
    /// Force on the base over the weight.
    base: f64,
    /// Root mean square of the errors of places over the settlement of the surface.
    pub(in crate::methods::mpm) places: f64,
    /// The same of vertical stresses, over that at the base.
    pub(in crate::methods::mpm) stresses: f64,
}

impl Elastic {
    fn cell(&self) -> f64 {
        HEIGHT / self.cells as f64
    }

    fn particles(&self) -> Vec<Particle<D2>> {
        let size = DVec2::new(self.cell(), HEIGHT);
        Particle::filling(DVec2::ZERO, size, self.cell() / self.along as f64)
    }

    fn build(&self) -> Result<Mpm2, SetupError> {
        let walls = vec![
            Wall::plane("base", DVec2::ZERO, DVec2::Y, Condition::Slip)?,
            Wall::plane("left", DVec2::ZERO, DVec2::X, Condition::Slip)?,
            Wall::plane("right", DVec2::X * self.cell(), -DVec2::X, Condition::Slip)?,
        ];
        let options = Options { shape: self.shape, scheme: self.scheme, ..Options::default() };
        let mut mpm = Mpm2::new(Setup { walls, options, ..Setup::new(self.cell()) })?;
        mpm.body(LinearElastic::new(YOUNG, POISSON)?, DENSITY, &self.particles())?;
        // Gravity comes in ten parts, so that little is left to damp.
        mpm.set_local_damping(0.1)?;
        Ok(mpm)
    }

    pub(in crate::methods::mpm) fn settle(&self) -> Result<Settled, Failure> {
        let mut mpm = self.build().map_err(said)?;
        let dt = mpm.recommended_step();
        for tenth in 1..=10 {
            mpm.set_gravity(DVec2::new(0.0, -GRAVITY * 0.1 * f64::from(tenth))).map_err(said)?;
            mpm.advance(dt, (0.1 * RAISED / dt).ceil() as u64)?;
        }
        mpm.advance(dt, (RESTED / dt).ceil() as u64)?;
        Ok(self.measured(&mpm, dt))
    }

    fn measured(&self, mpm: &Mpm2, dt: f64) -> Settled {
        let modulus = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        let weight = DENSITY * GRAVITY;
        let sunk = |material: f64| weight / modulus * (HEIGHT - 0.5 * material) * material;
        let before = self.particles();
        let (mut places, mut stresses, mut top) = (Vec::new(), Vec::new(), [0.0; 2]);
        let mut highest = 0.0;
        for (id, particle) in mpm.particles() {
            let material = before[id as usize].position.y;
            let settled = material - particle.position.y;
            places.push((settled - sunk(material)) / sunk(HEIGHT));
            stresses.push(particle.stress.yy / (weight * HEIGHT) + 1.0 - material / HEIGHT);
            if material > highest {
                (highest, top) = (material, [settled, sunk(material)]);
            }
        }
        let base = -mpm.wall_forces()[0].y / (HEIGHT * self.cell() * weight);
        let (places, stresses) = (root_mean_square(&places), root_mean_square(&stresses));
        Settled { dt, top, base, places, stresses }
    }
}

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    // Splines reach behind the floor and feel it half a cell deeper.
    let shapes = [
        (ShapeFunctions::Linear, "linear", 0.01),
        (ShapeFunctions::UniformGimp, "GIMP", 0.01),
        (ShapeFunctions::QuadraticBspline, "quadratic B-spline", 0.035),
    ];
    for (shape, name, tolerance) in shapes {
        let column = Elastic { shape, scheme: Scheme::ModifiedStressLast, cells: 20, along: 4 };
        let settled = column.settle()?;
        let metric = format!("settlement of the top, {name} [m]");
        let [found, expected] = settled.top;
        rows.add(Measure::relative(Tier::ClosedForm, metric, found, expected, tolerance));
        let metric = format!("force on the base over the weight, {name}");
        rows.add(Measure::relative(Tier::Conservation, metric, settled.base, 1.0, 1e-3));
    }
    Ok(())
}
