//! Particle-steps per second for a column of soil in plane strain: 16 particles in a cell, rough floor and wall.
//!
//! `cargo run --release -p granular-mpm --example column_speed -- [particles a side] [steps] [threads]`

use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_core::glam::DVec2;
use granular_core::{D2, Solver, SymmetricTensor};
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};
use std::time::Instant;

const CELL: f64 = 2e-3;
const DENSITY: f64 = 1925.0;
const STEP: f64 = 1e-5;

fn column(side: usize, options: Options) -> Mpm2 {
    let rough = Condition::frictional(0.466);
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, rough).expect("a plane");
    let left = Wall::plane("left", DVec2::ZERO, DVec2::X, rough).expect("a plane");
    let gravity = DVec2::new(0.0, -9.81);
    let setup = Setup { gravity, walls: vec![floor, left], options, ..Setup::new(CELL) };
    let mut mpm = Mpm2::new(setup).expect("values in range");
    let size = 0.25 * CELL * side as f64;
    let mut particles = Particle::<D2>::filling(DVec2::ZERO, DVec2::splat(size), 0.25 * CELL);
    for particle in &mut particles {
        let vertical = -DENSITY * 9.81 * (size - particle.position.y);
        let across = vertical * (1.0 - 23.2_f64.to_radians().sin());
        particle.stress = SymmetricTensor { xx: across, yy: vertical, zz: across, ..SymmetricTensor::ZERO };
    }
    let elastic = LinearElastic::new(1.98e6, 0.23).expect("moduli in range");
    let strength = Strength::of_friction(23.2_f64.to_radians());
    let law = MohrCoulomb::new(elastic, strength).expect("a strength in range");
    mpm.body(law, DENSITY, &particles).expect("particles in range");
    mpm
}

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse::<usize>().ok());
    let side = numbers.next().unwrap_or(400);
    let steps = numbers.next().unwrap_or(100) as u64;
    let threads = numbers.next().map_or(vec![1, 2], |threads| vec![threads]);
    for threads in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        for shape in [ShapeFunctions::Linear, ShapeFunctions::UniformGimp, ShapeFunctions::QuadraticBspline] {
            for scheme in [Scheme::StressLast, Scheme::ModifiedStressLast] {
                let rates = pool.install(|| {
                    let mut mpm = column(side, Options { shape, scheme, ..Options::default() });
                    mpm.advance(STEP, 3).expect("a stable step");
                    let mut rates = [0.0; 3].map(|_: f64| {
                        let start = Instant::now();
                        mpm.advance(STEP, steps).expect("a stable step");
                        (side * side) as f64 * steps as f64 / start.elapsed().as_secs_f64()
                    });
                    rates.sort_by(f64::total_cmp);
                    rates
                });
                let [least, median, most] = rates;
                println!(
                    "{threads} threads, {shape:?}, {scheme:?}: {median:.3e} particle-steps/s ({least:.3e} to {most:.3e})"
                );
            }
        }
    }
}
