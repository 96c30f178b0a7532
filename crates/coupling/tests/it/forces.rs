//! Forces on bodies that move, against other frames and closed forms.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{Dim, Simulation};
use granular_coupling::{Body, CarriedObstacles, Path, PrescribedMotion};
use granular_lbm::{Ball, Face, Flow, Lattice, Lbm, Obstacle, Setup};
use std::f64::consts::{PI, TAU};

/// Lets one ball of a setup follow a path through a fluid that starts at a velocity; gives the force after each step.
fn forces<L: Lattice<Q>, const Q: usize>(
    mut setup: Setup<L::Dim>,
    body: Body<L::Dim>,
    stream: <L::Dim as Dim>::Vec,
    steps: usize,
) -> Vec<<L::Dim as Dim>::Vec> {
    setup
        .obstacles
        .push(Obstacle::new("ball", Ball { centre: body.motion(0.0).position, radius: body.radius }));
    let dt = setup.time_step;
    let mut fluid = Lbm::<L, Q>::new(setup).unwrap();
    fluid.set_flow(|_| Flow { pressure: 0.0, velocity: stream });
    let mut simulation = Simulation::named("fluid", Box::new(fluid));
    let fluid = simulation.find::<Lbm<L, Q>>("fluid").unwrap();
    let bodies = simulation.add("bodies", PrescribedMotion::new(vec![body]).unwrap()).unwrap();
    simulation.couple(fluid, bodies, CarriedObstacles::<L::Dim>::all()).unwrap();
    simulation.begin_segment(dt).unwrap();
    let force = |_| {
        simulation.advance(1).unwrap();
        simulation.get(fluid).force_on(0)
    };
    (0..steps).map(force).collect()
}

fn mean2(forces: &[DVec2]) -> DVec2 {
    forces.iter().sum::<DVec2>() / forces.len() as f64
}

#[test]
fn a_disk_carried_by_a_stream_feels_no_drag() {
    let setup = || Setup::new([80, 64, 1], 1e-3, 1e-6, 0.7);
    let velocity = DVec2::new(0.04, 0.013) * setup().lattice_speed();
    let place = DVec2::new(0.0712, 0.0333);
    let at = |path| Body::new(place, 8.3e-3, path);
    let resting = forces::<granular_lbm::D2Q9, 9>(setup(), at(Path::Steady(DVec2::ZERO)), velocity, 1000);
    let carried = forces::<granular_lbm::D2Q9, 9>(setup(), at(Path::Steady(velocity)), velocity, 1000);
    let (drag, rest) = (mean2(&resting[500..]).length(), mean2(&carried[500..]).length());
    let rough = carried[500..].iter().map(|force| force.length()).fold(0.0, f64::max);
    println!(
        "drag at rest {drag:.4e}, mean when carried {:.2e} of it, largest {:.2e}",
        rest / drag,
        rough / drag
    );
    assert!(rest < 0.01 * drag, "{rest} against {drag}");
}

#[test]
fn drag_is_the_same_in_the_frame_of_the_disk() {
    let setup = || Setup::new([90, 60, 1], 1e-3, 1e-6, 0.8);
    let speed = 0.04 * setup().lattice_speed();
    let channel = |wall: f64| {
        let mut setup = setup();
        setup.faces[1] = [0, 1].map(|_| Face::Wall(DVec2::new(wall, 0.0)));
        setup
    };
    let at = |path| Body::new(DVec2::new(0.0305, 0.0302), 6.4e-3, path);
    let moving = Path::Steady(DVec2::new(-speed, 0.0));
    let moved = forces::<granular_lbm::D2Q9, 9>(channel(0.0), at(moving), DVec2::ZERO, 2000);
    let stream = DVec2::new(speed, 0.0);
    let held = forces::<granular_lbm::D2Q9, 9>(channel(speed), at(Path::Steady(DVec2::ZERO)), stream, 2000);
    for window in [500..1000, 1500..2000] {
        let (moved, held) = (mean2(&moved[window.clone()]), mean2(&held[window]));
        println!("drag of the disk that moves {:.6e}, of the one held {:.6e}", moved.x, held.x);
        assert!((moved.x / held.x - 1.0).abs() < 0.01, "{moved} against {held}");
    }
}

/// Drag and added mass of an oscillating sphere in a large vessel \[Stokes1851\].
#[test]
fn an_oscillating_sphere_feels_the_force_of_stokes() {
    let (radius, spacing, viscosity, period) = (6.3e-3, 1e-3, 1e-6, 600.0);
    let setup = Setup::new([56, 56, 56], spacing, viscosity, 0.8);
    let (dt, density) = (setup.time_step, setup.density);
    let frequency = 1.0 / (period * dt);
    let amplitude = DVec3::new(1.2e-3, 0.0, 0.0);
    let path = Path::Oscillation { amplitude, frequency, phase: 0.0 };
    let body = Body::new(DVec3::splat(0.0281), radius, path);
    let steps = 2 * period as usize;
    let found = forces::<granular_lbm::D3Q19, 19>(setup, body, DVec3::ZERO, steps);
    let depth = (2.0 * viscosity / (TAU * frequency)).sqrt();
    let drag = 6.0 * PI * density * viscosity * radius * (1.0 + radius / depth);
    let mass = 3.0 * PI * radius * radius * density * depth * (1.0 + 2.0 * radius / (9.0 * depth));
    // Components in phase with velocity and acceleration over the second period.
    let (mut with_velocity, mut with_acceleration) = (0.0, 0.0);
    for (step, force) in found.iter().enumerate().skip(period as usize) {
        let angle = TAU * (step as f64 + 0.5) / period;
        with_velocity += force.x * angle.cos() * 2.0 / period;
        with_acceleration -= force.x * angle.sin() * 2.0 / period;
    }
    let speed = amplitude.x * TAU * frequency;
    let (drag_found, mass_found) = (-with_velocity / speed, -with_acceleration / (speed * TAU * frequency));
    println!("drag {drag_found:.4e} of {drag:.4e} N s/m, mass {mass_found:.4e} of {mass:.4e} kg");
    assert!((drag_found / drag - 1.0).abs() < 0.05, "{drag_found} against {drag}");
    assert!((mass_found / mass - 1.0).abs() < 0.05, "{mass_found} against {mass}");
}

/// An obstacle on a path acts with the place and velocity of the middle of the step, to second order.
#[test]
fn an_obstacle_moves_as_its_body_does_in_the_middle_of_the_step() {
    let largest = |period: f64| {
        let mut setup = Setup::new([20, 20, 1], 1e-3, 1e-6, 0.8);
        let dt = setup.time_step;
        let (place, amplitude) = (DVec2::splat(0.0103), DVec2::new(2e-3, 1e-3));
        let path = Path::Oscillation { amplitude, frequency: 1.0 / (period * dt), phase: 0.4 };
        let body = Body::<granular_core::D2>::new(place, 4e-3, path);
        setup.obstacles.push(Obstacle::new("disk", Ball { centre: place, radius: 4e-3 }));
        let mut simulation = Simulation::named("fluid", Box::new(granular_lbm::Lbm2::new(setup).unwrap()));
        let fluid = simulation.find::<granular_lbm::Lbm2>("fluid").unwrap();
        let bodies = simulation.add("bodies", PrescribedMotion::new(vec![body]).unwrap()).unwrap();
        simulation.couple(fluid, bodies, CarriedObstacles::all()).unwrap();
        simulation.begin_segment(dt).unwrap();
        let off = |step: u32| {
            simulation.advance(1).unwrap();
            let found = simulation.get(fluid).setup().obstacles[0].motion();
            let expected = body.motion((f64::from(step) + 0.5) * dt);
            // The first steps have no steps before them.
            let counts = if step < 3 { 0.0 } else { 1.0 };
            let velocity = (found.velocity - expected.velocity).length() / body.fastest();
            counts * velocity.max((found.position - expected.position).length() / amplitude.length())
        };
        (0..period as u32).map(off).fold(0.0, f64::max)
    };
    let [coarse, fine] = [100.0, 200.0].map(largest);
    // The velocity of the middle is off by up to 7/8 of its second derivative times the square of the step.
    let allowed = 0.9 * (TAU / 100.0).powi(2);
    println!("off by {coarse:.2e} and {fine:.2e}, {allowed:.2e} is allowed");
    assert!(coarse < allowed && coarse > 3.5 * fine, "{coarse} {fine}");
}
