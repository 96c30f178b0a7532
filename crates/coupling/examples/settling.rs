//! Disks settle in a closed tank of water, which flows between them; what this costs beside water alone.
//!
//! ```sh
//! cargo run --release -p granular-coupling --example settling
//! ```

use granular_core::glam::DVec2;
use granular_core::{NodeKey, Simulation, Solver};
use granular_coupling::{ResolvedGrains, ResolvedOptions};
use granular_dem::{Dem2, Grain, Material, Materials, Options, Wall};
use granular_lbm::{Face, Lbm2, Setup};
use std::error::Error;
use std::time::Instant;

/// Edge of a cell \[m\].
const SPACING: f64 = 1e-4;
/// Density of disks \[kg/m^3\] in water of 1000.
const DENSITY: f64 = 2000.0;
/// A hundredth of the weight on earth \[m/s^2\] keeps speeds below a tenth of that of the lattice.
const GRAVITY: DVec2 = DVec2::new(0.0, -0.0981);

/// Water in a closed square tank of so many cells.
fn tank(cells: usize) -> Setup<granular_core::D2> {
    let mut setup = Setup::new([cells, cells, 1], SPACING, 1e-6, 0.6);
    setup.faces = [[Face::REST, Face::REST], [Face::REST, Face::REST], setup.faces[2].clone()];
    setup
}

/// A square of `side` times `side` disks in the middle of the tank, all a little off their places, with walls around.
fn disks(setup: &Setup<granular_core::D2>, side: usize, radius: f64) -> Result<Dem2, Box<dyn Error>> {
    let edge = setup.cells[0] as f64 * SPACING;
    let mut materials = Materials::new();
    // Soft enough for about ten steps in one of the water.
    let mass = DENSITY * std::f64::consts::PI * radius * radius;
    let normal_stiffness = 0.5 * mass * (std::f64::consts::PI / (2.5 * setup.time_step)).powi(2);
    let stone = materials.add(Material { density: DENSITY, normal_stiffness, ..Material::default() })?;
    let pitch = edge / side as f64;
    let place = |k: usize| {
        let (column, row) = ((k % side) as f64, (k / side) as f64);
        DVec2::new(column + 0.5 + 0.01 * (row % 3.0 - 1.0), row + 0.5 + 0.01 * (column % 3.0 - 1.0)) * pitch
    };
    let corners = [(DVec2::ZERO, DVec2::Y), (DVec2::ZERO, DVec2::X), (DVec2::splat(edge), -DVec2::X)];
    let walls = corners.iter().zip(["floor", "left", "right"]);
    let walls = walls.map(|((point, normal), name)| Wall::plane(name, *point, *normal, stone));
    Ok(Dem2::new(granular_dem::Setup {
        materials,
        grains: (0..side * side).map(|k| Grain::at(place(k), radius, stone)).collect(),
        walls: walls.collect::<Result<_, _>>()?,
        gravity: GRAVITY,
        options: Options::default(),
    })?)
}

/// A simulation, its water and its disks.
type Coupled = (Simulation, NodeKey<Lbm2>, NodeKey<Dem2>);

/// Water and disks in one simulation.
fn coupled(cells: usize, side: usize, radius: f64) -> Result<Coupled, Box<dyn Error>> {
    let setup = tank(cells);
    let (dt, disks) = (setup.time_step, disks(&setup, side, radius * SPACING)?);
    let mut simulation = Simulation::named("water", Box::new(Lbm2::new(setup)?));
    let water = simulation.find::<Lbm2>("water").expect("it was named so");
    let disks = simulation.add("disks", disks)?;
    // The pressure of the water is that above the one at rest: its weight is felt by the disks alone.
    let options = ResolvedOptions { gravity: Some(GRAVITY), ..ResolvedOptions::default() };
    simulation.couple(water, disks, ResolvedGrains::new(options))?;
    simulation.begin_segment(dt)?;
    Ok((simulation, water, disks))
}

/// Least seconds per step of `advance` in a few calls of `steps` steps.
fn seconds(
    steps: u64,
    mut advance: impl FnMut(u64) -> Result<(), Box<dyn Error>>,
) -> Result<f64, Box<dyn Error>> {
    advance(steps)?;
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let begun = Instant::now();
        advance(steps)?;
        best = best.min(begun.elapsed().as_secs_f64() / steps as f64);
    }
    Ok(best)
}

/// Lets disks of a radius in cells settle, and tells what a step costs over one of the water alone.
fn settle(cells: usize, side: usize, radius: f64, steps: u64) -> Result<f64, Box<dyn Error>> {
    let mut alone = Lbm2::new(tank(cells))?;
    let dt = alone.setup().time_step;
    let fused = seconds(steps, |steps| Ok(alone.advance(dt, steps)?))?;
    let single = seconds(steps, |steps| Ok((0..steps).try_for_each(|_| alone.step(dt))?))?;
    let (mut simulation, _, disks) = coupled(cells, side, radius)?;
    let height = |simulation: &Simulation| {
        let dem = simulation.get(disks);
        dem.grains().map(|(_, grain)| grain.position.y).sum::<f64>() / dem.len() as f64
    };
    let before = height(&simulation);
    let both = seconds(steps, |steps| Ok(simulation.advance(steps)?))?;
    let taken = simulation.get(disks).steps() / simulation.clock().step();
    let solid = (side * side) as f64 * std::f64::consts::PI * radius * radius / (cells * cells) as f64;
    println!(
        "{cells} x {cells} cells, {} disks of {radius} cells, {:.0} % solid: {:.0} million cells a second; with disks, which take {taken} steps \
         within each, {:.2} times as long, {:.2} times if the water takes its steps one by one too",
        side * side,
        100.0 * solid,
        1e-6 * (cells * cells) as f64 / fused,
        both / fused,
        both / single
    );
    assert!(height(&simulation) < before, "disks settle");
    Ok(both / fused)
}

fn main() -> Result<(), Box<dyn Error>> {
    for (side, radius) in [(10, 10.0), (10, 15.0), (20, 7.5)] {
        settle(400, side, radius, 200)?;
    }
    settle(800, 20, 10.0, 100)?;
    Ok(())
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    settle(60, 3, 6.0, 20).map(|_| ())
}
