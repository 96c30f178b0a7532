//! Two materials whose contact is stated instead of mixed from both: disks that slide down a slope of 45 degrees, steel
//! on steel and steel on rubber.
//!
//! ```sh
//! cargo run --release -p granular-dem --example pair_override
//! ```

use granular_dem::granular_core::{Solver, glam::DVec2};
use granular_dem::{Dem2, Grain, Material, MaterialId, Materials, Options, PairOverride, Setup, Wall};
use std::error::Error;

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 1e-3;
const FRICTION: [f64; 2] = [0.1, 0.25];

fn main() -> Result<(), Box<dyn Error>> {
    let mut materials = Materials::new();
    let steel = materials.add(Material { friction: FRICTION[0], ..Material::default() })?;
    let rubber = materials.add(Material { friction: 0.8, ..Material::default() })?;
    // What is not stated here, such as the restitution, stays mixed from steel and rubber.
    let stated = PairOverride { friction: Some(FRICTION[1]), ..PairOverride::default() };
    materials.set_pair(steel, rubber, stated)?;

    for (name, floor, friction) in [("steel", steel, FRICTION[0]), ("rubber", rubber, FRICTION[1])] {
        let seconds = 0.2;
        let speed = speed_after(seconds, &materials, steel, floor)?;
        // A disk slides as long as the slope is steeper than three times the friction.
        let expected = GRAVITY * 0.5_f64.sqrt() * (1.0 - friction) * seconds;
        println!("steel on {name:6}: {speed:.4} m/s after {seconds} s; closed form {expected:.4} m/s");
        assert!((speed / expected - 1.0).abs() < 1e-3);
    }
    Ok(())
}

/// Speed \[m/s\] of a disk that starts at rest on a floor, with gravity at 45 degrees to it.
fn speed_after(
    seconds: f64,
    materials: &Materials,
    disk: MaterialId,
    floor: MaterialId,
) -> Result<f64, Box<dyn Error>> {
    let mut dem = Dem2::new(Setup {
        materials: materials.clone(),
        grains: vec![Grain::at(DVec2::new(0.0, RADIUS), RADIUS, disk)],
        walls: vec![Wall::plane("floor", DVec2::ZERO, DVec2::Y, floor)?],
        gravity: DVec2::new(1.0, -1.0).normalize() * GRAVITY,
        options: Options::default(),
    })?;
    let steps = (seconds / dem.recommended_step()).ceil();
    dem.advance(seconds / steps, steps as u64)?;
    Ok(dem.grain(0).velocity.x)
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
