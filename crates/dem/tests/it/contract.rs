//! The contract of every solver, for every combination of features that has its own kernel or
//! its own arrays.

use crate::sample::{Lattice, down};
use granular_core::glam::DVec2;
use granular_core::{D2, D3, Dim, Section, Solver, contract_tests};
use granular_dem::{ContactModel, Dem, Dem2, Elasticity, Material, Materials, Options, Setup, Tension, Wall};

/// A box of moving grains in touch, with lists so short that they are rebuilt every few steps.
fn boxed<D: Dim>(lattice: Lattice, material: Material, options: Options) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let grains = lattice.grains::<D>(&[glass]);
    let walls = lattice.walls::<D>(glass);
    let setup = Setup { materials, grains, walls, gravity: down::<D>(9.81), options };
    Dem::new(setup).unwrap()
}

fn short_lists() -> Options {
    Options { skin: 0.02, ..Options::default() }
}

/// Disks with friction: 2304 in 16 blocks.
fn disks() -> Dem2 {
    boxed::<D2>(Lattice::default(), Material::default(), short_lists())
}

fn smooth() -> Material {
    Material { friction: 0.0, ..Material::default() }
}

fn resisting() -> Material {
    Material { rolling_friction: 0.1, ..Material::default() }
}

fn with_ledger() -> Options {
    Options { ledger: true, ..short_lists() }
}

/// Elastic, so that a contact lasts about as long as that of the linear law.
fn elastic(material: Material) -> Material {
    let elasticity = Some(Elasticity { young_modulus: 4e10, poisson_ratio: 0.25 });
    Material { elasticity, normal_stiffness: 0.0, ..material }
}

fn hertz(options: Options) -> Options {
    Options { contact: ContactModel::Hertz, ..options }
}

fn twisting() -> Material {
    Material { twisting_friction: 0.1, ..resisting() }
}

/// A small box of spheres.
fn few() -> Lattice {
    Lattice { side: 10, speed: 10.0, ..Lattice::default() }
}

/// Disks of two materials in a box with an inclined segment, a block and an open gate, all of
/// which some disks touch.
fn disks_among_walls() -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let rubber = materials.add(Material { restitution: 0.4, normal_stiffness: 4e5, ..resisting() }).unwrap();
    let lattice = Lattice { side: 46, ..Lattice::default() };
    let mut walls = lattice.walls::<D2>(rubber);
    walls
        .push(Wall::segment("chute", DVec2::new(0.0102, 0.0201), DVec2::new(0.0193, 0.0128), glass).unwrap());
    walls.push(Wall::block("block", DVec2::new(0.030, 0.020), DVec2::new(0.034, 0.022), rubber).unwrap());
    walls.push(Wall::plane("gate", DVec2::new(0.020, 0.0), -DVec2::X, glass).unwrap());
    let mut grains = lattice.grains::<D2>(&[glass, rubber, glass]);
    // Room for the two walls inside.
    grains.retain(|grain| {
        let inside = &walls[4..6];
        inside.iter().all(|wall| wall.shape.distance(grain.position).0 > 0.99 * grain.radius)
    });
    let options = Options { tension: Tension::Kept, ..with_ledger() };
    walls[6].open = true;
    Dem2::new(Setup { materials, grains, walls, gravity: down::<D2>(9.81), options }).unwrap()
}

/// Disks that will be sorted in memory within the next steps: the count of steps says when.
fn disks_before_sorting() -> Dem2 {
    let mut dem = disks();
    let mut section = Section::new("solver");
    dem.save(&mut section);
    let mut later = Section::new("solver");
    for (name, bytes) in section.entries() {
        let bytes = if name == "steps" { 4985_u64.to_le_bytes().to_vec() } else { bytes.to_vec() };
        later.put_bytes(name, bytes);
    }
    dem.restore(&later).unwrap();
    dem
}

/// Spheres with friction: 2744 in 16 blocks.
fn spheres() -> Dem<D3> {
    boxed::<D3>(Lattice { side: 14, speed: 10.0, ..Lattice::default() }, Material::default(), short_lists())
}

/// Half of the recommended step, rounded so that it is the same number everywhere.
const DISK_STEP: f64 = 1.5e-6;
const SPHERE_STEP: f64 = 4e-8;

contract_tests!(disks_with_friction, disks, DISK_STEP, warm_up = 600);
contract_tests!(
    disks_without_friction,
    || boxed::<D2>(Lattice::default(), smooth(), with_ledger()),
    DISK_STEP,
    warm_up = 600
);
contract_tests!(
    disks_with_rolling_resistance,
    || boxed::<D2>(Lattice::default(), resisting(), with_ledger()),
    DISK_STEP,
    warm_up = 600
);
contract_tests!(disks_of_two_materials_among_walls, disks_among_walls, DISK_STEP, warm_up = 600);
contract_tests!(disks_sorted_on_the_way, disks_before_sorting, DISK_STEP, warm_up = 600);
contract_tests!(spheres_with_friction, spheres, SPHERE_STEP, warm_up = 600);
contract_tests!(
    spheres_with_rolling_resistance,
    || boxed::<D3>(Lattice { side: 10, speed: 10.0, ..Lattice::default() }, resisting(), with_ledger()),
    SPHERE_STEP,
    warm_up = 600
);
contract_tests!(
    spheres_without_friction,
    || boxed::<D3>(Lattice { side: 10, speed: 10.0, ..Lattice::default() }, smooth(), short_lists()),
    SPHERE_STEP,
    warm_up = 600
);

contract_tests!(
    spheres_with_twisting_resistance,
    || boxed::<D3>(few(), twisting(), with_ledger()),
    SPHERE_STEP,
    warm_up = 600
);
contract_tests!(
    hertz_disks_with_friction,
    || boxed::<D2>(Lattice::default(), elastic(Material::default()), hertz(with_ledger())),
    DISK_STEP,
    warm_up = 600
);
contract_tests!(
    hertz_disks_with_rolling_resistance,
    || boxed::<D2>(Lattice::default(), elastic(resisting()), hertz(short_lists())),
    DISK_STEP,
    warm_up = 600
);
contract_tests!(
    hertz_spheres_without_friction,
    || boxed::<D3>(few(), elastic(smooth()), hertz(with_ledger())),
    SPHERE_STEP,
    warm_up = 600
);
contract_tests!(
    hertz_spheres_with_friction,
    || boxed::<D3>(few(), elastic(Material::default()), hertz(short_lists())),
    SPHERE_STEP,
    warm_up = 600
);
contract_tests!(
    hertz_spheres_with_twisting_resistance,
    || boxed::<D3>(few(), elastic(twisting()), hertz(with_ledger())),
    SPHERE_STEP,
    warm_up = 600
);

#[test]
fn the_samples_have_several_blocks_contacts_of_all_kinds_and_a_history() {
    let mut dem = disks_among_walls();
    dem.advance(DISK_STEP, 50).unwrap();
    let mut by_wall = vec![0; dem.walls().len()];
    let mut pairs = 0;
    dem.visit_contacts(&mut |contact| match contact.partner {
        granular_dem::Partner::Wall(wall) => by_wall[wall] += 1,
        granular_dem::Partner::Grain(_) => pairs += 1,
    });
    assert!(pairs > 1000 && dem.len() > 2000, "{pairs} contacts of {} grains", dem.len());
    assert!(by_wall[..6].iter().all(|&count| count > 0) && by_wall[6] == 0, "{by_wall:?}");
    let mut section = Section::new("solver");
    dem.save(&mut section);
    assert!(section.array::<[u32; 2]>("contact pairs").unwrap().len() > 1000);
    assert!(!section.array::<[u32; 2]>("wall contacts").unwrap().is_empty());
    assert!(dem.losses().sliding > 0.0 && dem.losses().sliding_at_walls > 0.0);
}
