//! The same bits for any number of threads, any split, and after a restart, with obstacles that move.

use crate::tank::{Balls, Tank, unit_fluid};
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Section, Simulation, contract_tests};
use granular_coupling::{Body, CarriedObstacles, HeldLoad, Path, PrescribedMotion, ResolvedOptions};
use granular_lbm::{Ball, D2Q9, D3Q19, Face, Lbm2, Lbm3, Obstacle, Setup};

fn bodies() -> PrescribedMotion<granular_core::D2> {
    let orbit = Path::Orbit { centre: DVec2::new(0.02, 0.03), rate: 0.4 };
    let oscillation = Path::Oscillation { amplitude: DVec2::new(2e-3, 3e-3), frequency: 0.7, phase: 0.2 };
    let mut turning = Body::new(DVec2::new(0.01, 0.01), 4e-3, oscillation);
    turning.spin = 0.2;
    let falling = Body::new(DVec2::new(0.03, 0.05), 2e-3, Path::Steady(DVec2::new(0.0, -1e-3)));
    PrescribedMotion::new(vec![Body::new(DVec2::new(0.03, 0.03), 3e-3, orbit), turning, falling]).unwrap()
}

contract_tests!(bodies_on_paths, bodies, 1e-3);

/// Two disks: one on an orbit that crosses a periodic face, one that dips towards a wall.
fn disks() -> Simulation {
    let mut setup = Setup::new([48, 40, 1], 1e-3, 1e-6, 0.9);
    setup.faces[1] = [Face::REST, Face::REST];
    let dt = setup.time_step;
    let (first, second) = (DVec2::new(0.044, 0.024), DVec2::new(0.018, 0.008));
    setup.obstacles.push(Obstacle::new("first", Ball { centre: first, radius: 4.2e-3 }));
    setup.obstacles.push(Obstacle::new("second", Ball { centre: second, radius: 4.7e-3 }));
    let orbit = Path::Orbit { centre: DVec2::new(0.044, 0.019), rate: 0.02 / dt };
    let dip = Path::Oscillation { amplitude: DVec2::new(1e-3, 2.5e-3), frequency: 0.004 / dt, phase: 0.3 };
    let bodies = vec![Body::new(first, 4.2e-3, orbit), Body::new(second, 4.7e-3, dip)];
    let mut simulation = Simulation::named("fluid", Box::new(Lbm2::new(setup).unwrap()));
    let fluid = simulation.find::<Lbm2>("fluid").unwrap();
    let bodies = simulation.add("bodies", PrescribedMotion::new(bodies).unwrap()).unwrap();
    simulation.couple(fluid, bodies, CarriedObstacles::all()).unwrap();
    simulation.begin_segment(dt).unwrap();
    simulation
}

fn sphere() -> Simulation {
    let mut setup = Setup::new([20, 18, 16], 1e-3, 1e-6, 0.8);
    let dt = setup.time_step;
    let place = DVec3::new(0.016, 0.009, 0.008);
    setup.obstacles.push(Obstacle::new("sphere", Ball { centre: place, radius: 3.4e-3 }));
    let path =
        Path::Orbit { centre: DVec3::new(0.01, 0.009, 0.006), rate: DVec3::new(0.0, 0.01, 0.003) / dt };
    let bodies = PrescribedMotion::new(vec![Body::new(place, 3.4e-3, path)]).unwrap();
    let mut simulation = Simulation::named("fluid", Box::new(Lbm3::new(setup).unwrap()));
    let fluid = simulation.find::<Lbm3>("fluid").unwrap();
    let bodies = simulation.add("bodies", bodies).unwrap();
    simulation.couple(fluid, bodies, CarriedObstacles::all()).unwrap();
    simulation.begin_segment(dt).unwrap();
    simulation
}

/// Free disks that fall to a floor, meet, and cross a periodic face.
fn free_disks() -> Simulation {
    let gravity = DVec2::new(0.0, -2e-4);
    let mut setup = unit_fluid::<D2>([48, 40, 1], 0.7);
    setup.faces[1] = [Face::REST, Face::REST];
    setup.acceleration = gravity;
    let balls = vec![
        (DVec2::new(12.2, 6.0), DVec2::ZERO, 4.2),
        (DVec2::new(14.0, 16.0), DVec2::new(-0.01, -0.03), 3.7),
        (DVec2::new(46.5, 20.0), DVec2::new(0.03, 0.0), 5.1),
    ];
    let balls = Balls { gravity, friction: 0.5, floor: Some(0.0), ..Balls::<D2>::of(1.4, balls) };
    let options = ResolvedOptions { held: HeldLoad::TwoSteps, radius_factor: 0.9, ..Default::default() };
    Tank::<D2Q9, 9>::new(setup, |_| DVec2::ZERO, &balls, options).simulation
}

fn free_spheres() -> Simulation {
    let balls = vec![
        (DVec3::new(1.0, 9.0, 8.0), DVec3::new(0.02, 0.0, 0.03), 4.1),
        (DVec3::new(9.2, 9.5, 8.0), DVec3::new(-0.03, 0.01, 0.0), 3.8),
    ];
    let balls = Balls { friction: 0.3, ..Balls::<D3>::of(1.2, balls) };
    let fluid = unit_fluid([20, 18, 16], 0.8);
    Tank::<D3Q19, 19>::new(fluid, |_| DVec3::ZERO, &balls, ResolvedOptions::default()).simulation
}

fn bytes(simulation: &Simulation) -> Vec<Vec<u8>> {
    let of = |section: Section| section.entries().flat_map(|(_, bytes)| bytes.to_vec()).collect();
    simulation.save().into_iter().map(of).collect()
}

fn assert_same_bits(build: fn() -> Simulation) {
    let in_pool = |threads: usize, work: &(dyn Fn() -> Vec<Vec<u8>> + Sync)| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
    };
    let whole = in_pool(1, &|| {
        let mut simulation = build();
        simulation.advance(151).unwrap();
        bytes(&simulation)
    });
    let split = in_pool(3, &|| {
        let mut simulation = build();
        (0..151).for_each(|_| simulation.advance(1).unwrap());
        bytes(&simulation)
    });
    assert!(whole == split, "threads or splits are felt");
    for halt in [37, 80] {
        let restarted = in_pool(2, &|| {
            let mut first = build();
            first.advance(halt).unwrap();
            let mut second = build();
            second.restore(&first.save()).unwrap();
            assert!(bytes(&second) == bytes(&first), "a restart changes the state");
            second.advance(151 - halt).unwrap();
            bytes(&second)
        });
        assert!(whole == restarted, "a restart after {halt} steps is felt");
    }
}

#[test]
fn same_bits_with_moving_disks() {
    assert_same_bits(disks);
}

#[test]
fn same_bits_with_a_moving_sphere() {
    assert_same_bits(sphere);
}

#[test]
fn same_bits_with_free_disks() {
    assert_same_bits(free_disks);
}

#[test]
fn same_bits_with_free_spheres() {
    assert_same_bits(free_spheres);
}
