//! Where walls are, how they move, torques on them, pressures of servos on a changing area, and what lies below grains.

use crate::sample::down;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Numbers, Solver, Vector};
use granular_dem::{
    Dem, Dem2, Dem3, Gates, Grain, Inlet, Material, MaterialId, Materials, Options, PressureBetween, Servo,
    Setup, Wall, WallMotion,
};
use std::f64::consts::TAU;

fn one_material(material: Material) -> (Materials, MaterialId) {
    let mut materials = Materials::new();
    let id = materials.add(material).unwrap();
    (materials, id)
}

fn scene<D: Dim>(
    material: Material,
    gravity: f64,
    make: impl Fn(MaterialId) -> (Vec<Grain<D>>, Vec<Wall<D>>),
) -> Dem<D> {
    let (materials, id) = one_material(material);
    let (grains, walls) = make(id);
    Dem::new(Setup { materials, grains, walls, gravity: down::<D>(gravity), options: Options::default() })
        .unwrap()
}

fn number<D: Dim>(dem: &Dem<D>, name: &str) -> f64 {
    assert!(dem.shown().iter().any(|shown| shown.name == name), "{name} is in no list");
    let mut numbers = Numbers::wanting([name]);
    dem.show(&mut numbers);
    numbers.get(name).unwrap()
}

#[test]
fn a_wall_tells_where_it_is_and_how_it_moves() {
    let amplitude = DVec2::new(2e-3, 0.0);
    let mut dem = scene::<D2>(Material::default(), 0.0, |id| {
        let to_and_fro = WallMotion::Oscillating { amplitude, frequency: 10.0, phase: 0.0 };
        let turning = WallMotion::Turning { about: DVec2::ZERO, spin: 3.0 };
        let walls = vec![
            Wall::block("piston", DVec2::new(1.0, 1.0), DVec2::new(1.2, 1.4), id).unwrap().moving(to_and_fro),
            Wall::segment("arm", DVec2::new(1.0, 0.0), DVec2::new(2.0, 0.0), id).unwrap().moving(turning),
            Wall::plane("floor", DVec2::ZERO, DVec2::Y, id).unwrap(),
        ];
        (vec![Grain::at(DVec2::new(0.0, 9.0), 1e-3, id)], walls)
    });
    let steps = 1234;
    dem.advance(1e-5, steps).unwrap();
    let time = 1e-5 * steps as f64;
    let close = |name: &str, expected: f64| {
        let found = number(&dem, name);
        assert!((found - expected).abs() < 1e-12 * expected.abs().max(1.0), "{name}: {found} of {expected}");
    };
    let angle = TAU * 10.0 * time;
    close("displacement_of_piston_x", 2e-3 * angle.sin());
    close("position_of_piston_x", 1.1 + 2e-3 * angle.sin());
    close("position_of_piston_y", 1.2);
    close("velocity_of_piston_x", 2e-3 * TAU * 10.0 * angle.cos());
    close("angle_of_arm", 3.0 * time);
    close("position_of_arm_x", 1.5 * (3.0 * time).cos());
    close("position_of_arm_y", 1.5 * (3.0 * time).sin());
    close("velocity_of_arm_y", 1.5 * 3.0 * (3.0 * time).cos());
    // A wall at rest has none of it, and costs nothing.
    assert!(!dem.shown().iter().any(|shown| shown.name.ends_with("of_floor_x")));
}

/// A disk at rest on a plate that can turn: its weight times the arm.
#[test]
fn the_torque_on_a_wall_is_weight_times_arm() {
    fn check<D: Dim>(component: &str, sign: f64) {
        let (arm, radius) = (0.3, 1e-3);
        let mut dem = scene::<D>(Material { friction: 0.5, ..Material::default() }, 9.81, |id| {
            let point = |x: f64, up: f64| D::Vec::along(0, x) + D::Vec::along(D::UP, up);
            let across = (1..D::N)
                .filter(|axis| *axis != D::UP)
                .fold(D::Vec::default(), |sum, axis| sum + D::Vec::along(axis, 1.0));
            let plate =
                Wall::block("plate", point(-1.0, -0.1) - across, point(1.0, 0.0) + across, id).unwrap();
            (vec![Grain::at(point(arm, radius), radius, id)], vec![plate])
        });
        dem.advance(dem.recommended_step(), 20_000).unwrap();
        let weight = 2650.0 * D::ball_volume(radius) * 9.81;
        let found = number(&dem, component);
        // Torque of a force straight down about a point to its left turns clockwise: -z in the plane, +y in space.
        assert!((found / (sign * weight * arm) - 1.0).abs() < 1e-3, "{found} of {}", sign * weight * arm);
    }
    check::<D2>("torque_on_plate", -1.0);
    check::<D3>("torque_on_plate_y", 1.0);
}

/// A disk that slides to and fro in a frictionless drum, at small angles: a pendulum of length drum less disk.
#[test]
fn a_disk_in_a_drum_swings_as_a_pendulum() {
    let (drum, radius, start) = (0.1, 5e-3, 0.02);
    let length: f64 = drum - radius;
    let mut dem = scene::<D2>(
        Material { friction: 0.0, restitution: 0.1, normal_stiffness: 1e7, ..Material::default() },
        9.81,
        |id| {
            let at = DVec2::new(length * f64::sin(start), -length * f64::cos(start));
            let wall = Wall::circle("drum", DVec2::ZERO, drum, id).unwrap();
            (vec![Grain::at(at, radius, id)], vec![wall])
        },
    );
    // Period of a pendulum with its first correction for the amplitude.
    let period = TAU * (length / 9.81).sqrt() * (1.0 + start * start / 16.0);
    let dt = dem.recommended_step();
    let steps = (period / dt).round();
    dem.advance(period / steps, steps as u64).unwrap();
    let back = dem.grain(0).position;
    let angle = back.x.atan2(-back.y);
    assert!((angle / start - 1.0).abs() < 5e-3, "{angle} of {start}");
    assert!((back.length() - length).abs() < 1e-5);
}

#[test]
fn a_turning_drum_carries_a_disk_with_friction() {
    let mut dem = scene::<D2>(
        Material { friction: 0.6, restitution: 0.2, normal_stiffness: 1e6, ..Material::default() },
        9.81,
        |id| {
            let motion = WallMotion::Turning { about: DVec2::ZERO, spin: 2.0 };
            let drum = Wall::circle("drum", DVec2::ZERO, 0.1, id).unwrap().moving(motion);
            (vec![Grain::at(DVec2::new(0.0, -0.095), 5e-3, id)], vec![drum])
        },
    );
    dem.advance(dem.recommended_step(), 200_000).unwrap();
    // It swings to and fro and rolls all the way: where they touch, disk and drum move alike.
    let grain = dem.grain(0);
    let out = grain.position.normalize();
    let slip = grain.velocity + out.perp() * (grain.spin * 5e-3) - out.perp() * (2.0 * 0.1);
    assert!(slip.length() < 1e-3 * 0.2, "{slip}");
    assert!(number(&dem, "torque_on_drum").is_finite());
}

#[test]
fn inside_a_sphere_a_ball_comes_to_rest_at_the_bottom() {
    let mut dem = scene::<D3>(
        Material { friction: 0.0, restitution: 0.3, normal_stiffness: 1e6, ..Material::default() },
        9.81,
        |id| {
            let shell = Wall::circle("shell", DVec3::ZERO, 0.05, id).unwrap();
            (vec![Grain::at(DVec3::new(0.0, 0.0, -0.03), 5e-3, id)], vec![shell])
        },
    );
    dem.advance(dem.recommended_step(), 60_000).unwrap();
    assert!(
        (dem.grain(0).position - DVec3::new(0.0, 0.0, -0.045)).length() < 1e-4,
        "{}",
        dem.grain(0).position
    );
}

/// Disks in a box whose right side moves in while a lid presses: the lid carries the pressure on the width that there is.
#[test]
fn a_servo_keeps_its_pressure_while_the_area_changes() {
    let (pressure, speed, side) = (2e3, 0.02, 12);
    let mut dem = scene::<D2>(
        Material { friction: 0.0, restitution: 0.2, normal_stiffness: 1e6, ..Material::default() },
        0.0,
        |id| {
            let grains = (0..side * side).map(|k| {
                let at = DVec2::new((k % side) as f64 + 0.5, (k / side) as f64 + 0.5) * 1e-3;
                Grain::at(at, 0.49e-3 - 0.02e-3 * (k % 3) as f64, id)
            });
            let width = side as f64 * 1e-3;
            let servo = Servo {
                direction: -DVec2::Y,
                force: 0.0,
                pressure: Some(PressureBetween { pressure, walls: [[1, 2], [0, 0]] }),
                mass: 0.05,
                damping: 5.0,
                max_speed: 1.0,
            };
            let walls = vec![
                Wall::plane("floor", DVec2::ZERO, DVec2::Y, id).unwrap(),
                Wall::plane("left", DVec2::ZERO, DVec2::X, id).unwrap(),
                Wall::plane("right", DVec2::X * width, -DVec2::X, id)
                    .unwrap()
                    .moving(WallMotion::Steady { velocity: -DVec2::X * speed }),
                Wall::plane("lid", DVec2::Y * width, -DVec2::Y, id).unwrap().moving(WallMotion::Servo(servo)),
            ];
            (grains.collect(), walls)
        },
    );
    let dt = dem.recommended_step();
    let (mut sum, mut looks) = (0.0, 0.0);
    for look in 0..400 {
        dem.advance(dt, 100).unwrap();
        let width = side as f64 * 1e-3 - speed * dem.time();
        assert!((number(&dem, "area_of_lid") - width).abs() < 1e-12);
        if look >= 200 {
            sum += number(&dem, "pressure_on_lid");
            looks += 1.0;
        }
    }
    assert!((sum / looks / pressure - 1.0).abs() < 0.02, "{} Pa", sum / looks);
    assert!(number(&dem, "area_of_lid") < 0.95 * side as f64 * 1e-3);
}

#[test]
fn a_pressure_needs_planes_that_face_one_another() {
    let servo = |walls| Servo {
        direction: -DVec2::Y,
        force: 0.0,
        pressure: Some(PressureBetween { pressure: 1.0, walls }),
        mass: 1.0,
        damping: 1.0,
        max_speed: 1.0,
    };
    for walls in [[[0, 1], [0, 0]], [[1, 0], [0, 0]], [[1, 7], [0, 0]]] {
        let (materials, id) = one_material(Material::default());
        let lid =
            Wall::plane("lid", DVec2::Y, -DVec2::Y, id).unwrap().moving(WallMotion::Servo(servo(walls)));
        let left = Wall::plane("left", DVec2::ZERO, DVec2::X, id).unwrap();
        let setup = Setup {
            materials,
            grains: vec![],
            walls: vec![lid, left],
            gravity: DVec2::ZERO,
            options: Options::default(),
        };
        let error = Dem2::new(setup).err().unwrap();
        assert!(error.to_string().contains("two planes that face one another"), "{error}");
    }
}

#[test]
fn grains_with_nothing_below_are_counted() {
    let column = |walls: &dyn Fn(MaterialId) -> Vec<Wall<D2>>| {
        scene::<D2>(Material::default(), 9.81, |id| {
            let grains = (0..4).map(|k| Grain::at(DVec2::new(f64::from(k), 1.0), 0.1, id)).collect();
            (grains, walls(id))
        })
    };
    let gravity = DVec2::new(0.0, -9.81);
    let falling = |dem: &Dem2| dem.falling(gravity, Gates::Shut).unwrap().grains;
    assert_eq!(falling(&column(&|_| vec![])), 4);
    let floor = |id| vec![Wall::plane("floor", DVec2::ZERO, DVec2::Y, id).unwrap()];
    assert_eq!(falling(&column(&floor)), 0);
    assert_eq!(column(&floor).falling(-gravity, Gates::Shut).unwrap().grains, 4);
    let side = |id| vec![Wall::plane("side", DVec2::ZERO, DVec2::X, id).unwrap()];
    assert_eq!(falling(&column(&side)), 4);
    // On a slope both planes catch.
    assert_eq!(column(&side).falling(DVec2::new(-1.0, -9.81), Gates::Shut).unwrap().grains, 0);
    let shelf = |id| vec![Wall::block("shelf", DVec2::new(-0.5, 0.0), DVec2::new(1.5, 0.5), id).unwrap()];
    assert_eq!(falling(&column(&shelf)), 2);
    let lid = |id| vec![Wall::block("lid", DVec2::new(-0.5, 2.0), DVec2::new(5.0, 2.5), id).unwrap()];
    assert_eq!(falling(&column(&lid)), 4);
    let mut dem = column(&floor);
    dem.set_open("floor", true);
    assert_eq!(dem.falling(gravity, Gates::AsTheyAre).unwrap().grains, 4);
    assert!(dem.falling(DVec2::ZERO, Gates::Shut).is_none());
    let highest = dem.falling(gravity, Gates::Shut).unwrap().highest;
    assert!((highest + 1.1).abs() < 1e-15, "{highest}");
}

#[test]
fn a_solver_without_a_grain_has_numbers_that_say_so() {
    let (materials, id) = one_material(Material::default());
    let floor = Wall::plane("floor", DVec3::ZERO, DVec3::Z, id).unwrap();
    let mut dem = Dem3::new(Setup {
        materials,
        grains: vec![],
        walls: vec![floor],
        gravity: DVec3::NEG_Z,
        options: Options::default(),
    })
    .unwrap();
    let (low, high) = (DVec3::new(-0.1, -0.1, 0.1), DVec3::splat(0.2));
    let inlet = Inlet {
        name: "in".to_owned(),
        low,
        high,
        rate: 1000.0,
        number: 3,
        radii: vec![1e-3],
        velocity: DVec3::ZERO,
        material: id,
        seed: 1,
        runs: true,
    };
    dem.add_inlet(inlet).unwrap();
    assert!(dem.brings_grains());
    for name in ["front", "height"] {
        assert!(number(&dem, name).is_nan(), "{name}");
    }
    for shown in dem.shown() {
        let mut numbers = Numbers::wanting([shown.name.as_str()]);
        dem.show(&mut numbers);
        assert!(numbers.get(&shown.name).is_none_or(|value| !value.is_infinite()), "{}", shown.name);
    }
    // Grains that never touch anything.
    dem.allow_any_step();
    dem.advance(1e-5, 1000).unwrap();
    assert!(!dem.brings_grains() && dem.len() == 3);
    let front = number(&dem, "front");
    assert!(dem.grains().any(|(_, grain)| grain.position.x + grain.radius == front), "{front}");
}
