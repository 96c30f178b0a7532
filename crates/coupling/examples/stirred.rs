//! A disk on a prescribed circle stirs the water of a square tank: two solvers and a law between them.
//!
//! ```sh
//! cargo run --release -p granular-coupling --example stirred
//! ```

use granular_core::Simulation;
use granular_core::glam::DVec2;
use granular_coupling::{Body, CarriedObstacles, Path, PrescribedMotion};
use granular_lbm::{Ball, Face, Lbm2, Obstacle, Setup};
use std::error::Error;

const CELLS: usize = 40;
const SPACING: f64 = 1e-3;
const RADIUS: f64 = 4e-3;
/// Angular velocity \[rad/s\] of the disk on its circle, anticlockwise.
const RATE: f64 = 0.2;

fn main() -> Result<(), Box<dyn Error>> {
    let middle = DVec2::splat(0.5 * CELLS as f64 * SPACING);
    let start = middle + DVec2::new(9e-3, 0.0);
    let mut setup = Setup::new([CELLS, CELLS, 1], SPACING, 1e-6, 0.8);
    setup.faces = [[Face::REST, Face::REST], [Face::REST, Face::REST], setup.faces[2].clone()];
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: start, radius: RADIUS }));
    let dt = setup.time_step;
    let path = Path::Orbit { centre: middle, rate: RATE };
    let disk = PrescribedMotion::new(vec![Body::new(start, RADIUS, path)])?;

    let mut simulation = Simulation::named("water", Box::new(Lbm2::new(setup)?));
    let water = simulation.find::<Lbm2>("water").expect("it was named so");
    let disk = simulation.add("disk", disk)?;
    simulation.couple(water, disk, CarriedObstacles::all())?;
    simulation.begin_segment(dt)?;

    let turn = (std::f64::consts::TAU / RATE / dt) as u64;
    for _ in 0..4 {
        simulation.advance(turn / 4)?;
        let water = simulation.get(water);
        let (force, spin) = (water.force_on(0), spin(water, middle));
        println!("force on the disk ({:+.2e}, {:+.2e}) N/m, mean r x u {spin:+.2e} m^2/s", force.x, force.y);
    }
    assert!(spin(simulation.get(water), middle) > 0.0, "the water follows the disk");
    Ok(())
}

/// Mean of `r x u` over the water \[m^2/s\].
fn spin(water: &Lbm2, middle: DVec2) -> f64 {
    let cells = (0..CELLS).flat_map(|y| (0..CELLS).map(move |x| [x, y, 0]));
    let turning =
        cells.filter_map(|cell| Some((water.centre(cell) - middle).perp_dot(water.flow(cell)?.velocity)));
    turning.sum::<f64>() / (CELLS * CELLS) as f64
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
