//! Steps at the edge of stability, and particles that go far.

use crate::sample::{SCHEMES, SHAPES, alone, falling};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::random::Chance;
use granular_core::{D2, Solver, StepError};
use granular_mpm::{Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, VelocityUpdate};

/// Growth of the energy of a body that trembles at random, with steps of a multiple of the longest stable one.
fn growth(options: Options, (share, side): (f64, f64), seed: u64) -> f64 {
    let mut random = Chance::new(seed);
    let mut mpm = Mpm2::new(Setup { options, ..Setup::new(1.0) }).unwrap();
    mpm.allow_any_step();
    let mut place = || random.uniform() - 0.5;
    let low = DVec2::new(place(), place());
    let mut particles = Particle::<D2>::filling(low, low + DVec2::splat(side), 0.25);
    for particle in &mut particles {
        particle.velocity = DVec2::new(place(), place()) * 1e-6;
    }
    mpm.body(LinearElastic::new(1.0, 0.45).unwrap(), 1.0, &particles).unwrap();
    let start = mpm.energies().mechanical();
    let dt = share * mpm.stable_step();
    if mpm.advance(dt, 1000).is_err() { f64::INFINITY } else { mpm.energies().mechanical() / start }
}

#[test]
fn steps_are_stable_up_to_the_limit_and_not_far_beyond() {
    alone(|| {
        let flip = SHAPES.map(|shape| (shape, VelocityUpdate::default()));
        let affine = [SHAPES[1], SHAPES[2]].map(|shape| (shape, VelocityUpdate::Apic));
        for (shape, velocity_update) in flip.into_iter().chain(affine) {
            for scheme in SCHEMES {
                let options = Options { shape, scheme, velocity_update, ..Options::default() };
                let largest =
                    |share| (1..4).map(|seed| growth(options, (share, 6.0), seed)).fold(0.0, f64::max);
                let (within, beyond) = (largest(0.98), largest(1.75));
                println!("{options:?}: {within:.2} {beyond:.1e}");
                assert!(within < 1.2 && beyond > 100.0, "{options:?}: {within} {beyond}");
            }
        }
    });
}

/// Stresses that come last take energy out of what trembles, those that come first put some in \[Bardenhagen2002\].
#[test]
fn energy_drifts_as_the_scheme_says() {
    alone(|| {
        for shape in SHAPES {
            let [last, first] = [Scheme::StressLast, Scheme::StressFirst].map(|scheme| {
                let options = Options { shape, scheme, ..Options::default() };
                let share = if scheme == Scheme::StressFirst { 0.25 } else { 0.75 };
                growth(options, (share, 10.0), 1)
            });
            assert!(last < 0.97 && first > 1.0 && first < 1.05, "{shape:?}: {last} {first}");
        }
    });
}

#[test]
fn moments_of_velocities_take_memory_where_velocities_are_affine() {
    let each = |velocity_update| {
        let options = Options { velocity_update, ..Options::default() };
        falling::<D2>(options, 1.0).memory()
    };
    let (flip, affine) = (each(VelocityUpdate::default()), each(VelocityUpdate::Apic));
    assert_eq!(affine.bytes_per_item, flip.bytes_per_item + 2 * size_of::<DVec2>());
    let says =
        |memory: &granular_core::Memory| memory.left_out.iter().any(|what| what.contains("not affine"));
    assert!(says(&flip) && !says(&affine));
}

#[test]
fn a_step_beyond_stability_is_refused_with_the_limit() {
    let mut mpm = falling::<D2>(Options::default(), 1.0);
    let limit = mpm.stable_step();
    mpm.step(0.9 * limit).unwrap();
    let Err(StepError::Step { why, .. }) = mpm.step(1.5 * limit) else { panic!("it was taken") };
    assert!(why.contains("is stable") && why.contains("crosses a cell"), "{why}");
}

#[test]
fn a_particle_that_is_thrown_far_away_is_kept() {
    for shape in [ShapeFunctions::Linear, ShapeFunctions::UniformGimp] {
        let options = Options { shape, ..Options::default() };
        let mut mpm = Mpm2::new(Setup { options, ..Setup::new(0.1) }).unwrap();
        let law = LinearElastic::new(1e4, 0.3).unwrap();
        mpm.body(law, 1000.0, &Particle::filling(DVec2::ZERO, DVec2::splat(0.4), 0.05)).unwrap();
        let velocity = DVec2::new(-3e4, 1e3);
        let stone = Particle::at(DVec2::splat(5.0), 0.0025).moving(velocity);
        mpm.body(law, 1000.0, &[stone]).unwrap();
        let dt = 2e-6;
        mpm.advance(dt, 2000).unwrap();
        let found = mpm.particle(64);
        assert!((found.position - stone.position - velocity * 0.004).length() < 1e-9);
        assert_eq!(mpm.len(), 65);
        assert!(mpm.memory().bytes < 1 << 20, "{} bytes", mpm.memory().bytes);
    }
}
