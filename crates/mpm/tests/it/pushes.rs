//! Velocities given at once: energies and momenta are those of the closed form, and the ledger takes them as put in.

use crate::sample::{falling, tumbling};
use granular_core::glam::DVec2;
use granular_core::matrix::Matrix;
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_mpm::{BodyId, Mpm, Options, Push, PushProfile, Strength, VelocityField};

fn everything<V>(_: BodyId, _: V) -> bool {
    true
}

/// Momentum and kinetic energy of the particles of a region, by their definitions.
fn motion<D: Dim>(mpm: &Mpm<D>, region: impl Fn(D::Vec) -> bool) -> (D::Vec, f64) {
    mpm.particles().filter(|(_, particle)| region(particle.position)).fold(
        (D::Vec::ZERO, 0.0),
        |(momentum, energy), (_, particle)| {
            let mass = 1000.0 * particle.volume;
            let square = particle.velocity.length_squared();
            (momentum + particle.velocity * mass, energy + 0.5 * mass * square)
        },
    )
}

fn with_ledger() -> Options {
    Options { ledger: true, ..Options::default() }
}

/// A square block of side 1 m at rest gets a shear about its middle: the moment of inertia gives its energy.
#[test]
fn a_gradient_has_its_closed_form() {
    let mut mpm = tumbling::<D2>(with_ledger(), 1.0);
    mpm.set_velocity(everything, |_| DVec2::ZERO).unwrap();
    let (rate, count) = (3.0, 20.0);
    let gradient = Matrix::<D2>::from_fn(|row, column| if (row, column) == (0, 1) { rate } else { 0.0 });
    let field = VelocityField { velocity: DVec2::new(0.0, 0.5), gradient, about: DVec2::splat(0.5) };
    let pushed = mpm.add_velocity(everything, |at| field.at(at)).unwrap();
    // The mean square of the distances of `count` rows of particles from their middle.
    let square = (1.0 - 1.0 / (count * count)) / 12.0;
    let expected = 0.5 * 1000.0 * (rate * rate * square + 0.25);
    assert!((pushed.energy / expected - 1.0).abs() < 1e-12, "{}", pushed.energy);
    assert!((pushed.momentum - DVec2::new(0.0, 500.0)).length() < 1e-9);
    assert!((mpm.energies().translational() / expected - 1.0).abs() < 1e-12);
    assert!((pushed.speed - DVec2::new(rate * 0.475, 0.5).length()).abs() < 1e-12);
}

/// Only the half that is meant changes, by what is reported, in plane and space.
fn keeps_to_its_region<D: Dim>(side: f64) {
    let mut mpm = tumbling::<D>(with_ledger(), side);
    let lower = |at: D::Vec| at.component(D::UP) < 0.5 * side;
    let (within, without) = (motion(&mpm, lower), motion(&mpm, |at| !lower(at)));
    let field = VelocityField::<D>::uniform(D::Vec::along(0, 0.7));
    let pushed = mpm.add_velocity(|_, at| lower(at), |at| field.at(at)).unwrap();
    let after = motion(&mpm, lower);
    assert_eq!(motion(&mpm, |at| !lower(at)), without);
    assert_eq!(pushed.particles * 2, mpm.len());
    assert!((after.1 - within.1 - pushed.energy).abs() < 1e-12 * after.1);
    assert!((after.0 - within.0 - pushed.momentum).length() < 1e-12 * after.0.length());
    assert!(mpm.energy_residual().unwrap().abs() < 1e-12 * after.1);
    let stopped = mpm.set_velocity(everything, |_| D::Vec::ZERO).unwrap();
    assert!((stopped.energy + after.1 + without.1).abs() < 1e-12 * after.1);
    assert_eq!(mpm.momentum(), D::Vec::ZERO);
}

#[test]
fn a_push_keeps_to_its_region() {
    keeps_to_its_region::<D2>(1.0);
    keeps_to_its_region::<D3>(0.4);
}

#[test]
fn an_energy_is_given_to_round_off_whatever_moves_already() {
    for profile in [PushProfile::Uniform, PushProfile::Gradient] {
        for direction in [DVec2::X, DVec2::new(-2.0, 0.5)] {
            let mut mpm = tumbling::<D2>(with_ledger(), 1.0);
            let before = mpm.energies().translational();
            let push = Push { direction, strength: Strength::Energy(40.0), profile };
            let pushed = mpm.apply_push(&push, everything).unwrap();
            let gained = mpm.energies().translational() - before;
            assert!((gained - 40.0).abs() < 1e-10 && (pushed.energy - 40.0).abs() < 1e-10, "{gained}");
            assert!(pushed.momentum.dot(direction) > 0.0);
            assert!(mpm.energy_residual().unwrap().abs() < 1e-10);
        }
    }
}

/// The lowest particles get the speed, the highest none.
#[test]
fn a_gradient_is_largest_at_the_bottom() {
    let mut mpm = tumbling::<D2>(Options::default(), 1.0);
    mpm.set_velocity(everything, |_| DVec2::ZERO).unwrap();
    let push = Push { direction: DVec2::X, strength: Strength::Speed(2.0), profile: PushProfile::Gradient };
    assert_eq!(mpm.apply_push(&push, everything).unwrap().speed, 2.0);
    for (_, particle) in mpm.particles() {
        let expected = 2.0 * (0.975 - particle.position.y) / 0.95;
        assert!((particle.velocity - DVec2::new(expected, 0.0)).length() < 1e-12);
    }
}

/// A push at a pause neither breaks the ledger nor the limit on steps.
#[test]
fn a_push_at_a_pause_is_work_from_outside() {
    let mut mpm = falling::<D2>(with_ledger(), 1.0);
    let dt = 0.5 * mpm.recommended_step();
    mpm.advance(dt, 100).unwrap();
    let before = mpm.energy_residual().unwrap();
    let limit = mpm.stable_step();
    let pushed = mpm.add_velocity(everything, |_| DVec2::new(5.0, 0.0)).unwrap();
    assert!((mpm.energy_residual().unwrap() - before).abs() < 1e-12 * pushed.energy);
    assert!(mpm.stable_step() < limit);
    mpm.advance(dt, 100).unwrap();
}

#[test]
fn what_is_not_finite_is_refused_and_changes_nothing() {
    let mut mpm = tumbling::<D2>(Options::default(), 1.0);
    let before = mpm.momentum();
    let error = mpm.add_velocity(everything, |at| at / 0.0).unwrap_err();
    assert!(error.to_string().contains("velocity"), "{error}");
    let push = Push { direction: DVec2::ZERO, strength: Strength::Speed(1.0), profile: PushProfile::Uniform };
    assert!(mpm.apply_push(&push, everything).is_err());
    assert_eq!(mpm.momentum(), before);
}
