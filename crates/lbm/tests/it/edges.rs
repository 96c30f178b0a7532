//! Where faces and obstacles of different kinds meet: mass between closed faces, and bodies cut by planes of symmetry.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{Accepts, D2, D3, Dim, Motion, ObstacleMotion, Solver, Vector};
use granular_lbm::*;

const SCHEMES: [WallScheme; 3] = [WallScheme::HalfWay, WallScheme::Bouzidi, WallScheme::Yu];

/// A flow in units of cells and steps.
fn unit<D: Dim>(cells: [usize; 3]) -> Setup<D> {
    let mut setup = Setup::new(cells, 1.0, 0.1, 0.8);
    setup.time_step = 1.0;
    setup.density = 1.0;
    setup
}

/// Largest change of the mass in units of that of a cell, over `steps`.
fn mass_gained<L: Lattice<Q>, const Q: usize>(setup: Setup<L::Dim>, steps: u64) -> f64 {
    let mut lbm = Lbm::<L, Q>::new(setup).unwrap();
    lbm.advance(1.0, steps).unwrap();
    lbm.excess().abs()
}

#[test]
fn closed_boxes_with_any_pair_of_faces_keep_their_mass() {
    let lid = |x: f64, y: f64| Face::Wall(DVec2::new(x, y));
    let boxes: [[[Face<D2>; 2]; 2]; 5] = [
        [[Face::REST, Face::FreeSlip], [Face::REST, lid(0.1, 0.0)]],
        [[Face::FreeSlip, Face::REST], [Face::FreeSlip, lid(0.1, 0.0)]],
        [[Face::FreeSlip, lid(0.0, 0.05)], [Face::REST, lid(0.1, 0.0)]],
        [[lid(0.0, -0.03), lid(0.0, 0.05)], [lid(-0.07, 0.0), lid(0.1, 0.0)]],
        [[Face::FreeSlip, Face::FreeSlip], [Face::FreeSlip, lid(0.1, 0.0)]],
    ];
    for faces in boxes {
        let mut setup = unit::<D2>([16, 14, 1]);
        let what = format!("{faces:?}");
        let [x, y] = faces;
        (setup.faces[0], setup.faces[1]) = (x, y);
        let gained = mass_gained::<D2Q9, 9>(setup, 2000);
        assert!(gained < 1e-10, "{what}: {gained} cells");
    }
}

#[test]
fn closed_boxes_in_space_keep_their_mass() {
    let lid = |velocity: [f64; 3]| Face::Wall(DVec3::from(velocity));
    let boxes: [[[Face<D3>; 2]; 3]; 3] = [
        [[Face::REST, Face::FreeSlip], [Face::FreeSlip, Face::REST], [Face::REST, lid([0.1, 0.06, 0.0])]],
        [[Face::FreeSlip, Face::REST], [Face::Periodic, Face::Periodic], [Face::REST, lid([0.1, 0.06, 0.0])]],
        [
            [Face::REST, lid([0.0, 0.03, -0.05])],
            [lid([0.02, 0.0, 0.04]), Face::FreeSlip],
            [Face::REST, lid([0.1, 0.06, 0.0])],
        ],
    ];
    for faces in boxes {
        let mut setup = unit::<D3>([8, 7, 9]);
        let what = format!("{faces:?}");
        setup.faces = faces;
        let gained = mass_gained::<D3Q19, 19>(setup, 600);
        assert!(gained < 1e-10, "{what}: {gained} cells");
    }
}

/// A block from the floor to a lid that slides over it: neither half may gain from the other.
#[test]
fn halves_of_a_box_under_a_lid_keep_their_masses() {
    let mut setup = unit::<D2>([24, 12, 1]);
    setup.faces[0] = [Face::REST, Face::REST];
    setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(0.1, 0.0))];
    let (low, high) = (DVec2::new(10.0, -1.0), DVec2::new(14.0, 13.0));
    setup.obstacles.push(Obstacle::new("block", Block { low, high }));
    setup.obstacles[0].wall = WallScheme::HalfWay;
    let mut lbm = Lbm2::new(setup).unwrap();
    lbm.advance(1.0, 2000).unwrap();
    let pressure = |x: usize, y: usize| lbm.flow([x, y, 0]).map_or(0.0, |flow| flow.pressure);
    for half in [0..10, 14..24] {
        let sum: f64 = half.flat_map(|x| (0..12).map(move |y| (x, y))).map(|(x, y)| pressure(x, y)).sum();
        assert!(sum.abs() < 1e-10, "{sum}");
    }
}

/// Obstacle and lid that move as one do not disturb a fluid that moves with them.
#[test]
fn a_lid_that_moves_with_a_block_and_the_fluid_disturbs_nothing() {
    let velocity = DVec2::new(0.0625, 0.0);
    let mut setup = unit::<D2>([20, 12, 1]);
    setup.faces[1] = [Face::Wall(velocity), Face::Wall(velocity)];
    for wall in SCHEMES {
        let mut setup = setup.clone();
        let (low, high) = (DVec2::new(6.0, -1.0), DVec2::new(11.0, 5.0));
        setup.obstacles.push(Obstacle::new("block", Block { low, high }));
        (setup.obstacles[0].wall, setup.obstacles[0].velocity) = (wall, velocity);
        let mut lbm = Lbm2::new(setup).unwrap();
        lbm.set_flow(|_| Flow { pressure: 0.0, velocity });
        for step in 0..40 {
            let position = DVec2::new(8.5, 2.0) + velocity * (f64::from(step) + 0.5);
            Accepts::<ObstacleMotion<D2>>::view_mut(&mut lbm)[0] = Motion::new(position, velocity, 0.0);
            lbm.advance(1.0, 1).unwrap();
        }
        for (x, y) in (0..20).flat_map(|x| (0..12).map(move |y| (x, y))) {
            let Some(flow) = lbm.flow([x, y, 0]) else { continue };
            assert!((flow.velocity - velocity).length() < 1e-13, "{wall:?} {x} {y}: {:?}", flow.velocity);
        }
        assert!(lbm.force_on(0).length() < 1e-11, "{wall:?} {}", lbm.force_on(0));
    }
}

/// Runs a flow whose obstacle moves along a velocity; gives force and torque, and the velocity in some cells.
fn loads<L: Lattice<Q>, const Q: usize>(
    setup: Setup<L::Dim>,
    velocity: <L::Dim as Dim>::Vec,
    cells: &[[usize; 3]],
) -> ([f64; 3], [f64; 3], Vec<[f64; 3]>) {
    let start = setup.obstacles[0].motion();
    let mut lbm = Lbm::<L, Q>::new(setup).unwrap();
    for step in 0..150 {
        let position = start.position + velocity * (f64::from(step) + 0.5);
        let lent: &mut [Motion<L::Dim>] = Accepts::<ObstacleMotion<L::Dim>>::view_mut(&mut lbm);
        lent[0] = Motion::new(position, velocity, start.spin);
        lbm.advance(1.0, 1).unwrap();
    }
    let velocities = cells.iter().map(|cell| lbm.flow(*cell).map_or([0.0; 3], |f| f.velocity.padded()));
    (lbm.force_on(0).padded(), granular_core::Spin::components(lbm.torque_on(0)), velocities.collect())
}

fn assert_near(what: &str, found: [f64; 3], expected: [f64; 3]) {
    let scale = expected.iter().fold(1e-3_f64, |most, c| most.max(c.abs()));
    for axis in 0..3 {
        assert!(
            (found[axis] - expected[axis]).abs() < 1e-11 * scale,
            "{what}: {found:?} where {expected:?} is right"
        );
    }
}

/// The part of a disk above y = 0 and its mirror image.
struct Lens {
    disk: Ball<D2>,
    /// Where the plane of symmetry lies.
    level: f64,
}

impl SolidShape<D2> for Lens {
    fn contains(&self, point: DVec2) -> bool {
        self.disk.contains(DVec2::new(point.x, (point.y - self.level).abs()))
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        let reach = DVec2::splat(self.disk.radius);
        let centre = DVec2::new(self.disk.centre.x, self.level);
        (centre - reach, centre + reach)
    }
}

/// A disk with its centre on, above or below a plane of symmetry, at rest and moving along it: forces on the half are half of
/// those on the whole, and the flow is that of the whole.
#[test]
fn half_a_body_at_a_plane_of_symmetry_feels_half_of_the_force() {
    let cells: Vec<_> = (0..24).flat_map(|x| (0..8).map(move |y| [x, y, 0])).collect();
    let above: Vec<_> = cells.iter().map(|[x, y, _]| [*x, y + 8, 0]).collect();
    for (wall, height) in SCHEMES.into_iter().flat_map(|wall| [0.0, -1.25].map(|height| (wall, height))) {
        for velocity in [DVec2::ZERO, DVec2::new(0.03, 0.0)] {
            let disk = Ball::<D2> { centre: DVec2::new(12.3, height), radius: 4.4 };
            let mut half = unit::<D2>([24, 8, 1]);
            half.faces[1] = [Face::FreeSlip, Face::FreeSlip];
            half.acceleration = DVec2::new(2e-5, 0.0);
            let mut whole = unit::<D2>([24, 16, 1]);
            whole.acceleration = half.acceleration;
            half.obstacles.push(Obstacle::new("disk", disk));
            whole.obstacles.push(Obstacle::new("disk", Lens { disk, level: 8.0 }));
            for setup in [&mut half, &mut whole] {
                setup.obstacles[0].wall = wall;
                setup.obstacles[0].velocity = velocity;
            }
            let what = format!("{wall:?}, centre {height} above the plane, velocity {velocity}");
            let (part, _, flow) = loads::<D2Q9, 9>(half, velocity, &cells);
            let (all, _, other) = loads::<D2Q9, 9>(whole, velocity, &above);
            assert!(all[0].abs() > 1e-4, "{what}: {all:?}");
            assert_near(&what, [part[0], 0.0, 0.0], [0.5 * all[0], 0.0, 0.0]);
            for (found, expected) in flow.into_iter().zip(other) {
                assert_near(&what, found, expected);
            }
        }
    }
}

/// A quarter of a sphere between two planes of symmetry, and half of one that turns about the normal of a plane.
#[test]
fn parts_of_a_sphere_feel_their_parts_of_force_and_torque() {
    for wall in SCHEMES {
        let sphere = |y: f64, z: f64| {
            let mut sphere = Obstacle::new("sphere", Ball { centre: DVec3::new(7.3, y, z), radius: 3.3 });
            sphere.wall = wall;
            sphere
        };
        let mut part = unit::<D3>([14, 6, 6]);
        part.acceleration = DVec3::new(2e-5, 0.0, 0.0);
        let mut whole = part.clone();
        whole.cells = [14, 12, 12];
        part.faces[1] = [Face::FreeSlip, Face::FreeSlip];
        part.faces[2] = [Face::FreeSlip, Face::FreeSlip];
        part.obstacles.push(sphere(0.0, 6.0));
        whole.obstacles.push(sphere(6.0, 6.0));
        let (found, ..) = loads::<D3Q19, 19>(part, DVec3::ZERO, &[]);
        let (all, ..) = loads::<D3Q19, 19>(whole, DVec3::ZERO, &[]);
        assert_near(&format!("{wall:?}"), [found[0], 0.0, 0.0], [0.25 * all[0], 0.0, 0.0]);

        let mut half = unit::<D3>([14, 6, 12]);
        half.faces[1] = [Face::FreeSlip, Face::FreeSlip];
        half.obstacles.push(sphere(0.0, 6.1));
        let mut whole = unit::<D3>([14, 12, 12]);
        whole.obstacles.push(sphere(6.0, 6.1));
        for setup in [&mut half, &mut whole] {
            setup.obstacles[0].spin = DVec3::new(0.0, 0.02, 0.0);
        }
        let (_, found, _) = loads::<D3Q19, 19>(half, DVec3::ZERO, &[]);
        let (_, all, _) = loads::<D3Q19, 19>(whole, DVec3::ZERO, &[]);
        assert!(all[1].abs() > 1e-2, "{all:?}");
        assert_near(&format!("{wall:?}"), [0.0, found[1], 0.0], [0.0, 0.5 * all[1], 0.0]);
    }
}

/// A gap of one cell between two blocks, each `q` of a link away, in which a body force drives a flow along.
///
/// In such a row all populations along x stay, and those across turn at the walls: with `b = 1 - 1/q` they are `b` times what
/// left, for half-way walls `-1` times. The balance of both with the odd rate `s`, where `t = 1/s - 1/2`, gives the velocity
/// `a ((2 t + 3/2) (1 + s (q - 1)) + (q - 1) s t)`; `q = 1/2` gives `2 a t`, which is `a h^2 / (8 nu)` at `Lambda = 3/16`.
#[test]
fn walls_beyond_half_of_a_link_are_interpolated_in_a_gap_of_one_cell_too() {
    for (q, wall) in [0.5, 0.7, 0.9].into_iter().flat_map(|q| SCHEMES.map(|wall| (q, wall))) {
        let mut setup = unit::<D2>([4, 5, 1]);
        setup.operator = Operator::TwoRelaxation { magic: 0.1875 };
        setup.acceleration = DVec2::new(1e-6, 0.0);
        for (name, low, high) in [("lower", -1.0, 2.5 - q), ("upper", 2.5 + q, 6.0)] {
            let mut block =
                Obstacle::new(name, Block::<D2> { low: DVec2::new(-9.0, low), high: DVec2::new(9.0, high) });
            block.wall = wall;
            setup.obstacles.push(block);
        }
        let t = 0.1875 / (setup.tau() - 0.5);
        let s = 1.0 / (t + 0.5);
        let share = if wall == WallScheme::HalfWay { 0.5 } else { q };
        let expected = 1e-6 * ((2.0 * t + 1.5) * (1.0 + s * (share - 1.0)) + (share - 1.0) * s * t);
        let mut lbm = Lbm2::new(setup).unwrap();
        lbm.advance(1.0, 2000).unwrap();
        let found = lbm.flow([1, 2, 0]).unwrap().velocity.x;
        assert!((found / expected - 1.0).abs() < 1e-9, "{wall:?} at {q}: {found:e}, {expected:e} is right");
    }
}
