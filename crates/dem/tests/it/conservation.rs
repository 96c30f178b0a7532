//! Momentum and angular momentum in free collisions.

use crate::sample::{Lattice, Random, free};
use granular_core::{D2, D3, Dim, Linear, Solver};
use granular_dem::{ContactModel, Dem, Elasticity, LeverArm, Material, Materials, Options, Tension};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// The same cases each time, and no files: what fails here fails everywhere.
pub(crate) fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: count,
        rng_seed: RngSeed::Fixed(2014),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) seed: u64,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    pub(crate) rolling: f64,
    pub(crate) twisting: f64,
    pub(crate) tension: Tension,
    pub(crate) contact: ContactModel,
}

impl Case {
    pub(crate) fn material(&self) -> Material {
        Material {
            restitution: self.restitution,
            friction: self.friction,
            rolling_friction: self.rolling,
            twisting_friction: self.twisting,
            elasticity: Some(Elasticity { young_modulus: 5e10, poisson_ratio: 0.25 }),
            ..Material::default()
        }
    }
}

pub(crate) fn any_case() -> impl Strategy<Value = Case> {
    let tension = prop_oneof![Just(Tension::Cut), Just(Tension::Kept)];
    let contact = prop_oneof![Just(ContactModel::Linear), Just(ContactModel::Hertz)];
    let resistance = || prop_oneof![Just(0.0), 0.01..0.5];
    let choices = (tension, contact);
    (any::<u64>(), 0.1..=1.0, 0.05..2.0, resistance(), resistance(), choices).prop_map(
        |(seed, restitution, friction, rolling, twisting, (tension, contact))| Case {
            seed,
            restitution,
            friction,
            rolling,
            twisting,
            tension,
            contact,
        },
    )
}

/// Spheres are far lighter than disks per metre, and take shorter steps: they move faster, so that
/// as many steps see as many collisions.
fn haste<D: Dim>() -> f64 {
    if D::N == 2 { 1.0 } else { 10.0 }
}

/// A cloud of turning grains of different sizes that falls together.
fn cloud<D: Dim>(case: Case, lever_arm: LeverArm) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(case.material()).unwrap();
    let lattice = Lattice {
        side: 3,
        jitter: 50e-6,
        radii: (0.25e-3, 0.45e-3),
        speed: 0.5 * haste::<D>(),
        seed: case.seed,
        ..Lattice::default()
    };
    let mut random = Random::new(!case.seed);
    let mut grains = lattice.grains::<D>(&[glass]);
    let middle = (0..D::N)
        .fold(D::Vec::ZERO, |sum, axis| sum + <D::Vec as granular_core::Vector>::along(axis, 1.5e-3));
    for grain in &mut grains {
        grain.velocity += (middle - grain.position) * (1000.0 * haste::<D>());
        grain.spin = random.spin::<D>(1000.0 * haste::<D>());
    }
    free(
        materials,
        grains,
        Options { lever_arm, tension: case.tension, contact: case.contact, ..Options::default() },
    )
}

/// Change of momentum and of angular momentum over the sums of their sizes, after collisions.
fn changes<D: Dim>(case: Case, lever_arm: LeverArm) -> (f64, f64) {
    let mut dem = cloud::<D>(case, lever_arm);
    let density = case.material().density;
    let (mut linear, mut angular) = (0.0, 0.0);
    for (_, grain) in dem.grains() {
        let mass = density * D::ball_volume(grain.radius);
        linear += mass * grain.velocity.length();
        angular += mass * grain.velocity.length() * grain.position.length()
            + D::BALL_INERTIA * mass * grain.radius.powi(2) * grain.spin.length();
    }
    let (momentum, moment) = (dem.momentum(), dem.angular_momentum());
    let before = dem.energies().translational();
    let dt = dem.recommended_step();
    dem.advance(dt, (4e-4 / haste::<D>() / dt) as u64).unwrap();
    assert!((dem.energies().translational() / before - 1.0).abs() > 0.01, "nothing collided");
    ((dem.momentum() - momentum).length() / linear, (dem.angular_momentum() - moment).length() / angular)
}

fn keeps_both<D: Dim>(case: Case) -> Result<(), TestCaseError> {
    let (linear, angular) = changes::<D>(case, LeverArm::Exact);
    prop_assert!(linear < 1e-12 && angular < 1e-12, "{} {linear:e} {angular:e}", D::BALL);
    Ok(())
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn exact_arms_keep_momentum_and_angular_momentum(case in any_case()) {
        keeps_both::<D2>(case)?;
        keeps_both::<D3>(case)?;
    }

    #[test]
    fn arms_of_one_radius_keep_momentum_only(case in any_case()) {
        for (linear, angular) in [changes::<D2>(case, LeverArm::Radius), changes::<D3>(case, LeverArm::Radius)] {
            prop_assert!(linear < 1e-12, "{linear:e}");
            prop_assert!(angular > 1e-7 && angular < 1e-2, "{angular:e}");
        }
    }
}
