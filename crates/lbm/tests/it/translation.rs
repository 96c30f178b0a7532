//! Obstacles shifted by whole cells across periodic faces: the same bits. All numbers are such that shifts are exact.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{Accepts, D2, D3, Dim, Linear, Motion, ObstacleMotion, Solver, Spin, Vector};
use granular_lbm::*;
use std::sync::Arc;

const SCHEMES: [WallScheme; 3] = [WallScheme::HalfWay, WallScheme::Bouzidi, WallScheme::Yu];
const STEPS: usize = 120;

/// Velocity and spin.
type Going<D> = (<D as Dim>::Vec, <D as Dim>::Spin);

/// A flow in units of cells and steps.
fn unit<D: Dim>(cells: [usize; 3]) -> Setup<D> {
    let mut setup = Setup::new(cells, 1.0, 0.1, 0.8);
    setup.time_step = 1.0;
    setup.density = 1.0;
    setup
}

/// Bits of all cells, in the order of the scene that is not shifted, and of forces and torques.
fn run<L: Lattice<Q>, const Q: usize>(
    mut setup: Setup<L::Dim>,
    shift: [usize; 3],
    velocities: &[Going<L::Dim>],
) -> (Vec<[u64; 4]>, Vec<f64>) {
    let mut away = <L::Dim as Dim>::Vec::ZERO;
    (0..L::Dim::N).for_each(|axis| away += Vector::along(axis, shift[axis] as f64));
    for obstacle in &mut setup.obstacles {
        obstacle.displacement = away;
    }
    let cells = setup.cells;
    let start: Vec<Motion<L::Dim>> = setup.obstacles.iter().map(Obstacle::motion).collect();
    let mut lbm = Lbm::<L, Q>::new(setup).unwrap();
    for step in 0..STEPS {
        for (k, (velocity, spin)) in velocities.iter().enumerate() {
            let position = start[k].position + *velocity * (step as f64 + 0.5);
            let lent: &mut [Motion<L::Dim>] = Accepts::<ObstacleMotion<L::Dim>>::view_mut(&mut lbm);
            lent[k] = Motion::new(position, *velocity, *spin);
        }
        lbm.advance(1.0, 1).unwrap();
    }
    let mut bits = Vec::new();
    for (z, y, x) in
        (0..cells[2]).flat_map(|z| (0..cells[1]).flat_map(move |y| (0..cells[0]).map(move |x| (z, y, x))))
    {
        let cell = [x, y, z];
        let cell = std::array::from_fn(|axis| (cell[axis] + shift[axis]) % cells[axis]);
        bits.push(lbm.flow(cell).map_or([1; 4], |flow| {
            let [u, v, w] = flow.velocity.padded();
            [flow.pressure, u, v, w].map(f64::to_bits)
        }));
    }
    let loads = (0..lbm.setup().obstacles.len()).flat_map(|k| {
        let torque = Spin::components(lbm.torque_on(k));
        lbm.force_on(k).padded().into_iter().chain(torque).collect::<Vec<_>>()
    });
    (bits, loads.collect())
}

fn assert_same<L: Lattice<Q>, const Q: usize>(
    what: &str,
    setup: &Setup<L::Dim>,
    shifts: &[[usize; 3]],
    velocities: &[Going<L::Dim>],
) {
    for scheme in SCHEMES {
        let mut setup = setup.clone();
        setup.obstacles.iter_mut().for_each(|obstacle| obstacle.wall = scheme);
        let (bits, loads) = run::<L, Q>(setup.clone(), [0; 3], velocities);
        let scale = loads.iter().fold(0.0_f64, |most, load| most.max(load.abs()));
        assert!(scale > 1e-6, "{what}: nothing moves");
        for &shift in shifts {
            let (other, others) = run::<L, Q>(setup.clone(), shift, velocities);
            let differ = bits.iter().zip(&other).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{what}, {scheme:?}, shifted by {shift:?}: cells that differ");
            // Links are summed in the order of cells.
            let apart = loads.iter().zip(&others).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-13 * scale.max(1.0), "{what}, {scheme:?}, {shift:?}: loads are {apart} apart");
        }
    }
}

fn triangle() -> Polygon {
    Polygon { corners: vec![DVec2::new(13.25, 9.0), DVec2::new(17.5, 10.75), DVec2::new(14.0, 13.5)] }
}

fn plane() -> Setup<D2> {
    let mut setup = unit([24, 16, 1]);
    setup.acceleration = DVec2::new(2e-5, 1e-5);
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::new(6.125, 6.0), radius: 4.375 }));
    setup.obstacles.push(Obstacle::new("triangle", triangle()));
    setup
}

const SHIFTS: [[usize; 3]; 5] = [[6, 0, 0], [17, 0, 0], [0, 10, 0], [18, 9, 0], [13, 4, 0]];
const ALONG: [[usize; 3]; 4] = [[6, 0, 0], [11, 0, 0], [17, 0, 0], [18, 0, 0]];

#[test]
fn a_shift_in_the_plane_changes_no_bit() {
    assert_same::<D2Q9, 9>("at rest", &plane(), &SHIFTS, &[]);
}

#[test]
fn a_shift_in_the_plane_changes_no_bit_of_bodies_that_move() {
    let moving = [(DVec2::new(0.03125, -0.015625), 0.0), (DVec2::new(-0.0078125, 0.015625), 0.0)];
    assert_same::<D2Q9, 9>("moving", &plane(), &SHIFTS, &moving);
    let turning = [(DVec2::new(0.03125, 0.0), 0.00390625), (DVec2::ZERO, 0.0)];
    assert_same::<D2Q9, 9>("turning", &plane(), &SHIFTS, &turning);
}

#[test]
fn a_shift_along_walls_and_free_slip_changes_no_bit() {
    let lid = DVec2::new(0.03125, 0.0);
    for faces in
        [[Face::FreeSlip, Face::FreeSlip], [Face::FreeSlip, Face::Wall(lid)], [Face::Wall(lid), Face::REST]]
    {
        let mut setup = plane();
        let what = format!("{faces:?}");
        setup.faces[1] = faces;
        // One obstacle is cut by the lower face, the other one by the upper one.
        setup.obstacles[0].shape = Arc::new(Ball { centre: DVec2::new(6.125, 0.75), radius: 4.375 });
        setup.obstacles[1].shape = Arc::new(Ball { centre: DVec2::new(15.5, 17.0), radius: 4.0 });
        assert_same::<D2Q9, 9>(&what, &setup, &ALONG, &[]);
        let moving = [(DVec2::new(0.03125, 0.015625), 0.0), (DVec2::new(-0.015625, -0.0078125), 0.0)];
        assert_same::<D2Q9, 9>(&what, &setup, &ALONG, &moving);
    }
}

fn space() -> Setup<D3> {
    let mut setup = unit([12, 11, 10]);
    setup.acceleration = DVec3::new(2e-5, 1e-5, -1.5e-5);
    let centre = DVec3::new(5.125, 5.0, 4.75);
    setup.obstacles.push(Obstacle::new("sphere", Ball { centre, radius: 3.375 }));
    let (low, high) = (DVec3::new(8.75, 8.25, 7.0), DVec3::new(10.75, 10.625, 9.5));
    setup.obstacles.push(Obstacle::new("block", Block { low, high }));
    setup
}

#[test]
fn a_shift_in_space_changes_no_bit() {
    let shifts = [[7, 0, 0], [0, 6, 0], [0, 0, 5], [6, 7, 6]];
    assert_same::<D3Q19, 19>("at rest", &space(), &shifts, &[]);
    let velocity = DVec3::new(0.03125, -0.015625, 0.0078125);
    let moving = [(velocity, DVec3::ZERO), (-velocity * 0.5, DVec3::ZERO)];
    assert_same::<D3Q19, 19>("moving", &space(), &shifts, &moving);
    let mut setup = space();
    setup.faces[2] = [Face::FreeSlip, Face::FreeSlip];
    setup.obstacles[0].shape = Arc::new(Ball { centre: DVec3::new(5.125, 5.0, 0.5), radius: 3.375 });
    let along = [[7, 0, 0], [0, 6, 0], [6, 7, 0]];
    assert_same::<D3Q19, 19>("beside free slip", &setup, &along, &[]);
    assert_same::<D3Q19, 19>("moving beside free slip", &setup, &along, &moving);
}

/// Mean velocity along the ring half-way through an annulus, its inner cylinder turning, with a number of layers.
fn annulus(layers: usize, ends: Face<D3>, scheme: WallScheme) -> Vec<[f64; 3]> {
    let mut setup = unit::<D3>([26, 26, layers]);
    setup.faces[2] = [ends.clone(), ends];
    let shaft = Extruded { shape: Ball { centre: DVec2::splat(13.0), radius: 4.25 }, from: -1e6, to: 1e6 };
    let mut shaft = Obstacle::new("shaft", shaft);
    (shaft.wall, shaft.spin) = (scheme, DVec3::new(0.0, 0.0, 0.01));
    setup.obstacles.push(shaft);
    let mut lbm = Lbm3::new(setup).unwrap();
    lbm.advance(1.0, 300).unwrap();
    (0..26 * 26)
        .map(|i| lbm.flow([i % 26, i / 26, 0]).map_or([0.0; 3], |flow| flow.velocity.to_array()))
        .collect()
}

#[test]
fn flows_that_do_not_depend_on_z_do_not_depend_on_the_number_of_layers() {
    for scheme in SCHEMES {
        let many = annulus(8, Face::Periodic, scheme);
        let most = many.iter().map(|v| v[0].abs()).fold(0.0, f64::max);
        assert!(most > 0.02, "{most}");
        for (layers, ends) in
            [(2, Face::Periodic), (3, Face::Periodic), (2, Face::FreeSlip), (5, Face::FreeSlip)]
        {
            let what = format!("{scheme:?}, {layers} layers between {ends:?}");
            let apart = annulus(layers, ends, scheme)
                .iter()
                .zip(&many)
                .flat_map(|(a, b)| (0..3).map(move |axis| (a[axis] - b[axis]).abs()))
                .fold(0.0, f64::max);
            assert!(apart < 1e-15, "{what}: {apart}");
        }
    }
}
