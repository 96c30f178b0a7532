//! Free grains in a fluid: what is kept exactly.

use crate::tank::{Balls, Tank, unit_fluid};
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, FlowLoad, Linear, Provides, Simulation};
use granular_coupling::{HeldLoad, ResolvedGrains, ResolvedOptions};
use granular_lbm::{D2Q9, D3Q19, Face, Lattice, Lbm2};
use std::f64::consts::TAU;

type Plane = Tank<D2Q9, 9>;

/// Momentum of fluid and grains, that of the fluid within grains left out, in each step over the largest part of it.
fn drift_of_momentum<L: Lattice<Q>, const Q: usize>(
    tank: &mut Tank<L, Q>,
    held: HeldLoad,
    steps: u32,
) -> f64 {
    let mut total = tank.momentum_of_fluid() + tank.momentum_of_grains();
    let mut scale = tank.momentum_of_fluid().length() + tank.momentum_of_grains().length();
    let mut before = Vec::new();
    let mut worst = 0.0_f64;
    for step in 0..steps {
        tank.advance(1);
        let flow = Provides::<FlowLoad<L::Dim>>::view(tank.fluid());
        if step == 0 {
            // What was found in the place of grains is no longer there.
            before = flow.covered.iter().map(|found| found.momentum).collect();
            before.iter().for_each(|found| total -= *found);
        }
        let met: Vec<_> = tank.met().iter().map(|(velocity, volume)| *velocity * *volume).collect();
        let mut now = tank.momentum_of_fluid() + tank.momentum_of_grains();
        for ((met, before), load) in met.iter().zip(&before).zip(flow.loads) {
            now -= *met;
            if held == HeldLoad::TwoSteps {
                now += (load.force + (*met - *before)) * 0.5;
            }
            scale = scale.max(load.force.length());
        }
        before = met;
        worst = worst.max((now - total).length() / scale);
    }
    worst
}

/// Disks that touch, turn, and cross the faces, in a fluid that moves.
#[test]
fn momentum_of_fluid_and_free_disks_is_kept_to_round_off() {
    let balls = vec![
        (DVec2::new(2.2, 28.3), DVec2::new(0.03, 0.01), 4.3),
        (DVec2::new(10.2, 28.0), DVec2::new(-0.03, 0.02), 3.6),
        (DVec2::new(25.0, 12.0), DVec2::new(0.0, -0.04), 6.0),
    ];
    for (density, held, radius_factor) in
        [(2.65, HeldLoad::OneStep, 1.0), (1.01, HeldLoad::OneStep, 0.9), (1.3, HeldLoad::TwoSteps, 1.0)]
    {
        let balls = Balls { friction: 0.5, ..Balls::<D2>::of(density, balls.clone()) };
        let options = ResolvedOptions { held, radius_factor, ..ResolvedOptions::default() };
        let flow = |p: DVec2| DVec2::new(0.02 + 0.02 * (p.y / 30.0 * TAU).sin(), 0.0);
        let mut tank = Plane::new(unit_fluid([40, 30, 1], 0.7), flow, &balls, options);
        let drift = drift_of_momentum(&mut tank, held, 120);
        println!("{density} {held:?}: {drift:.1e}");
        assert!(drift < 1e-12, "{density} {held:?}: {drift}");
        // They have met, and the contact had them turn.
        assert!(tank.grains().grain(0).spin.abs() > 1e-5);
    }
}

#[test]
fn momentum_of_fluid_and_free_spheres_is_kept_to_round_off() {
    let balls = vec![
        (DVec3::new(1.0, 9.0, 15.0), DVec3::new(0.02, 0.0, 0.03), 4.1),
        (DVec3::new(9.2, 9.5, 15.0), DVec3::new(-0.03, 0.01, 0.0), 3.8),
    ];
    let flow = |p: DVec3| DVec3::new(0.0, 0.02 * (p.x / 20.0 * TAU).sin(), 0.01);
    let options = ResolvedOptions::default();
    let balls = Balls::<D3>::of(1.2, balls);
    let mut tank = Tank::<D3Q19, 19>::new(unit_fluid([20, 18, 16], 0.7), flow, &balls, options);
    let drift = drift_of_momentum(&mut tank, HeldLoad::OneStep, 30);
    println!("{drift:.1e}");
    assert!(drift < 1e-12, "{drift}");
}

/// A disk that a stream carries feels nothing; one that is let go at rest is taken along.
#[test]
fn a_free_disk_takes_the_speed_of_a_stream() {
    let stream = DVec2::new(0.04, -0.02);
    let release = |velocity: DVec2, steps: u64| {
        let balls = Balls::<D2>::of(1.5, vec![(DVec2::new(31.2, 25.5), velocity, 8.3)]);
        let mut tank =
            Plane::new(unit_fluid([60, 50, 1], 1.0), |_| stream, &balls, ResolvedOptions::default());
        let mut largest = 0.0_f64;
        let first = {
            tank.advance(1);
            tank.grains().loads()[0].force.length()
        };
        for _ in 0..steps {
            tank.advance(1);
            largest = largest.max(tank.grains().loads()[0].force.length());
        }
        (tank, first, largest)
    };
    let (_, first, carried) = release(stream, 300);
    let (tank, at_rest, _) = release(DVec2::ZERO, 6000);
    let last = tank.grains().loads()[0].force.length();
    println!("carried {first:.1e} {carried:.1e}, let go at rest {at_rest:.2e}, at last {last:.1e}");
    assert!(carried.max(first) < 1e-10 * at_rest, "{carried} of {at_rest}");
    // All moves at the one speed that momentum leaves.
    let volume = D2::ball_volume(8.3);
    let common = stream * ((3000.0 - volume) / (3000.0 + 0.5 * volume));
    let off = (tank.velocity(0) - common).length() / stream.length();
    println!("off by {off:.1e}");
    assert!(last < 1e-3 * at_rest && off < 1e-3, "{last} of {at_rest}, {off}");
}

/// A disk on the floor of a tank presses on it with its weight less that of the fluid it displaces.
#[test]
fn a_disk_on_the_floor_has_its_submerged_weight() {
    let (radius, density) = (6.3, 1.6);
    let gravity = DVec2::new(0.0, -1e-5);
    for has_weight in [false, true] {
        let mut setup = unit_fluid::<D2>([40, 40, 1], 0.8);
        setup.faces[1] = [Face::REST, Face::REST];
        if has_weight {
            setup.acceleration = gravity;
        }
        let balls = vec![
            (DVec2::new(20.3, radius), DVec2::ZERO, radius),
            (DVec2::new(20.3, 3.0 * radius), DVec2::ZERO, radius),
        ];
        let balls = Balls { gravity, floor: Some(0.0), ..Balls::<D2>::of(density, balls) };
        let options = ResolvedOptions { gravity: (!has_weight).then_some(gravity), ..Default::default() };
        let mut tank = Plane::new(setup, |_| DVec2::ZERO, &balls, options);
        tank.advance(6000);
        let weight = -gravity.y * D2::ball_volume(radius);
        for (id, load) in tank.grains().loads().iter().enumerate() {
            println!("weight {has_weight}: buoyancy of {id} {:.6} of {weight:.3e}", load.force.y / weight);
            assert!(
                (load.force.y / weight - 1.0).abs() < 1e-3 && load.force.x.abs() < 1e-3 * weight,
                "{load:?}"
            );
        }
        // Two disks press on the floor.
        let contact =
            (radius - tank.grains().grain(0).position.y) * crate::tank::stiffness::<D2>(density, radius);
        let submerged = 2.0 * (density - 1.0) * weight;
        println!("contact {:.6}", contact / submerged);
        assert!((contact / submerged - 1.0).abs() < 1e-3, "{contact} of {submerged}");
        let (fastest, fall) = (tank.velocity(1).length(), (-gravity.y * radius).sqrt());
        println!("fastest {:.1e} of the speed of a fall by a radius", fastest / fall);
        assert!(fastest < 1e-6 * fall, "{fastest}");
    }
}

/// The same, wherever the faces of the fluid are.
#[test]
fn grains_that_cross_a_periodic_face_move_as_others() {
    let gravity = DVec2::new(0.0, -2e-4);
    let run = |shift: DVec2| {
        let balls = vec![
            (DVec2::new(17.1, 14.3) + shift, DVec2::new(0.02, 0.01), 4.3),
            (DVec2::new(24.9, 15.2) + shift, DVec2::new(-0.03, 0.0), 3.6),
        ];
        let balls = Balls { gravity, friction: 0.4, ..Balls::<D2>::of(1.4, balls) };
        let mut tank = Plane::new(
            unit_fluid([40, 30, 1], 0.7),
            |_| DVec2::ZERO,
            &balls,
            ResolvedOptions { gravity: Some(gravity), ..Default::default() },
        );
        tank.advance(250);
        [0, 1].map(|id| {
            let grain = tank.grains().grain(id);
            (grain.position - shift, grain.velocity, grain.spin)
        })
    };
    let whole = run(DVec2::ZERO);
    for shift in [DVec2::new(19.0, 0.0), DVec2::new(-20.0, -14.0), DVec2::new(40.0, 16.0)] {
        for (a, b) in run(shift).iter().zip(&whole) {
            let off = (a.0 - b.0).length().max((a.1 - b.1).length() * 10.0).max((a.2 - b.2).abs() * 10.0);
            assert!(off < 1e-9, "{shift}: {a:?} and {b:?}");
        }
    }
    assert!(whole[0].2.abs() > 1e-5, "they have touched");
}

#[test]
fn choices_that_make_no_sense_and_grains_that_are_too_small_are_refused() {
    let said = |options: ResolvedOptions<D2>, radius: f64| {
        let mut simulation =
            Simulation::named("water", Box::new(Lbm2::new(unit_fluid([20, 20, 1], 0.8)).unwrap()));
        let water = simulation.find::<Lbm2>("water").unwrap();
        let balls = Balls::<D2>::of(2.0, vec![(DVec2::splat(10.0), DVec2::ZERO, radius)]);
        let grains = simulation.add("grains", balls.solver()).unwrap();
        simulation.couple(water, grains, ResolvedGrains::new(options)).unwrap_err().to_string()
    };
    let with = |radius_factor: f64| ResolvedOptions { radius_factor, ..Default::default() };
    for (options, radius, part) in [
        (with(0.0), 4.0, "above 0 and at most 1"),
        (with(1.1), 4.0, "hydrodynamic radius over that of the grain"),
        (ResolvedOptions { own_factors: vec![f64::NAN], ..Default::default() }, 4.0, "above 0 and at most 1"),
        (ResolvedOptions { gravity: Some(DVec2::NAN), ..Default::default() }, 4.0, "gravity on the fluid"),
        (with(0.5), 3.0, "hydrodynamic radius of grain 0"),
    ] {
        let said = said(options, radius);
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
}
