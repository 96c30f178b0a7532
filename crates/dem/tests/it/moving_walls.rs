//! Walls that move: closed forms, the energy they put in, and the same bits.

use crate::sample::{Lattice, down};
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Linear, Solver, Vector, contract_tests};
use granular_dem::{Dem, Dem2, Dem3, Grain, Material, Materials, Options, Servo, Setup, Wall, WallMotion};
use std::f64::consts::TAU;

fn with_ledger() -> Options {
    Options { ledger: true, ..Options::default() }
}

fn one<D: Dim>(
    grain: impl Fn(granular_dem::MaterialId) -> Grain<D>,
    wall: &dyn Fn(granular_dem::MaterialId) -> Wall<D>,
    material: Material,
    gravity: f64,
) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let (grains, walls) = (vec![grain(glass)], vec![wall(glass)]);
    Dem::new(Setup { materials, grains, walls, gravity: down::<D>(gravity), options: with_ledger() }).unwrap()
}

#[test]
fn a_wall_that_hits_a_grain_gives_it_its_speed_and_the_restitution() {
    let velocity = DVec2::new(0.0, 2.0);
    let mut dem = one::<D2>(
        |glass| Grain::at(DVec2::new(0.0, 1.2e-3), 1e-3, glass),
        &|glass| {
            Wall::plane("piston", DVec2::ZERO, DVec2::Y, glass)
                .unwrap()
                .moving(WallMotion::Steady { velocity })
        },
        Material { restitution: 0.6, friction: 0.0, ..Material::default() },
        0.0,
    );
    let dt = dem.recommended_step() / 20.0;
    dem.advance(dt, (0.4e-3 / dt) as u64).unwrap();
    let speed = dem.grain(0).velocity.y;
    assert!((speed / (1.6 * 2.0) - 1.0).abs() < 1e-4, "{speed}");
    let kinetic = dem.energies().translational();
    // Work of the wall is momentum times its speed; what is not kinetic was lost in the dashpot.
    let mass = 2.0 * kinetic / (speed * speed);
    assert!((dem.wall_work() / (mass * speed * 2.0) - 1.0).abs() < 1e-3, "{}", dem.wall_work());
    assert!(dem.energy_residual().unwrap().abs() < 1e-4 * dem.wall_work());
}

#[test]
fn a_belt_carries_a_ball_until_it_rolls() {
    // From rest the ball slides, v = mu g t, until its rim has the speed of the belt: V / 3 of a disk, 2/7 V of
    // a sphere.
    fn belt<D: Dim>() -> (f64, f64, f64) {
        let mu = 0.2;
        let mut dem = one::<D>(
            |glass| Grain::at(D::Vec::along(D::UP, 1e-3), 1e-3, glass),
            &|glass| {
                let motion = WallMotion::Steady { velocity: D::Vec::along(0, 0.05) };
                Wall::plane("belt", D::Vec::ZERO, D::Vec::along(D::UP, 1.0), glass).unwrap().moving(motion)
            },
            Material { friction: mu, restitution: 0.2, ..Material::default() },
            9.81,
        );
        // Springs load within a step where sliding begins at once: the books need a finer one.
        let dt = 0.25 * dem.recommended_step();
        let early = 0.25 * 0.05 / (mu * 9.81) / 3.5;
        dem.advance(dt, (early / dt) as u64).unwrap();
        let sliding = dem.grain(0).velocity.component(0) / (mu * 9.81 * dem.time());
        dem.advance(dt, (8.0 * early / dt) as u64).unwrap();
        let rolling = dem.grain(0).velocity.component(0) / 0.05;
        (sliding, rolling, dem.energy_residual().unwrap().abs() / dem.wall_work())
    }
    let (sliding, rolling, residual) = belt::<D2>();
    assert!((sliding - 1.0).abs() < 0.01 && (rolling - 1.0 / 3.0).abs() < 2e-3, "{sliding} {rolling}");
    assert!(residual < 1e-3, "{residual:e}");
    let (sliding, rolling, residual) = belt::<D3>();
    assert!((sliding - 1.0).abs() < 0.01 && (rolling - 2.0 / 7.0).abs() < 2e-3, "{sliding} {rolling}");
    assert!(residual < 1e-3, "{residual:e}");
}

#[test]
fn a_ball_on_a_turntable_that_holds_it_goes_round() {
    // A sphere pressed to a turning floor by its weight only would roll; one at rest in a turning cup does not.
    // Three planes make a cup whose corner is on the axis: the sphere ends up turning with it.
    let spin = DVec3::new(0.0, 0.0, 5.0);
    let mut materials = Materials::new();
    let glass = materials.add(Material { restitution: 0.3, ..Material::default() }).unwrap();
    let walls = (0..3)
        .map(|k| {
            let angle = f64::from(k) * TAU / 3.0;
            let normal = DVec3::new(angle.cos(), angle.sin(), 1.0);
            let motion = WallMotion::Turning { about: DVec3::ZERO, spin };
            Wall::plane(&format!("side{k}"), DVec3::ZERO, normal, glass).unwrap().moving(motion)
        })
        .collect();
    let grains = vec![Grain::at(DVec3::new(0.0, 0.0, 1.4143e-3), 1e-3, glass)];
    let setup = Setup { materials, grains, walls, gravity: down::<D3>(9.81), options: with_ledger() };
    let mut dem = Dem3::new(setup).unwrap();
    let dt = 0.25 * dem.recommended_step();
    dem.advance(dt, (0.05 / dt) as u64).unwrap();
    let grain = dem.grain(0);
    assert!((grain.spin - spin).length() < 0.01 * spin.length(), "{:?}", grain.spin);
    assert!(grain.position.truncate().length() < 1e-6, "{:?}", grain.position);
    let turnover = dem.losses().total() + dem.wall_work();
    assert!(dem.energy_residual().unwrap().abs() < 1e-3 * turnover, "{:?}", dem.energy_residual());
}

#[test]
fn a_servo_presses_with_its_target() {
    let mut materials = Materials::new();
    let glass = materials.add(Material { restitution: 0.3, ..Material::default() }).unwrap();
    let servo =
        Servo { direction: -DVec2::Y, force: 3.0, pressure: None, mass: 0.05, damping: 30.0, max_speed: 0.1 };
    let lid = Wall::plane("lid", DVec2::new(0.0, 2.2e-3), -DVec2::Y, glass).unwrap();
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap();
    let walls = vec![floor, lid.moving(WallMotion::Servo(servo))];
    let grains = vec![Grain::at(DVec2::new(0.0, 1e-3), 1e-3, glass)];
    let setup = Setup { materials, grains, walls, gravity: down::<D2>(9.81), options: with_ledger() };
    let mut dem = Dem2::new(setup).unwrap();
    let dt = dem.recommended_step();
    let mut fastest = 0.0_f64;
    for _ in 0..100 {
        dem.advance(dt, (5e-4 / dt) as u64).unwrap();
        fastest = fastest.max(dem.grain(0).velocity.length());
    }
    let forces = dem.wall_forces();
    let weight = 2650.0 * D2::ball_volume(1e-3) * 9.81;
    assert!((forces[1].y / 3.0 - 1.0).abs() < 1e-6, "{forces:?}");
    assert!((forces[0].y / -(3.0 + weight) - 1.0).abs() < 1e-6, "{forces:?}");
    assert!(dem.energy_residual().unwrap().abs() < 1e-3 * dem.wall_work(), "{:?}", dem.energy_residual());
    assert!(fastest < 0.5);
}

#[test]
fn a_servo_on_a_spring_swings_at_the_closed_form() {
    // A heavy lid on a light frictionless grain: half the stiffness of one contact, M x'' = F - k x / 2.
    let mut materials = Materials::new();
    let glass = materials.add(Material { restitution: 1.0, friction: 0.0, ..Material::default() }).unwrap();
    let (mass, force) = (10.0, 1.0);
    let servo =
        Servo { direction: -DVec2::Y, force, pressure: None, mass, damping: 0.0, max_speed: f64::INFINITY };
    let lid = Wall::plane("lid", DVec2::new(0.0, 2e-3), -DVec2::Y, glass).unwrap();
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap();
    let walls = vec![floor, lid.moving(WallMotion::Servo(servo))];
    let grains = vec![Grain::at(DVec2::new(0.0, 1e-3), 1e-3, glass)];
    let setup = Setup { materials, grains, walls, gravity: DVec2::ZERO, options: with_ledger() };
    let mut dem = Dem2::new(setup).unwrap();
    let dt = dem.recommended_step();
    let period = TAU * (mass / (0.5 * 1.6e6)).sqrt();
    let steps = (0.5 * period / dt).round() as u64;
    dem.advance(dt, steps).unwrap();
    // At half the period the lid is lowest and presses with twice the force.
    let pressed = dem.wall_forces()[1].y;
    assert!((pressed / (2.0 * force) - 1.0).abs() < 0.01, "{pressed}");
    assert!(dem.energy_residual().unwrap().abs() < 1e-3 * dem.wall_work(), "{:?}", dem.energy_residual());
}

#[test]
fn a_held_wall_waits_and_goes_on_where_it_stopped() {
    let mut dem = one::<D2>(
        |glass| Grain::at(DVec2::new(0.0, 1e-3), 1e-3, glass),
        &|glass| {
            let motion = WallMotion::Steady { velocity: DVec2::new(0.0, 0.01) };
            Wall { held: true, ..Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap().moving(motion) }
        },
        Material { restitution: 0.1, ..Material::default() },
        9.81,
    );
    let dt = dem.recommended_step();
    dem.advance(dt, 500).unwrap();
    assert!((dem.grain(0).position.y - 1e-3).abs() < 1e-6 && dem.wall_work() == 0.0);
    assert!(dem.set_moving("floor", true) && !dem.set_moving("roof", true));
    dem.advance(dt, 1000).unwrap();
    assert!(dem.set_moving("floor", false));
    dem.advance(dt, 20_000).unwrap();
    assert!((dem.grain(0).position.y - (1e-3 + 1000.0 * 0.01 * dt)).abs() < 1e-6, "{:?}", dem.grain(0));
}

/// A box whose lid swings, whose side presses, with a beam that turns in it.
fn shaken<D: Dim>(lattice: Lattice, material: Material, options: Options, slowness: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let mut grains = lattice.grains::<D>(&[glass]);
    let mut walls = lattice.walls::<D>(glass);
    let far = lattice.spacing * lattice.side as f64;
    let middle = (0..D::N).fold(D::Vec::ZERO, |v, axis| v + D::Vec::along(axis, 0.5 * far));
    let beam = D::Vec::along(0, 0.2 * far);
    walls.push(Wall::segment("beam", middle - beam, middle + beam, glass).unwrap());
    let turning = <D::Spin as granular_core::Spin>::about_z(300.0 / slowness);
    let motions = [
        WallMotion::Oscillating {
            amplitude: D::Vec::along(0, 20e-6),
            frequency: 2000.0 / slowness,
            phase: 0.3,
        },
        WallMotion::Servo(Servo {
            direction: D::Vec::along(0, -1.0),
            force: 20.0,
            pressure: None,
            mass: 0.02,
            damping: 5.0,
            max_speed: 1.0,
        }),
        WallMotion::Steady { velocity: D::Vec::along(0, 0.3) },
    ];
    for (wall, motion) in walls.iter_mut().zip(motions) {
        wall.motion = Some(motion);
    }
    walls[2 * D::N].motion = Some(WallMotion::Turning { about: middle, spin: turning });
    let shape = walls[2 * D::N].shape.clone();
    grains.retain(|grain| shape.distance(grain.position).0 > 0.99 * grain.radius);
    Dem::new(Setup { materials, grains, walls, gravity: down::<D>(9.81), options }).unwrap()
}

fn short_lists() -> Options {
    Options { skin: 0.02, ledger: true, ..Options::default() }
}

contract_tests!(
    disks_in_a_shaken_box,
    || shaken::<D2>(Lattice { side: 46, ..Lattice::default() }, Material::default(), short_lists(), 1.0),
    1.5e-6,
    warm_up = 600
);
contract_tests!(
    spheres_in_a_shaken_box,
    || shaken::<D3>(
        Lattice { side: 12, speed: 10.0, ..Lattice::default() },
        Material { friction: 0.0, ..Material::default() },
        Options { ledger: false, ..short_lists() },
        0.1
    ),
    4e-8,
    warm_up = 600
);

#[test]
fn the_energy_that_walls_put_in_is_accounted_for() {
    fn books<D: Dim>(lattice: Lattice, material: Material, time: f64, slowness: f64) -> f64 {
        let mut dem = shaken::<D>(lattice, material, with_ledger(), slowness);
        let dt = 0.5 * dem.recommended_step();
        let (start, mut worst) = (dem.energies().mechanical(), 0.0_f64);
        for _ in 0..10 {
            dem.advance(dt, (0.1 * time / dt) as u64).unwrap();
            let turnover = start + dem.wall_work().abs();
            worst = worst.max(dem.energy_residual().unwrap().abs() / turnover);
        }
        assert!(dem.wall_work().abs() > 0.02 * start, "{} of {start}", dem.wall_work());
        worst
    }
    let lattice = Lattice { side: 24, jitter: 30e-6, radii: (0.4e-3, 0.46e-3), ..Lattice::default() };
    let disks = books::<D2>(lattice, Material::default(), 4e-3, 1.0);
    let lattice = Lattice { side: 8, speed: 10.0, ..lattice };
    let spheres = books::<D3>(lattice, Material { rolling_friction: 0.05, ..Material::default() }, 4e-4, 0.1);
    println!("residual over energy turned over: {disks:.1e} {spheres:.1e}");
    assert!(disks < 1e-3 && spheres < 1e-3, "{disks:e} {spheres:e}");
}

#[test]
fn a_belt_is_a_floor_seen_by_a_grain_in_motion() {
    let run = |of_belt: f64, of_grain: f64| {
        let velocity = DVec2::new(of_belt, 0.0);
        let mut dem = one::<D2>(
            |glass| Grain::at(DVec2::new(0.0, 1e-3), 1e-3, glass).moving(DVec2::new(of_grain, 0.0)),
            &|glass| {
                let wall = Wall::plane("belt", DVec2::ZERO, DVec2::Y, glass).unwrap();
                if of_belt == 0.0 { wall } else { wall.moving(WallMotion::Steady { velocity }) }
            },
            Material { friction: 0.2, restitution: 0.2, ..Material::default() },
            9.81,
        );
        dem.advance(1e-5, 1000).unwrap();
        (dem.losses().total(), dem.energy_residual().unwrap(), dem.grain(0).velocity.x - of_belt)
    };
    let (belt, floor) = (run(0.05, 0.0), run(0.0, -0.05));
    assert!((belt.0 - floor.0).abs() < 1e-11 * floor.0, "{belt:?} {floor:?}");
    assert!((belt.1 - floor.1).abs() < 1e-11 * floor.0, "{belt:?} {floor:?}");
    assert!((belt.2 - floor.2).abs() < 1e-12, "{belt:?} {floor:?}");
}
