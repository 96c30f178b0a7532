//! Wide gradings: neighbours are searched for in levels of size, and nothing else changes.

use crate::sample::{Random, down};
use granular_core::{D2, D3, Dim, Linear, Section, Solver, Vector, contract_tests};
use granular_dem::{Dem, Dem2, Dem3, Grain, Material, Materials, Options, PeriodicCell, Setup, Wall};

/// Largest radius \[m\].
const LARGEST: f64 = 10e-3;

/// Places and radii of balls in a box with this edge, halved in size from the largest down to it over `ratio`: each size on
/// a lattice of its own, wherever there is room, and all but the smallest in a third of the places. The smallest, whose
/// diameter divides the edge, overlap a little.
fn graded<D: Dim>(edge: f64, ratio: f64) -> Vec<(D::Vec, f64)> {
    let (mut random, mut balls) = (Random::new(4), Vec::<(D::Vec, f64)>::new());
    let mut radius = LARGEST;
    loop {
        let last = radius <= LARGEST / ratio;
        let across = (edge / (2.0 * radius) + 1e-9) as usize;
        let (spacing, size) = (edge / across as f64, 1.002 * radius);
        for index in 0..across.pow(D::N as u32) {
            let place = (0..D::N).fold(D::Vec::ZERO, |place, axis| {
                let number = index / across.pow(axis as u32) % across;
                place + D::Vec::along(axis, spacing * (number as f64 + 0.5))
            });
            let wanted = last || random.unit() < 0.3;
            let fits =
                |&(other, r): &(D::Vec, f64)| r == size || (place - other).length() > r + 1.0001 * radius;
            if wanted && balls.iter().all(fits) {
                balls.push((place, size));
            }
        }
        if last {
            // In no order of size or place.
            for k in (1..balls.len()).rev() {
                balls.swap(k, (random.unit() * (k + 1) as f64) as usize);
            }
            return balls;
        }
        radius = (0.5 * radius).max(LARGEST / ratio);
    }
}

/// What is around the balls.
#[derive(Clone, Copy, PartialEq)]
enum Around {
    Walls,
    Cell,
    Nothing,
}

/// Such balls in motion, and `others` after them.
fn sample<D: Dim>(ratio: f64, edge: f64, around: Around, skin: f64, others: &[(D::Vec, f64)]) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(Material { rolling_friction: 0.05, ..Material::default() }).unwrap();
    let mut random = Random::new(9);
    let moving = |(place, radius): (D::Vec, f64)| {
        Grain::at(place, radius, glass).moving(random.vector::<D>(0.3)).turning(random.spin::<D>(30.0))
    };
    let mut grains: Vec<Grain<D>> = graded::<D>(edge, ratio).into_iter().map(moving).collect();
    grains.extend(others.iter().map(|&(place, radius)| Grain::at(place, radius, glass)));
    let wall = |axis: usize, at: f64, towards: f64| {
        let name = format!("{}{}", D::AXES[axis], if at > 0.0 { "_high" } else { "_low" });
        Wall::plane(&name, D::Vec::along(axis, at), D::Vec::along(axis, towards), glass).unwrap()
    };
    let axes = if around == Around::Walls { 0..D::N } else { 0..0 };
    let walls = axes.flat_map(|axis| [wall(axis, 0.0, 1.0), wall(axis, edge, -1.0)]).collect();
    let options = Options { skin, ..Options::default() };
    let mut dem = Dem::new(Setup { materials, grains, walls, gravity: down::<D>(9.81), options }).unwrap();
    if around == Around::Cell {
        let size = (0..D::N).fold(D::Vec::ZERO, |size, axis| size + D::Vec::along(axis, edge));
        dem.set_cell(PeriodicCell::new(D::Vec::ZERO, size, &[true; 3][..D::N]).unwrap()).unwrap();
    }
    dem
}

fn state<D: Dim>(dem: &Dem<D>) -> Section {
    let mut section = Section::new("solver");
    dem.save(&mut section);
    section
}

fn no_skin_matters<D: Dim>(ratio: f64, edge: f64, around: Around, steps: u64) {
    let run = |skin: f64| {
        let mut dem = sample::<D>(ratio, edge, around, skin, &[]);
        let dt = dem.recommended_step();
        dem.advance(dt, steps).unwrap();
        let contacts = dem.coordination().iter().sum::<u32>();
        assert!(contacts > 20, "only {contacts} contacts");
        state(&dem)
    };
    let expected = run(0.5);
    for skin in [0.01, 0.25, 3.0] {
        assert!(run(skin) == expected, "{} {ratio} skin {skin}", D::BALL);
    }
}

#[test]
fn the_skin_changes_no_bits_of_wide_gradings() {
    no_skin_matters::<D2>(20.0, 50e-3, Around::Walls, 400);
    no_skin_matters::<D2>(20.0, 80e-3, Around::Cell, 400);
    no_skin_matters::<D3>(8.0, 50e-3, Around::Walls, 200);
    no_skin_matters::<D3>(8.0, 50e-3, Around::Cell, 200);
}

/// One small ball far away makes the grading wide; it changes nothing of the others but how they are searched for.
fn both_searches_agree<D: Dim>(ratio: f64, edge: f64) {
    let run = |radius: f64| {
        let far = (0..D::N).fold(D::Vec::ZERO, |far, axis| far + D::Vec::along(axis, 0.5 * edge));
        let far = far + D::Vec::along(0, 100.0 * edge);
        let mut dem = sample::<D>(ratio, edge, Around::Nothing, 0.25, &[(far, radius)]);
        // Beyond the limit of the two lightest grains.
        dem.allow_any_step();
        dem.advance(1e-6, 600).unwrap();
        let last = dem.len() as u32 - 1;
        (0..last).map(|id| dem.grain(id)).map(|g| (g.position, g.velocity, g.spin)).collect::<Vec<_>>()
    };
    assert!(run(0.9 * LARGEST) == run(1e-3 * LARGEST), "{}", D::BALL);
}

#[test]
fn both_searches_give_the_same_bits() {
    both_searches_agree::<D2>(4.0, 100e-3);
    both_searches_agree::<D3>(4.0, 60e-3);
}

/// Disks with sizes from 1 to 20.
fn disks() -> Dem2 {
    sample::<D2>(20.0, 60e-3, Around::Walls, 0.05, &[])
}

fn disks_in_a_cell() -> Dem2 {
    sample::<D2>(20.0, 80e-3, Around::Cell, 0.05, &[])
}

fn spheres() -> Dem3 {
    sample::<D3>(8.0, 50e-3, Around::Walls, 0.05, &[])
}

contract_tests!(wide_disks, disks, 1e-6, warm_up = 600);
contract_tests!(wide_disks_in_a_cell, disks_in_a_cell, 1e-6, warm_up = 600);
contract_tests!(wide_spheres, spheres, 3e-7, warm_up = 1500);
