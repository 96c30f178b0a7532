//! Walls that move or absorb, and traction, in a tube that leaves one direction free.

use crate::sample::falling;
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, Shape, Solver, SymmetricTensor, contract_tests};
use granular_mpm::{Condition, Mpm2, Options, Particle, Setup, Wall, WallMotion};

const CELL: f64 = 0.05;
const DENSITY: f64 = 1000.0;
const YOUNG: f64 = 1e6;
const POISSON: f64 = 0.3;

/// Stiffness without sideways strain.
fn oedometric() -> f64 {
    YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
}

fn plane(name: &str, point: DVec2, normal: DVec2, condition: Condition) -> Wall<D2> {
    Wall::plane(name, point, normal, condition).unwrap()
}

/// A tube along x from zero to a lid at a length, filled with an elastic body of unit width; particles are made what they should be.
fn tube(
    options: Options,
    (length, lid): (f64, impl Fn(Wall<D2>) -> Wall<D2>),
    make: impl Fn(Particle<D2>) -> Particle<D2>,
) -> Mpm2 {
    let lid = lid(plane("lid", DVec2::new(length, 0.0), -DVec2::X, Condition::Slip));
    let walls = vec![
        lid,
        plane("end", DVec2::ZERO, DVec2::X, Condition::Slip),
        plane("low", DVec2::ZERO, DVec2::Y, Condition::Slip),
        plane("high", DVec2::new(0.0, 2.0 * CELL), -DVec2::Y, Condition::Slip),
    ];
    let mut mpm = Mpm2::new(Setup { walls, options, ..Setup::new(CELL) }).unwrap();
    let particles: Vec<_> = Particle::filling(DVec2::ZERO, DVec2::new(length, 2.0 * CELL), 0.5 * CELL)
        .into_iter()
        .map(make)
        .collect();
    mpm.body(LinearElastic::new(YOUNG, POISSON).unwrap(), DENSITY, &particles).unwrap();
    mpm
}

/// A compression wave runs into the lid; returns the amplitude that is left when what was reflected is back, over that at the start.
fn reflected(condition: Condition) -> f64 {
    let wave = (oedometric() / DENSITY).sqrt();
    let options = Options { ledger: true, ..Options::default() };
    let pulse = |particle: Particle<D2>| {
        let speed = 1e-3 * (-((particle.position.x - 2.0) / 0.5).powi(2)).exp();
        let xx = -DENSITY * wave * speed;
        let across = POISSON / (1.0 - POISSON) * xx;
        let stress = SymmetricTensor { xx, yy: across, zz: across, ..SymmetricTensor::ZERO };
        particle.moving(DVec2::new(speed, 0.0)).stressed(stress)
    };
    let mut mpm = tube(options, (3.0, |lid| Wall { condition, ..lid }), pulse);
    let start = mpm.energies().mechanical();
    let dt = mpm.recommended_step();
    mpm.advance(dt, (2.0 / wave / dt) as u64).unwrap();
    let left = mpm.energies().mechanical();
    assert!(mpm.energy_residual().unwrap().abs() < 2e-3 * start);
    let absorbed = mpm.losses().absorbed;
    assert!((absorbed + left - start).abs() < 3e-3 * start, "{absorbed} and {left} of {start}");
    (left / start).sqrt()
}

#[test]
fn a_wave_leaves_through_an_absorbing_wall_and_comes_back_from_others() {
    let compression_speed = (oedometric() / DENSITY).sqrt();
    let shear_speed = (YOUNG / (2.0 * (1.0 + POISSON)) / DENSITY).sqrt();
    let left = reflected(Condition::Absorbing { compression_speed, shear_speed });
    assert!(left < 0.03, "{left}");
    let mismatched =
        reflected(Condition::Absorbing { compression_speed: 2.0 * compression_speed, shear_speed });
    // By impedances: (2 - 1) / (2 + 1).
    assert!((mismatched - 1.0 / 3.0).abs() < 0.01, "{mismatched}");
    for condition in [Condition::Fixed, Condition::Slip] {
        let back = reflected(condition);
        assert!(back > 0.99, "{condition:?}: {back}");
    }
}

/// A piston that moves slowly by 2 %: stress everywhere is that of the strain, and its work is the energy that is stored.
#[test]
fn a_piston_compresses_a_block() {
    let options = Options { ledger: true, local_damping: 0.1, ..Options::default() };
    let motion = WallMotion::Steady { velocity: DVec2::new(-0.1, 0.0) };
    let mut mpm = tube(options, (1.0, |lid| Wall { motion: Some(motion), ..lid }), |particle| particle);
    let dt = mpm.recommended_step();
    mpm.advance(dt, (0.2 / dt).round() as u64).unwrap();
    assert!(mpm.set_moving(0, false));
    mpm.advance(dt, (0.3 / dt) as u64).unwrap();
    let strain = (1.0 - 0.1 * (0.2 / dt).round() * dt).ln();
    let expected = oedometric() * strain;
    let mean = mpm.particles().map(|(_, particle)| particle.stress.xx).sum::<f64>() / mpm.len() as f64;
    assert!((mean / expected - 1.0).abs() < 0.02, "{mean} {expected}");
    // Walls act at nodes: between two of them the last cell carries more or less than the rest.
    let mut force = 0.0;
    for _ in 0..200 {
        mpm.step(dt).unwrap();
        force += mpm.wall_forces()[0].x / (2.0 * CELL) / 200.0;
    }
    assert!((force / -expected - 1.0).abs() < 0.05, "{force} {expected}");
    let energies = mpm.energies();
    let stored = 0.5 * oedometric() * strain * strain * 2.0 * CELL;
    let [elastic, work] = [energies.elastic, mpm.work_of_walls()].map(|energy| energy / stored);
    assert!((elastic - 1.0).abs() < 0.05 && (work - 1.0).abs() < 0.02, "{elastic} {work}");
    assert!(mpm.energy_residual().unwrap().abs() < 0.01 * stored);
}

/// A pressure on the last row of particles: the strain of the oedometer, and its work in the ledger.
#[test]
fn a_pressure_compresses_a_block() {
    let options = Options { ledger: true, ..Options::default() };
    let mut mpm = tube(options, (1.0, |lid| Wall { open: true, ..lid }), |particle| particle);
    mpm.set_local_damping(0.1).unwrap();
    let pressure = 2e4;
    let area = mpm.set_traction(|_, at| at.x > 1.0 - 0.5 * CELL, DVec2::new(-pressure, 0.0)).unwrap();
    assert!((area - 2.0 * CELL).abs() < 1e-12, "{area}");
    let dt = mpm.recommended_step();
    mpm.advance(dt, (1.0 / dt) as u64).unwrap();
    let strain = -pressure / oedometric();
    for (id, particle) in mpm.particles().filter(|(_, particle)| particle.position.x < 0.75) {
        let was = (f64::from(id % 40) + 0.5) * 0.5 * CELL;
        assert!((particle.position.x / was - strain.exp()).abs() < 0.01 * strain.abs(), "{particle:?}");
        assert!((particle.stress.xx / -pressure - 1.0).abs() < 0.02, "{particle:?}");
    }
    assert!((mpm.wall_forces()[1].x / (-pressure * area) - 1.0).abs() < 1e-3);
    let stored = mpm.energies().elastic;
    assert!(mpm.energy_residual().unwrap().abs() < 0.02 * stored);
    // Taken off, the block swings back, and nothing more is put in.
    mpm.set_traction(|_, _| true, DVec2::ZERO).unwrap();
    assert!(mpm.energy_residual().unwrap().abs() < 0.02 * stored);
    mpm.advance(dt, (1.0 / dt) as u64).unwrap();
    assert!(mpm.energies().elastic < 1e-3 * stored);
    assert!(mpm.set_traction(|_, _| true, DVec2::splat(f64::NAN)).is_err());
}

/// Two blocks with a wall between them, one of them running into it.
fn parted(wall: Wall<D2>, gap: f64) -> Result<Mpm2, granular_core::SetupError> {
    let mut mpm = Mpm2::new(Setup { walls: vec![wall], ..Setup::new(0.1) })?;
    let law = LinearElastic::new(1e5, 0.2)?;
    let right = Particle::filling(DVec2::new(gap, 0.0), DVec2::new(gap + 0.4, 0.4), 0.025);
    mpm.body(law, 1000.0, &right)?;
    let left = Particle::filling(DVec2::new(-0.4, 0.0), DVec2::new(0.0, 0.4), 0.025);
    let left: Vec<_> = left.into_iter().map(|particle| particle.moving(DVec2::new(1.0, 0.0))).collect();
    mpm.body(law, 1000.0, &left)?;
    Ok(mpm)
}

#[test]
fn what_is_behind_a_wall_feels_nothing_of_what_is_before_it() {
    let (low, high) = (DVec2::new(0.0, -1.0), DVec2::new(0.2, 1.0));
    let thick = Wall::block("wall", low, high, Condition::frictional(0.3)).unwrap();
    let mut mpm = parted(thick, 0.2).unwrap();
    let dt = mpm.recommended_step();
    mpm.advance(dt, (0.1 / dt) as u64).unwrap();
    let mut speeds = [0.0_f64; 2];
    for (id, particle) in mpm.particles() {
        let speed = &mut speeds[usize::from(id >= 256)];
        *speed = speed.max(particle.velocity.length());
    }
    assert!(speeds[0] == 0.0 && speeds[1] > 0.1, "{speeds:?}");
}

#[test]
fn material_on_both_sides_of_a_thin_wall_is_refused() {
    let (from, to) = (DVec2::new(0.0, -1.0), DVec2::new(0.0, 1.0));
    let segment = Wall::new("gate", Shape::Segment { from, to }, Condition::Slip);
    let plate = Wall::block("gate", from, to + DVec2::new(0.05, 0.0), Condition::Slip).unwrap();
    for wall in [segment.clone(), plate] {
        let error = parted(wall.clone(), 0.05).err().unwrap().to_string();
        assert!(error.contains("`gate`") && error.contains("two cells thick"), "{error}");
        assert!(parted(Wall { open: true, ..wall }, 0.05).is_ok());
    }
    // One comes flying while the other is there.
    let mut mpm = Mpm2::new(Setup { walls: vec![segment], ..Setup::new(0.1) }).unwrap();
    let law = LinearElastic::new(1e5, 0.2).unwrap();
    let block = |at: f64, speed: f64| -> Vec<_> {
        let low = DVec2::new(at, 0.0);
        let block = Particle::filling(low, low + 0.4, 0.025);
        block.into_iter().map(|particle| particle.moving(DVec2::new(speed, 0.0))).collect()
    };
    mpm.body(law, 1000.0, &block(0.0, 0.0)).unwrap();
    mpm.body(law, 1000.0, &block(-0.8, 1.0)).unwrap();
    let dt = mpm.recommended_step();
    let error = mpm.advance(dt, (1.0 / dt) as u64).unwrap_err().to_string();
    assert!(error.contains("`gate`") && error.contains("two cells thick"), "{error}");
}

contract_tests!(
    between_a_piston_and_an_absorbing_wall,
    || {
        let options = Options { ledger: true, ..Options::default() };
        let motion =
            WallMotion::Oscillating { amplitude: DVec2::new(0.01, 0.0), frequency: 20.0, phase: 0.0 };
        let mut mpm = tube(options, (1.0, |lid| Wall { motion: Some(motion), ..lid }), |particle| particle);
        let absorbing = Condition::Absorbing { compression_speed: 36.7, shear_speed: 19.6 };
        mpm.set_condition(1, absorbing).unwrap();
        mpm
    },
    5e-4
);
contract_tests!(
    under_traction,
    || {
        let mut mpm = falling::<D2>(Options { ledger: true, ..Options::default() }, 1.0);
        mpm.set_traction(|_, at| at.y > 1.95, DVec2::new(300.0, -500.0)).unwrap();
        mpm
    },
    1e-3
);
