//! What does not fit is refused, with a reason.

use granular_core::glam::DVec2;
use granular_core::{D2, Simulation};
use granular_coupling::{Body, CarriedObstacles, Path, PrescribedMotion};
use granular_dem::{Dem, Grain, Materials};
use granular_lbm::{Ball, Lbm2, Obstacle, Setup};

const CENTRE: DVec2 = DVec2::new(0.01, 0.01);

fn water() -> (Simulation, f64) {
    let mut setup = Setup::new([20, 20, 1], 1e-3, 1e-6, 0.8);
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: CENTRE, radius: 3e-3 }));
    let dt = setup.time_step;
    (Simulation::named("water", Box::new(Lbm2::new(setup).unwrap())), dt)
}

fn moving(velocity: DVec2, count: usize) -> PrescribedMotion<D2> {
    PrescribedMotion::new(vec![Body::new(CENTRE, 3e-3, Path::Steady(velocity)); count]).unwrap()
}

#[test]
fn a_grain_without_an_obstacle_is_refused() {
    let (mut simulation, _) = water();
    let water = simulation.find::<Lbm2>("water").unwrap();
    let bodies = simulation.add("bodies", moving(DVec2::X, 2)).unwrap();
    let error = simulation.couple(water, bodies, CarriedObstacles::all()).unwrap_err().to_string();
    assert_eq!(error, "carried obstacles: grain 1 carries obstacle 1 of a fluid that has 1");
    let law = CarriedObstacles::numbered(vec![0]);
    let error = simulation.couple(water, bodies, law).unwrap_err().to_string();
    assert_eq!(error, "carried obstacles: 1 numbers of obstacles for 2 grains");
}

#[test]
fn a_motion_faster_than_sound_stops_the_run_by_name() {
    let (mut simulation, dt) = water();
    let water = simulation.find::<Lbm2>("water").unwrap();
    let bodies = simulation.add("bodies", moving(DVec2::new(0.6e-3 / dt, 0.0), 1)).unwrap();
    simulation.couple(water, bodies, CarriedObstacles::all()).unwrap();
    simulation.begin_segment(dt).unwrap();
    let error = simulation.advance(1).unwrap_err().to_string();
    assert!(error.contains("`disk`") && error.contains("0.6000"), "{error}");
}

/// The law serves grains of the discrete element method too: here one flies, and the obstacle with it.
#[test]
fn a_grain_of_another_solver_carries_an_obstacle() {
    let (mut simulation, dt) = water();
    let water = simulation.find::<Lbm2>("water").unwrap();
    let velocity = DVec2::new(0.05e-3 / dt, 0.0);
    let mut materials = Materials::new();
    // Soft enough for a tenth of the fluid's step to be stable.
    let soft = granular_dem::Material { normal_stiffness: 160.0, ..Default::default() };
    let glass = materials.add(soft).unwrap();
    let setup = granular_dem::Setup::<D2> {
        materials,
        grains: vec![Grain::at(CENTRE, 3e-3, glass).moving(velocity)],
        walls: Vec::new(),
        gravity: DVec2::ZERO,
        options: granular_dem::Options::default(),
    };
    let grains = simulation.add("grains", Dem::<D2>::new(setup).unwrap()).unwrap();
    simulation.couple(water, grains, CarriedObstacles::all()).unwrap();
    simulation.choose_step(grains, 0.1 * dt);
    simulation.begin_segment(dt).unwrap();
    simulation.advance(21).unwrap();
    assert_eq!(simulation.get(grains).steps(), 210);
    let place = simulation.get(water).setup().obstacles[0].motion().position;
    // In the middle of the last step.
    assert!((place - (CENTRE + velocity * (20.5 * dt))).length() < 1e-15, "{place}");
    assert!(simulation.get(water).force_on(0).x < 0.0);
}
