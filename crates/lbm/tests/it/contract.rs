//! The contract of every solver.

use granular_core::contract_tests;
use granular_core::glam::{DVec2, DVec3};
use granular_lbm::*;

fn cavity() -> Lbm2 {
    let mut setup = Setup::new([37, 70, 1], 1e-3, 1e-6, 0.56);
    setup.faces[0] = [Face::REST, Face::REST];
    setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(0.005, 0.0))];
    setup.smagorinsky = Some(0.1);
    Lbm2::new(setup).unwrap()
}

fn spheres() -> Lbm3 {
    let mut setup = Setup::new([22, 14, 13], 1e-3, 1e-6, 0.7);
    setup.faces[0] = [
        Face::Velocity(Profile::uniform(DVec3::new(0.0008, 0.0, 0.0)), OpenScheme::Regularised),
        Face::Pressure(0.0, OpenScheme::ZouHe),
    ];
    setup.faces[1] = [Face::FreeSlip, Face::REST];
    setup.acceleration = DVec3::new(0.0, -1e-5, 0.0);
    setup
        .obstacles
        .push(Obstacle::new("sphere", Ball { centre: DVec3::new(0.009, 0.006, 0.0125), radius: 0.0031 }));
    setup.obstacles[0].reference = Some(Reference { speed: 0.0008, length: 0.0062 });
    setup.gauges.push(Gauge { name: "behind".into(), place: DVec3::new(0.0131, 0.006, 0.0125) });
    Lbm3::new(setup).unwrap()
}

fn disk_in_stream() -> Lbm<D2Q9, 9, f32> {
    let mut setup = Setup::new([60, 41, 1], 1e-3, 1e-6, 0.6);
    setup.operator = Operator::TwoRelaxation { magic: 0.25 };
    setup.acceleration = DVec2::new(1e-4, 0.0);
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::new(0.0591, 0.02), radius: 0.0052 }));
    Lbm::new(setup).unwrap()
}

fn open_on_all_sides() -> Lbm3 {
    let mut setup = Setup::new([12, 11, 9], 1e-3, 1e-6, 0.6);
    let stream = Profile::new(|p: DVec3| DVec3::new(1e-3, 2e-3 * (300.0 * p.x).sin(), -1e-3));
    let scheme = [OpenScheme::ZouHe, OpenScheme::Regularised];
    for axis in 0..3 {
        setup.faces[axis] =
            [Face::Velocity(stream.clone(), scheme[axis % 2]), Face::Velocity(stream.clone(), scheme[1])];
    }
    setup.faces[0][1] = Face::PressureAlong(0.01, stream, OpenScheme::ZouHe);
    setup.acceleration = DVec3::new(0.0, -1e-5, 0.0);
    Lbm3::new(setup).unwrap()
}

fn absorbing_disk() -> Lbm2 {
    let mut setup = Setup::new([40, 31, 1], 1e-3, 1e-6, 0.6);
    let stream = Profile::uniform(DVec2::new(2e-3, 0.0));
    setup.faces[0] = [Face::Velocity(stream, OpenScheme::ZouHe), Face::absorbing(0.01)];
    setup.faces[1] = [Face::FreeSlip, Face::absorbing(0.0)];
    setup.acceleration = DVec2::new(0.0, -1e-5);
    // It covers cells within the face, of which some at the face are fluid.
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::new(0.031, 0.02), radius: 0.0082 }));
    Lbm2::new(setup).unwrap()
}

/// A force that varies in space and time, a lid with a profile, walls that slip and a disk.
fn stirred() -> Lbm2 {
    let mut setup = Setup::new([33, 70, 1], 1e-3, 1e-6, 0.6);
    setup.faces[0] =
        [Face::slipping(0.6e-3), Face::NavierSlip { length: 2e-3, velocity: DVec2::new(0.0, 2e-3) }];
    let lid = Profile::new(|p: DVec2| DVec2::new(8.0 * p.x * (0.033 - p.x), 0.0));
    setup.faces[1] = [Face::REST, Face::WallProfile(lid)];
    setup.smagorinsky = Some(0.1);
    setup.body_force = Some(BodyForce::in_space_times(
        |p: DVec2| 1e-4 * DVec2::new((300.0 * p.y).sin(), (200.0 * p.x).cos()),
        |time| (30.0 * time).cos(),
    ));
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::new(0.015, 0.03), radius: 0.0052 }));
    Lbm2::new(setup).unwrap()
}

/// Any function of place and time, beside open faces in space.
fn waves() -> Lbm3 {
    let mut setup = Setup::new([14, 11, 9], 1e-3, 1e-6, 0.7);
    setup.faces[0] = [
        Face::Velocity(Profile::uniform(DVec3::new(0.0008, 0.0, 0.0)), OpenScheme::Regularised),
        Face::absorbing(0.0),
    ];
    setup.faces[1] = [Face::FreeSlip, Face::REST];
    let wave = |p: DVec3, time: f64| 1e-3 * DVec3::new((500.0 * p.y - 20.0 * time).sin(), 0.0, 0.1);
    setup.body_force = Some(BodyForce::everywhere(wave));
    Lbm3::new(setup).unwrap()
}

/// An annulus whose shaft was set turning by name, in a fluid that is shaken.
fn shaken_annulus() -> Lbm<D2Q9, 9, f32> {
    let mut setup = Setup::new([50, 41, 1], 1e-3, 1e-6, 0.6);
    let centre = DVec2::new(0.0251, 0.0203);
    setup.obstacles.push(Obstacle::new("shaft", Ball { centre, radius: 0.0072 }));
    setup.obstacles.push(Obstacle::new("tank", Hole(Ball { centre, radius: 0.0188 })));
    setup.body_force = Some(BodyForce::in_time(|time| 1e-3 * DVec2::new((40.0 * time).sin(), 0.0)));
    let mut lbm = Lbm::new(setup).unwrap();
    let mut motion = lbm.obstacle_motion("shaft").unwrap();
    motion.spin = 0.2;
    lbm.set_obstacle_motion("shaft", motion).unwrap();
    lbm
}

/// A lid whose velocity was set.
fn lid_set_by_name() -> Lbm2 {
    let mut setup = Setup::new([30, 31, 1], 1e-3, 1e-6, 0.6);
    setup.faces[1] = [Face::REST, Face::REST];
    let mut lbm = Lbm2::new(setup).unwrap();
    lbm.set_face_velocity("top", DVec2::new(3e-3, 0.0)).unwrap();
    lbm
}

fn step(tau: f64) -> f64 {
    Setup::<granular_core::D2>::new([2, 2, 1], 1e-3, 1e-6, tau).time_step
}

contract_tests!(cavity_with_closure, cavity, step(0.56));
contract_tests!(sphere_between_open_faces, spheres, step(0.7));
contract_tests!(disk_through_a_periodic_face_in_single_precision, disk_in_stream, step(0.6));
contract_tests!(open_on_all_sides_in_space, open_on_all_sides, step(0.6));
contract_tests!(disk_beside_absorbing_faces, absorbing_disk, step(0.6));
contract_tests!(stirred_between_walls_that_slip, stirred, step(0.6));
contract_tests!(waves_of_force_between_open_faces, waves, step(0.7));
contract_tests!(shaken_annulus_in_single_precision, shaken_annulus, step(0.6));
contract_tests!(lid_set_by_name_keeps_its_velocity, lid_set_by_name, step(0.6));
