//! The contacts of three disks at rest between two walls: who touches whom, and with what force.
//!
//! ```sh
//! cargo run --release -p granular-dem --example contacts
//! ```

use granular_dem::granular_core::{Solver, glam::DVec2};
use granular_dem::{Contact, Dem2, Grain, Material, Materials, Options, Partner, Setup, Wall};
use std::error::Error;

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default())?;
    let height = RADIUS * (1.0 + 3.0_f64.sqrt());
    let places = [(-RADIUS, RADIUS), (RADIUS, RADIUS), (0.0, height)];
    let mut dem = Dem2::new(Setup {
        materials,
        grains: places.map(|(x, y)| Grain::at(DVec2::new(x, y), RADIUS, glass)).to_vec(),
        walls: vec![
            Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass)?,
            Wall::plane("left", DVec2::new(-2.0 * RADIUS, 0.0), DVec2::X, glass)?,
            Wall::plane("right", DVec2::new(2.0 * RADIUS, 0.0), DVec2::NEG_X, glass)?,
        ],
        gravity: DVec2::new(0.0, -GRAVITY),
        options: Options::default(),
    })?;
    let dt = dem.recommended_step();
    dem.advance(dt, (0.05 / dt) as u64)?;

    // Contacts count grains in the order of memory, which may change; identifiers do not.
    let identifiers: Vec<u32> = dem.grains().map(|(id, _)| id).collect();
    dem.visit_contacts(&mut |contact: Contact<_>| {
        let partner = match contact.partner {
            Partner::Grain(index) => format!("grain {}", identifiers[index]),
            Partner::Wall(index) => dem.walls()[index].name.clone(),
        };
        println!(
            "grain {} and {partner:7}: overlap {:.2e} m, force ({:+.3}, {:+.3}) N/m, {:.1} degrees from the normal",
            identifiers[contact.first],
            contact.overlap,
            contact.force.x,
            contact.force.y,
            contact.force.angle_to(contact.normal).abs().to_degrees(),
        );
    });

    // Forces on walls, in the order of `walls`: the floor and the friction of the sides carry the weight.
    let weight = 3.0 * 2650.0 * std::f64::consts::PI * RADIUS.powi(2) * GRAVITY;
    let carried: f64 = -dem.wall_forces().iter().map(|force| force.y).sum::<f64>();
    println!("weight {weight:.4} N/m, carried by walls {carried:.4} N/m");
    assert!((carried / weight - 1.0).abs() < 1e-3);
    Ok(())
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
