//! Walls of many parts: a flat strip is a plane, corners are corners, and history crosses joints.

use crate::sample::{Lattice, Random, down};
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Linear, Solver, Vector, contract_tests};
use granular_dem::{
    Dem, Dem2, Dem3, Grain, Material, MaterialId, Materials, Options, Setup, Wall, WallMotion,
};
use std::f64::consts::TAU;

const FAR: f64 = 20e-3;

/// A floor of uneven segments of about a third of a radius.
fn strip(glass: MaterialId) -> Wall<D2> {
    let mut random = Random::new(5);
    let mut points = vec![DVec2::new(-FAR, 0.0)];
    while points[points.len() - 1].x < FAR {
        points.push(points[points.len() - 1] + DVec2::X * random.within(0.1e-3, 0.5e-3));
    }
    Wall::chain("floor", &points, false, glass).unwrap()
}

/// A floor of uneven triangles, two for each square of a lattice with corners out of place.
fn tiles(glass: MaterialId) -> Wall<D3> {
    let (mut random, count, size) = (Random::new(6), 60_usize, 2.0 * FAR / 60.0);
    let corners: Vec<DVec3> = (0..=count * (count + 2))
        .map(|k| {
            let at =
                DVec3::new((k % (count + 1)) as f64 * size - FAR, (k / (count + 1)) as f64 * size - FAR, 0.0);
            at + DVec3::new(random.within(-0.2, 0.2), random.within(-0.2, 0.2), 0.0) * size
        })
        .collect();
    let triangles: Vec<[DVec3; 3]> = (0..count * count)
        .flat_map(|k| {
            let at = |x: usize, y: usize| corners[(k / count + y) * (count + 1) + k % count + x];
            [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(0, 1), at(1, 1)]]
        })
        .collect();
    Wall::triangles("floor", triangles.into_flattened(), glass).unwrap()
}

/// A ball that falls on a floor with speed and spin, bounces, slides and rolls.
fn tumbling<D: Dim>(floor: impl Fn(MaterialId) -> Wall<D>, material: Material) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let start = D::Vec::along(D::UP, 1.05e-3) + D::Vec::along(0, -0.5 * FAR);
    let velocity =
        (0..D::N - 1).fold(D::Vec::ZERO, |v, axis| v + D::Vec::along(axis, 0.3 / (1 + axis) as f64));
    let spin = <D::Spin as granular_core::Spin>::of_components([20.0, -30.0, 100.0]);
    let grains = vec![Grain::at(start, 1e-3, glass).moving(velocity).turning(spin)];
    let walls = vec![floor(glass)];
    let options = Options { ledger: true, ..Options::default() };
    Dem::new(Setup { materials, grains, walls, gravity: down::<D>(9.81), options }).unwrap()
}

/// Largest differences of position \[m\], velocity \[m/s\], rim speed \[m/s\], force \[weight\] and losses (relative).
fn difference<D: Dim>(many: impl Fn(MaterialId) -> Wall<D>, material: Material) -> [f64; 5] {
    let plane = |glass| Wall::plane("floor", D::Vec::ZERO, D::Vec::along(D::UP, 1.0), glass).unwrap();
    let (mut one, mut other) = (tumbling::<D>(plane, material), tumbling::<D>(many, material));
    let dt = one.recommended_step();
    let weight = 2650.0 * D::ball_volume(1e-3) * 9.81;
    let mut worst = [0.0_f64; 5];
    for _ in 0..2000 {
        let steps = (0.03 / 2000.0 / dt).ceil() as u64;
        one.advance(dt, steps).unwrap();
        other.advance(dt, steps).unwrap();
        let (a, b) = (one.grain(0), other.grain(0));
        let found = [
            (a.position - b.position).length(),
            (a.velocity - b.velocity).length(),
            (a.spin - b.spin).length() * 1e-3,
            (one.wall_forces()[0] - other.wall_forces()[0]).length() / weight,
            (one.losses().total() - other.losses().total()).abs() / one.losses().total().max(1e-12),
        ];
        worst.iter_mut().zip(found).for_each(|(worst, found)| *worst = worst.max(found));
    }
    assert!((one.grain(0).position.component(0) + 0.5 * FAR).abs() > 3e-3, "it rolls over many parts");
    assert!(one.losses().sliding_at_walls > 0.0 && other.energy_residual().unwrap().is_finite());
    worst
}

#[test]
fn a_flat_strip_of_many_parts_is_a_plane() {
    for rolling_friction in [0.0, 0.05] {
        let material = Material { restitution: 0.5, friction: 0.3, rolling_friction, ..Material::default() };
        let (chain, mesh) = (difference::<D2>(strip, material), difference::<D3>(tiles, material));
        println!("{chain:?} {mesh:?}");
        for [position, velocity, rim, force, losses] in [chain, mesh] {
            assert!(position < 1e-12 && velocity < 1e-9 && rim < 1e-9, "{position:e} {velocity:e} {rim:e}");
            assert!(force < 1e-5 && losses < 1e-6, "{force:e} {losses:e}");
        }
    }
}

#[test]
fn a_grain_in_a_corner_touches_both_sides_and_at_a_joint_one() {
    let contacts = |points: &[DVec2], at: DVec2| {
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        let walls = vec![Wall::chain("chain", points, false, glass).unwrap()];
        let grains = vec![Grain::at(at, 1e-3, glass)];
        let setup = Setup { materials, grains, walls, gravity: DVec2::ZERO, options: Options::default() };
        let mut normals = Vec::new();
        Dem2::new(setup).unwrap().visit_contacts(&mut |contact| normals.push(contact.normal));
        normals
    };
    let (left, right) = (DVec2::new(-5e-3, 0.0), DVec2::new(5e-3, 0.0));
    let inside = 0.99e-3;
    // A right angle, a ridge, a flat joint, a joint bent by a degree either way.
    let corner = contacts(&[DVec2::new(0.0, 5e-3), DVec2::ZERO, right], DVec2::splat(inside));
    assert_eq!(corner.len(), 2, "{corner:?}");
    let ridge = contacts(&[left, DVec2::new(0.0, 5e-3), right], DVec2::new(0.0, 5e-3 + inside));
    assert_eq!(ridge, vec![DVec2::Y]);
    for bend in [0.0, 1e-12, 1e-4, -1e-4] {
        let joint = contacts(&[left, DVec2::new(0.0, -bend), right], DVec2::new(1e-9, inside - bend));
        assert_eq!(joint.len(), 1, "{bend}: {joint:?}");
    }
    // The end of a chain.
    let end = contacts(&[left, DVec2::ZERO], DVec2::new(inside, 0.0));
    assert_eq!(end, vec![DVec2::X]);
}

#[test]
fn crossing_joints_makes_no_energy() {
    // A frictionless elastic disk slides to and fro in a bowl of 40 chords: nothing may be lost or won.
    let mut materials = Materials::new();
    let glass = materials.add(Material { restitution: 1.0, friction: 0.0, ..Material::default() }).unwrap();
    let points: Vec<DVec2> = (0..=40)
        .map(|k| DVec2::from_angle(std::f64::consts::PI * (1.0 + f64::from(k) / 40.0)) * 10e-3)
        .collect();
    let walls = vec![Wall::chain("bowl", &points, false, glass).unwrap()];
    let grains = vec![Grain::at(DVec2::new(-7e-3, -3e-3), 1e-3, glass)];
    let options = Options { ledger: true, ..Options::default() };
    let setup = Setup { materials, grains, walls, gravity: down::<D2>(9.81), options };
    let mut dem = Dem2::new(setup).unwrap();
    let dt = dem.recommended_step() / 4.0;
    let start = dem.energies();
    let (mut worst, mut deepest) = (0.0_f64, 0.0_f64);
    for _ in 0..400 {
        dem.advance(dt, 1000).unwrap();
        let scale = start.mechanical() - start.potential + 2650.0 * D2::ball_volume(1e-3) * 9.81 * 6e-3;
        worst = worst.max((dem.energies().mechanical() - start.mechanical()).abs() / scale);
        deepest = deepest.min(dem.grain(0).position.y);
    }
    println!("energy of a disk in a bowl of chords changes by {worst:.1e}");
    assert!(deepest < -8.5e-3 && worst < 1e-3, "{deepest} {worst:e}");
}

/// A drum of 24 chords that turns, half full, on a bumpy floor of held grains that swings.
fn drum() -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(Material { rolling_friction: 0.02, ..Material::default() }).unwrap();
    let lattice = Lattice { side: 46, ..Lattice::default() };
    let (centre, radius) = (DVec2::splat(23e-3), 22e-3);
    let points: Vec<DVec2> =
        (0..24).map(|k| centre + DVec2::from_angle(TAU * f64::from(k) / 24.0) * radius).collect();
    let drum = Wall::chain("drum", &points, true, glass)
        .unwrap()
        .moving(WallMotion::Turning { about: centre, spin: 20.0 });
    let held: Vec<(DVec2, f64)> =
        (0..12).map(|k| (DVec2::new(17e-3 + 1e-3 * f64::from(k), 20e-3), 0.5e-3)).collect();
    let held = Wall::held_grains("comb", &held, glass).unwrap();
    let mut grains = lattice.grains::<D2>(&[glass]);
    grains.retain(|grain| {
        let inside = (grain.position - centre).length() < radius - 1.5 * grain.radius;
        let clear = |wall: &Wall<D2>| wall.shape.distance(grain.position).0 > 0.99 * grain.radius;
        inside && clear(&drum) && clear(&held)
    });
    let swing = WallMotion::Oscillating { amplitude: DVec2::new(30e-6, 0.0), frequency: 2000.0, phase: 0.0 };
    let walls = vec![drum, held.moving(swing)];
    let options = Options { skin: 0.02, ledger: true, ..Options::default() };
    Dem2::new(Setup { materials, grains, walls, gravity: down::<D2>(9.81), options }).unwrap()
}

/// Spheres in a box on a floor of tiles.
fn tiled() -> Dem3 {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let lattice = Lattice { side: 12, speed: 10.0, ..Lattice::default() };
    let mut walls = lattice.walls::<D3>(glass);
    walls[4] = tiles(glass);
    let grains = lattice.grains::<D3>(&[glass]);
    let options = Options { skin: 0.02, ..Options::default() };
    Dem3::new(Setup { materials, grains, walls, gravity: down::<D3>(9.81), options }).unwrap()
}

contract_tests!(disks_in_a_drum, drum, 1.5e-6, warm_up = 1500);
contract_tests!(spheres_on_tiles, tiled, 4e-8, warm_up = 1500);

#[test]
fn the_books_of_a_drum_balance_and_its_walls_are_touched() {
    let mut dem = drum();
    let start = dem.energies().mechanical();
    let mut touched = [false; 2];
    for _ in 0..100 {
        dem.advance(1.5e-6, 20).unwrap();
        touched
            .iter_mut()
            .zip(dem.wall_forces())
            .for_each(|(touched, force)| *touched |= force.length() > 0.0);
    }
    assert_eq!(touched, [true; 2]);
    let residual = dem.energy_residual().unwrap().abs() / start;
    println!("drum: residual {residual:.1e}, work {:.2e} of {start:.2e}", dem.wall_work());
    assert!(residual < 1e-3, "{residual:e}");
}
