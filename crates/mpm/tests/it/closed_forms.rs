//! Small cases with closed forms.

use crate::sample::{SCHEMES, SHAPES, alone};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, Solver, SymmetricTensor};
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, VelocityUpdate, Wall};
use std::f64::consts::{PI, TAU};

fn with(shape: ShapeFunctions, scheme: Scheme) -> Options {
    Options { shape, scheme, ..Options::default() }
}

fn plane(name: &str, point: DVec2, normal: DVec2, condition: Condition) -> Wall<D2> {
    Wall::plane(name, point, normal, condition).unwrap()
}

/// Walls that leave only one direction free, and hold its lower end.
fn tube(along: DVec2, width: f64) -> Vec<Wall<D2>> {
    let across = DVec2::new(along.y, along.x);
    vec![
        plane("end", DVec2::ZERO, along, Condition::Slip),
        plane("side", DVec2::ZERO, across, Condition::Slip),
        plane("other side", across * width, -across, Condition::Slip),
    ]
}

/// One particle in one cell is a spring: `v = v0 cos(w t)` and `x = x0 exp(v0 / (L w) sin(w t))`.
#[test]
fn one_particle_swings_in_its_cell() {
    alone(|| {
        for scheme in SCHEMES {
            let setup = Setup {
                walls: tube(DVec2::X, 1.0),
                options: with(ShapeFunctions::Linear, scheme),
                ..Setup::new(1.0)
            };
            let mut mpm = Mpm2::new(setup).unwrap();
            let particle = Particle::at(DVec2::splat(0.5), 1.0).moving(DVec2::new(0.01, 0.0));
            mpm.body(LinearElastic::new(4.0 * PI * PI, 0.0).unwrap(), 1.0, &[particle]).unwrap();
            let dt = 2.5e-4;
            // Stresses that come last take half a per cent in each period.
            let quarters = if scheme == Scheme::StressLast { 4 } else { 40 };
            for quarter in 1..=quarters {
                mpm.advance(dt, 1000).unwrap();
                let (time, particle) = (0.25 * f64::from(quarter), mpm.particle(0));
                let place = 0.5 * (0.01 / TAU * (TAU * time).sin()).exp();
                assert!(
                    (particle.position.x - place).abs() < 0.01 * 0.5 * 0.01 / TAU,
                    "{scheme:?} at {time}"
                );
                let speed = 0.01 * (TAU * time).cos();
                assert!((particle.velocity.x - speed).abs() < 0.01 * 0.01, "{scheme:?} at {time}");
            }
        }
    });
}

/// A bar of 25 m with a wave of 10 m/s in its mode `n`.
fn bar(mode: u32, options: Options) -> Mpm2 {
    let cell = 25.0 / 13.0;
    let setup = Setup { walls: tube(DVec2::X, cell), options, ..Setup::new(cell) };
    let mut mpm = Mpm2::new(setup).unwrap();
    let number = f64::from(2 * mode - 1) * PI / 50.0;
    let particles: Vec<_> = Particle::<D2>::filling(DVec2::ZERO, DVec2::new(25.0, cell), cell)
        .iter()
        .map(|particle| particle.moving(DVec2::new(1e-3 * (number * particle.position.x).sin(), 0.0)))
        .collect();
    mpm.body(LinearElastic::new(100.0, 0.0).unwrap(), 1.0, &particles).unwrap();
    mpm
}

#[test]
fn a_bar_swings_with_its_period_and_keeps_its_energy() {
    alone(|| {
        for shape in SHAPES {
            let mut mpm = bar(1, with(shape, Scheme::ModifiedStressLast));
            let (dt, start) = (0.01, mpm.energies().mechanical());
            assert!((start * 13.0 / 25.0 / 0.0625e-4 - 1.0).abs() < 1e-3, "per metre of its height: {start}");
            let (mut last, mut crossings) = (mpm.momentum().x, Vec::new());
            let amplitude = last / mpm.mass();
            assert!((amplitude / (1e-3 * 2.0 / PI) - 1.0).abs() < 0.01, "{shape:?}: {amplitude}");
            while mpm.time() < 100.0 {
                mpm.step(dt).unwrap();
                let now = mpm.momentum().x;
                if last * now < 0.0 {
                    crossings.push(mpm.time() - dt * now / (now - last));
                }
                last = now;
            }
            assert_eq!(crossings.len(), 20);
            let period = (crossings[19] - crossings[1]) / 9.0;
            assert!((period / 10.0 - 1.0).abs() < 0.01, "{shape:?}: {period} s");
            let drift = mpm.energies().mechanical() / start - 1.0;
            assert!(drift.abs() < 1e-3, "{shape:?}: {drift}");
        }
    });
}

/// A column that is loaded by its weight, slowly and with damping, and what it does at rest.
fn loaded(mut mpm: Mpm2, gravity: f64, dt: f64, steps: u64) -> Mpm2 {
    mpm.set_local_damping(0.1).unwrap();
    for tenth in 1..=10 {
        mpm.set_gravity(DVec2::new(0.0, -gravity * 0.1 * f64::from(tenth))).unwrap();
        mpm.advance(dt, steps / 20).unwrap();
    }
    mpm.advance(dt, steps / 2).unwrap();
    mpm
}

/// Stress is `-rho g (H - Y)` whatever the law, and places are those of logarithmic strain: here up to a third. Linear shape
/// functions are left out: crossing particles keep this column trembling, and it sags.
#[test]
fn a_column_sinks_by_its_own_weight() {
    alone(|| {
        let (height, weight, young) = (50.0, 800.0, 1e5);
        for (shape, allowed) in
            [(ShapeFunctions::UniformGimp, 0.03), (ShapeFunctions::QuadraticBspline, 0.04)]
        {
            let options = with(shape, Scheme::ModifiedStressLast);
            let mut mpm =
                Mpm2::new(Setup { walls: tube(DVec2::Y, 1.0), options, ..Setup::new(1.0) }).unwrap();
            let particles = Particle::<D2>::filling(DVec2::ZERO, DVec2::new(1.0, height), 0.5);
            mpm.body(LinearElastic::new(young, 0.0).unwrap(), 80.0, &particles).unwrap();
            let mpm = loaded(mpm, 10.0, 0.02, 9600);
            let (mut error, mut farthest) = (0.0, 0.0_f64);
            for (id, particle) in mpm.particles() {
                let material = particles[id as usize].position.y;
                let stress = -weight * (height - material);
                let place = young / weight * ((stress / young).exp() - (-weight * height / young).exp());
                farthest = farthest.max((particle.position.y - place).abs() / 41.21);
                error += (particle.stress.yy - stress).powi(2);
            }
            let relative = (error / particles.len() as f64).sqrt() / (weight * height);
            // Stresses are off in the cell at the floor, where particles reach behind it.
            assert!(farthest < 0.01 && relative < allowed, "{shape:?}: {farthest} {relative}");
        }
    });
}

#[test]
fn a_column_of_soil_settles_elastically() {
    alone(|| {
        for shape in SHAPES {
            let options = with(shape, Scheme::ModifiedStressLast);
            let cell = 0.01;
            let mut mpm =
                Mpm2::new(Setup { walls: tube(DVec2::Y, cell), options, ..Setup::new(cell) }).unwrap();
            let particles = Particle::<D2>::filling(DVec2::ZERO, DVec2::new(cell, 0.2), 0.25 * cell);
            mpm.body(LinearElastic::new(1.98e6, 0.23).unwrap(), 1925.0, &particles).unwrap();
            let mpm = loaded(mpm, 9.81, 2e-4, 4000);
            let top = (0..particles.len())
                .max_by(|&a, &b| particles[a].position.y.total_cmp(&particles[b].position.y));
            let top = top.unwrap();
            let material = particles[top].position.y;
            let modulus = 2.29539e6;
            let expected = 1925.0 * 9.81 / modulus * (0.2 * material - 0.5 * material * material);
            let settled = material - mpm.particle(top as u32).position.y;
            // Splines that reach behind a wall feel it half a cell deeper.
            let deeper = if shape == ShapeFunctions::QuadraticBspline { 0.035 } else { 0.01 };
            assert!((settled / expected - 1.0).abs() < deeper, "{shape:?}: {settled} of {expected}");
            let base = mpm.wall_forces()[0].y / (0.2 * cell * 1925.0 * 9.81);
            assert!((base + 1.0).abs() < 1e-3, "{shape:?}: the base carries {base} of the weight");
        }
    });
}

/// Share of its angular momentum that a disk loses in one turn.
fn lost_in_a_turn(shape: ShapeFunctions, cell: f64, velocity_update: VelocityUpdate) -> f64 {
    let options = Options { velocity_update, ..with(shape, Scheme::ModifiedStressLast) };
    let mut mpm = Mpm2::new(Setup { options, ..Setup::new(cell) }).unwrap();
    let low = DVec2::splat(-0.5);
    let particles: Vec<_> = Particle::<D2>::filling_part(low, -low, 0.5 * cell, |at| at.length() < 0.5)
        .iter()
        .map(|particle| particle.moving(particle.position.perp() * TAU))
        .collect();
    mpm.body(LinearElastic::new(1e6, 0.3).unwrap(), 1000.0, &particles).unwrap();
    let start = mpm.angular_momentum();
    let steps = (80.0 / cell).round();
    mpm.advance(1.0 / steps, steps as u64).unwrap();
    let reach = mpm.particles().map(|(_, particle)| particle.position.length()).fold(0.0, f64::max);
    assert!((reach / 0.5 - 1.0).abs() < 0.02, "{shape:?}: {reach}");
    1.0 - mpm.angular_momentum() / start
}

/// What particles have of velocities that the nodes at the rim do not see turns less than they do, an error of the grid.
#[test]
fn a_turning_disk_loses_less_angular_momentum_in_smaller_cells() {
    alone(|| {
        for shape in [ShapeFunctions::UniformGimp, ShapeFunctions::QuadraticBspline] {
            let flip = VelocityUpdate::default();
            let [coarse, fine] = [0.1, 0.05].map(|cell| lost_in_a_turn(shape, cell, flip));
            assert!(fine.abs() < 0.02 && fine.abs() < 0.4 * coarse.abs(), "{shape:?}: {coarse} {fine}");
        }
    });
}

#[test]
fn affine_velocities_keep_angular_momentum() {
    alone(|| {
        for shape in [ShapeFunctions::UniformGimp, ShapeFunctions::QuadraticBspline] {
            let lost = lost_in_a_turn(shape, 0.1, VelocityUpdate::Apic);
            println!("{shape:?}: {lost:.1e} of its angular momentum in a turn");
            assert!(lost.abs() < 1e-11, "{shape:?}: {lost}");
        }
    });
}

#[test]
fn affine_velocities_need_moments_that_do_not_vanish() {
    let options =
        Options { velocity_update: VelocityUpdate::Apic, ..with(ShapeFunctions::Linear, Scheme::default()) };
    let error = Mpm2::new(Setup { options, ..Setup::new(0.1) }).unwrap_err().to_string();
    assert!(error.contains("Apic") && error.contains("QuadraticBspline"), "{error}");
}

/// \[Sulsky1994\]
#[test]
fn two_disks_meet_and_part() {
    alone(|| {
        for shape in SHAPES {
            let mut mpm =
                Mpm2::new(Setup { options: with(shape, Scheme::ModifiedStressLast), ..Setup::new(0.05) })
                    .unwrap();
            let law = LinearElastic::new(1000.0, 0.3).unwrap();
            for (centre, velocity) in [(0.2, 0.1), (0.8, -0.1)] {
                let centre = DVec2::splat(centre);
                let reach = DVec2::splat(0.2);
                let disk: Vec<_> =
                    Particle::<D2>::filling_part(centre - reach, centre + reach, 0.0125, |at| {
                        (at - centre).length() < 0.2
                    })
                    .iter()
                    .map(|particle| particle.moving(DVec2::splat(velocity)))
                    .collect();
                mpm.body(law, 1000.0, &disk).unwrap();
            }
            let start = mpm.energies().translational();
            assert!((start / 2.5133 - 1.0).abs() < 0.01, "{start}");
            let mut least: f64 = start;
            for _ in 0..70 {
                mpm.advance(2e-3, 25).unwrap();
                least = least.min(mpm.energies().translational());
                assert!(mpm.momentum().length() < 1e-12, "{shape:?}");
            }
            // Stresses of a rate form store no exact energy at a tenth of strain: the balance is drawn when they have parted.
            let kept = mpm.energies().mechanical() / start;
            assert!((kept - 1.0).abs() < 0.02, "{shape:?}: {kept}");
            // They have met, and fly apart again.
            assert!(
                least < 0.5 * start && mpm.energies().translational() > 0.8 * start,
                "{shape:?}: {least}"
            );
            let first = mpm.particles().filter(|(id, _)| *id == 0).map(|(_, p)| p.velocity.x).sum::<f64>();
            assert!(first < 0.0, "{shape:?}");
        }
    });
}

/// Particles that carry one stress everywhere push nodes inside nowhere, wherever they are in their cells; linear shape
/// functions do once particles have left the places where they sum up evenly.
#[test]
fn uniform_stress_pushes_nothing_inside() {
    for (shape, tolerance) in [(ShapeFunctions::UniformGimp, 1e-12), (ShapeFunctions::QuadraticBspline, 0.02)]
    {
        for shift in [0.0, 0.13, 0.31, 0.5, 0.77] {
            let mut mpm =
                Mpm2::new(Setup { options: with(shape, Scheme::StressLast), ..Setup::new(1.0) }).unwrap();
            let low = DVec2::new(shift, 0.4 * shift);
            let stress = SymmetricTensor { xx: -1.0, yy: -0.5, zz: -0.7, xy: 0.2, ..SymmetricTensor::ZERO };
            let particles: Vec<_> = Particle::<D2>::filling(low, low + DVec2::splat(8.0), 0.5)
                .iter()
                .map(|particle| particle.stressed(stress))
                .collect();
            mpm.body(LinearElastic::new(1.0, 0.3).unwrap(), 1.0, &particles).unwrap();
            let dt = 0.1;
            mpm.step(dt).unwrap();
            let inside = |at: DVec2| (at - low).min_element() > 3.0 && (low + 8.0 - at).min_element() > 3.0;
            for (_, particle) in mpm.particles().filter(|(_, particle)| inside(particle.position)) {
                assert!(
                    particle.velocity.length() / dt < tolerance,
                    "{shape:?} {shift}: {}",
                    particle.velocity
                );
            }
        }
    }
}

/// A block at rest on a floor slides for half a second, once gravity leans by an angle: its acceleration along the floor, and the same
/// as if it had kept its height, by the friction that the change of its momentum across the floor took.
fn slides(degrees: f64, friction: f64, is_damped: bool, shape: ShapeFunctions) -> [f64; 2] {
    let floor = plane("floor", DVec2::ZERO, DVec2::Y, Condition::frictional(friction));
    let options = Options { local_damping: 0.3, ..with(shape, Scheme::ModifiedStressLast) };
    let gravity = DVec2::new(0.0, -9.81);
    let mut mpm = Mpm2::new(Setup { gravity, walls: vec![floor], options, ..Setup::new(0.1) }).unwrap();
    let block = Particle::<D2>::filling(DVec2::ZERO, DVec2::new(0.8, 0.4), 0.05);
    mpm.body(LinearElastic::new(2e6, 0.3).unwrap(), 1000.0, &block).unwrap();
    let dt = mpm.recommended_step();
    mpm.advance(dt, (0.2 / dt) as u64).unwrap();
    mpm.set_local_damping(if is_damped { 0.3 } else { 0.0 }).unwrap();
    mpm.set_gravity(DVec2::new(degrees.to_radians().sin(), -degrees.to_radians().cos()) * 9.81).unwrap();
    // By then all of its base slides, or all of it rests.
    mpm.advance(dt, (0.5 / dt) as u64).unwrap();
    mpm.set_local_damping(0.0).unwrap();
    let (before, start) = (mpm.momentum() / mpm.mass(), mpm.time());
    mpm.advance(dt, (0.5 / dt) as u64).unwrap();
    let change = (mpm.momentum() / mpm.mass() - before) / (mpm.time() - start);
    [change.x, change.x + friction * change.y]
}

#[test]
fn a_block_slides_or_sticks_on_an_incline() {
    alone(|| {
        for shape in SHAPES {
            for (degrees, friction, acceleration) in [(30.0, 0.466, 0.94600), (45.0, 0.1, 6.2430)] {
                let [whole, level] =
                    slides(degrees, friction, false, shape).map(|found| found / acceleration - 1.0);
                // It hops a little: while it rises the floor carries more than its weight. With other shape functions than blocks
                // part of its base also sticks now and then.
                let allowed = if shape == ShapeFunctions::UniformGimp { 0.01 } else { 0.02 };
                assert!(level.abs() < allowed && whole.abs() < 0.05, "{shape:?} {degrees}: {whole} {level}");
            }
            let creep = slides(24.0, 0.466, true, shape)[0] / (9.81 * 24.0_f64.to_radians().sin());
            assert!(creep.abs() < 1e-3, "{shape:?}: {creep}");
        }
    });
}
