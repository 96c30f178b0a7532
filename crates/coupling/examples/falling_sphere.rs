//! A sphere falls in a box of oil, as measured by \[TenCate2002\]: four oils, Reynolds numbers 1.5 to 32, 1.16 times the density of the oil.
//!
//! ```sh
//! cargo run --release -p granular-coupling --example falling_sphere -- 10
//! ```
//!
//! The number is that of cells to the diameter; 10 takes some minutes.

use granular_core::glam::DVec3;
use granular_core::{D3, Simulation};
use granular_coupling::{ResolvedGrains, ResolvedOptions};
use granular_dem::{Dem3, Grain, Material, Materials, Options, Wall};
use granular_lbm::{Face, Lbm3, Setup};
use std::error::Error;

/// Diameter \[m\] and density \[kg/m^3\] of the sphere.
const DIAMETER: f64 = 0.015;
const DENSITY: f64 = 1120.0;
/// Edges of the box \[m\]; the lowest point of the sphere begins 0.12 m above the floor.
const BOX: [f64; 3] = [0.1, 0.1, 0.16];
const START: f64 = 0.12;
const GRAVITY: DVec3 = DVec3::new(0.0, 0.0, -9.81);

/// An oil: density \[kg/m^3\], viscosity \[Pa s\], speed of the sphere in an endless one \[m/s\], and the largest speed in the box over that.
struct Oil {
    density: f64,
    viscosity: f64,
    speed: f64,
    largest: f64,
}

/// Table I and the largest speeds measured by \[TenCate2002\].
const OILS: [Oil; 4] = [
    Oil { density: 970.0, viscosity: 0.373, speed: 0.038, largest: 0.947 },
    Oil { density: 965.0, viscosity: 0.212, speed: 0.060, largest: 0.953 },
    Oil { density: 962.0, viscosity: 0.113, speed: 0.091, largest: 0.959 },
    Oil { density: 960.0, viscosity: 0.058, speed: 0.128, largest: 0.955 },
];

/// A box of the oil with so many cells to the diameter.
fn fluid(oil: &Oil, cells: f64) -> Setup<D3> {
    let spacing = DIAMETER / cells;
    let viscosity = oil.viscosity / oil.density;
    // The sphere moves by 0.04 cells a step at most, and the relaxation time is 0.9 at most.
    let by_speed = 0.5 + 3.0 * viscosity * 0.04 / (oil.speed * spacing);
    let mut setup =
        Setup::new(BOX.map(|edge| (edge / spacing).round() as usize), spacing, viscosity, by_speed.min(0.9));
    setup.density = oil.density;
    setup.faces = [0, 1, 2].map(|_| [Face::REST, Face::REST]);
    setup
}

fn sphere(time_step: f64) -> Result<Dem3, Box<dyn Error>> {
    let mut materials = Materials::new();
    let mass = DENSITY * std::f64::consts::PI / 6.0 * DIAMETER.powi(3);
    // A contact of two lasts as long as twenty steps of the oil.
    let normal_stiffness = 0.5 * mass * (std::f64::consts::PI / (20.0 * time_step)).powi(2);
    let nylon = materials.add(Material { density: DENSITY, normal_stiffness, ..Material::default() })?;
    let place = DVec3::new(0.5 * BOX[0], 0.5 * BOX[1], START + 0.5 * DIAMETER);
    Ok(Dem3::new(granular_dem::Setup {
        materials,
        grains: vec![Grain::at(place, 0.5 * DIAMETER, nylon)],
        walls: vec![Wall::plane("floor", DVec3::ZERO, DVec3::Z, nylon)?],
        gravity: GRAVITY,
        options: Options::default(),
    })?)
}

/// Lets the sphere fall until it is `stop` \[m\] above the floor; its largest speed over that in an endless oil, and the time of the fall \[s\].
fn fall(oil: &Oil, cells: f64, stop: f64) -> Result<[f64; 2], Box<dyn Error>> {
    let setup = fluid(oil, cells);
    let (dt, tau) = (setup.time_step, setup.tau());
    let mut simulation = Simulation::named("oil", Box::new(Lbm3::new(setup)?));
    let liquid = simulation.find::<Lbm3>("oil").expect("it was named so");
    let ball = simulation.add("sphere", sphere(dt)?)?;
    let options = ResolvedOptions { gravity: Some(GRAVITY), ..ResolvedOptions::default() };
    simulation.couple(liquid, ball, ResolvedGrains::new(options))?;
    simulation.begin_segment(dt)?;
    let mut largest = 0.0_f64;
    // An endless oil would let it fall in less.
    while simulation.clock().time() < 2.0 * START / oil.speed {
        simulation.advance(10)?;
        let grain = simulation.get(ball).grain(0);
        largest = largest.max(-grain.velocity.z);
        if grain.position.z - 0.5 * DIAMETER < stop {
            break;
        }
    }
    let reynolds = oil.speed * DIAMETER * oil.density / oil.viscosity;
    println!(
        "Reynolds number {reynolds:.1}, relaxation time {tau:.3}: largest speed {:.4} of {:.3} m/s, measured {:.3}; at {:.1} mm after {:.3} s",
        largest / oil.speed,
        oil.speed,
        oil.largest,
        1e3 * (simulation.get(ball).grain(0).position.z - 0.5 * DIAMETER),
        simulation.clock().time()
    );
    Ok([largest / oil.speed, simulation.clock().time()])
}

fn main() -> Result<(), Box<dyn Error>> {
    let cells: f64 = std::env::args().nth(1).map_or(Ok(10.0), |text| text.parse())?;
    for oil in &OILS {
        let [largest, _] = fall(oil, cells, 0.5e-3)?;
        assert!((largest / oil.largest - 1.0).abs() < 0.05, "{largest} where {} was measured", oil.largest);
    }
    Ok(())
}

/// Coarse, and the start of the fall alone.
#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    let [largest, _] = fall(&OILS[1], 5.0, 0.1)?;
    assert!(largest > 0.5 && largest < 1.1, "{largest}");
    Ok(())
}
