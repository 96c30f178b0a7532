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

fn step(tau: f64) -> f64 {
    Setup::<granular_core::D2>::new([2, 2, 1], 1e-3, 1e-6, tau).time_step
}

contract_tests!(cavity_with_closure, cavity, step(0.56));
contract_tests!(sphere_between_open_faces, spheres, step(0.7));
contract_tests!(disk_through_a_periodic_face_in_single_precision, disk_in_stream, step(0.6));
contract_tests!(open_on_all_sides_in_space, open_on_all_sides, step(0.6));
contract_tests!(disk_beside_absorbing_faces, absorbing_disk, step(0.6));
