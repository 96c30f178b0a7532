//! Bodies that tests share.

use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_core::{Dim, Linear, Vector};
use granular_mpm::{BodyLaw, Condition, Mpm, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};

pub(crate) const SHAPES: [ShapeFunctions; 3] =
    [ShapeFunctions::Linear, ShapeFunctions::UniformGimp, ShapeFunctions::QuadraticBspline];
pub(crate) const SCHEMES: [Scheme; 3] = [Scheme::StressLast, Scheme::StressFirst, Scheme::ModifiedStressLast];

/// The vector with these components, those beyond the dimension left out.
pub(crate) fn vector<D: Dim>(components: [f64; 3]) -> D::Vec {
    D::Vec::from_fn(|axis| components[axis])
}

/// A soft block that tumbles and stretches, with cells of 0.1 m and 4 particles in each along an axis.
pub(crate) fn tumbling<D: Dim>(options: Options, side: f64) -> Mpm<D> {
    let mut mpm = Mpm::new(Setup { options, ..Setup::new(0.1) }).unwrap();
    let law = LinearElastic::new(1e4, 0.3).unwrap();
    let middle = D::Vec::splat(0.5 * side);
    let mut particles = Particle::<D>::filling(D::Vec::ZERO, D::Vec::splat(side), 0.05);
    for particle in &mut particles {
        let arm = particle.position - middle;
        let spin = D::turn(granular_core::Spin::about_z(2.0), arm);
        particle.velocity = vector::<D>([0.4, -0.3, 0.2]) + spin + arm * 0.1;
    }
    mpm.body(law, 1000.0, &particles).unwrap();
    mpm
}

/// A soft column that falls on a rough floor beside a wall.
pub(crate) fn falling<D: Dim>(options: Options, side: f64) -> Mpm<D> {
    falling_of(LinearElastic::new(5e4, 0.3).unwrap(), options, side)
}

/// Dry grains that fall likewise.
pub(crate) fn flowing<D: Dim>(options: Options, side: f64) -> Mpm<D> {
    let elastic = LinearElastic::new(5e4, 0.3).unwrap();
    falling_of(MohrCoulomb::new(elastic, Strength::of_friction(0.5)).unwrap(), options, side)
}

fn falling_of<D: Dim>(law: impl Into<BodyLaw<D>>, options: Options, side: f64) -> Mpm<D> {
    let up = D::Vec::along(D::UP, 1.0);
    let floor = Wall::plane("floor", D::Vec::ZERO, up, Condition::frictional(0.4)).unwrap();
    let left = Wall::plane("left", D::Vec::ZERO, D::Vec::along(0, 1.0), Condition::Slip).unwrap();
    let setup = Setup { gravity: up * -9.81, walls: vec![floor, left], options, ..Setup::new(0.1) };
    let mut mpm = Mpm::new(setup).unwrap();
    let high = D::Vec::splat(side) + up * side;
    let mut particles = Particle::<D>::filling(D::Vec::ZERO, high, 0.05);
    for particle in &mut particles {
        particle.velocity = D::Vec::along(0, 1.0 + particle.position.component(D::UP));
    }
    mpm.body(law, 1000.0, &particles).unwrap();
    mpm
}

/// Runs a test on one thread, without the price of sharing out a few particles; bits are the same.
pub(crate) fn alone(test: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(test);
}
