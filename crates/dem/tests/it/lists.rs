//! Neighbour lists change the speed and never the result.

use crate::sample::{Lattice, down};
use granular_core::{D2, D3, Dim, Linear, Section, Solver};
use granular_dem::{Dem, Material, Materials, Options, Setup};

/// State after `steps` steps with lists of this reach.
fn state<D: Dim>(lattice: Lattice, skin: f64, dt: f64, steps: u64, shot: f64) -> Section {
    let mut materials = Materials::new();
    let glass = materials.add(Material { rolling_friction: 0.05, ..Material::default() }).unwrap();
    let (mut grains, walls) = (lattice.grains::<D>(&[glass]), lattice.walls::<D>(glass));
    let middle = grains.len() / 2;
    let speed = grains[middle].velocity.length();
    grains[middle].velocity = grains[middle].velocity * (shot / speed);
    let options = Options { skin, ..Options::default() };
    let setup = Setup { materials, grains, walls, gravity: down::<D>(9.81), options };
    let mut dem = Dem::<D>::new(setup).unwrap();
    dem.advance(dt, steps).unwrap();
    let mut section = Section::new("solver");
    dem.save(&mut section);
    section
}

fn no_skin_matters<D: Dim>(lattice: Lattice, dt: f64, steps: u64, shot: f64) {
    let expected = state::<D>(lattice, 0.5, dt, steps, shot);
    assert_ne!(expected, state::<D>(lattice, 0.5, dt, steps - 1, shot));
    for skin in [0.001, 0.05, 0.25, 2.0] {
        assert!(state::<D>(lattice, skin, dt, steps, shot) == expected, "{} skin {skin}", D::BALL);
    }
}

#[test]
fn the_skin_changes_no_bits_of_dense_disks_and_spheres() {
    no_skin_matters::<D2>(Lattice { side: 24, ..Lattice::default() }, 2e-6, 600, 1.0);
    no_skin_matters::<D3>(Lattice { side: 9, speed: 10.0, ..Lattice::default() }, 4e-8, 400, 10.0);
}

#[test]
fn the_skin_changes_no_bits_of_a_gas_with_one_fast_grain() {
    let loose = Lattice { spacing: 2e-3, jitter: 400e-6, speed: 3.0, ..Lattice::default() };
    no_skin_matters::<D2>(Lattice { side: 20, ..loose }, 2e-6, 1500, 6.0);
    no_skin_matters::<D3>(Lattice { side: 8, speed: 30.0, ..loose }, 4e-8, 1500, 70.0);
}
