//! Hertz-Mindlin contacts: restitution and its order, duration, and energy of tangential cycles.

use crate::conservation::cases;
use crate::impact::order;
use crate::sample::Random;
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_dem::law::Kinematics;
use granular_dem::material::damping_for_restitution;
use granular_dem::{
    ContactLaw, ContactModel, Dem, Elasticity, Grain, HertzImpact, HertzMindlin, Material, MaterialLaw,
    Materials, Options, PairProperties, Setup, Tally, Tension,
};
use proptest::prelude::*;

const CUTS: [Tension; 2] = [Tension::Cut, Tension::Kept];
const GLASS: Elasticity = Elasticity { young_modulus: 7e10, poisson_ratio: 0.25 };
const RADIUS: f64 = 0.5e-3;
const DENSITY: f64 = 2650.0;

/// A normal impact of two equal grains.
#[derive(Clone, Copy)]
struct Impact {
    restitution: f64,
    tension: Tension,
    speed: f64,
    /// Steps in the duration without damping.
    steps: f64,
}

impl Impact {
    fn elastic<D: Dim>(&self) -> HertzImpact {
        HertzImpact {
            effective_modulus: GLASS.effective(&GLASS).0,
            effective_radius: 0.5 * RADIUS,
            effective_mass: 0.5 * DENSITY * D::ball_volume(RADIUS),
            speed: self.speed,
        }
    }

    fn dt<D: Dim>(&self) -> f64 {
        self.elastic::<D>().duration(0.0, Tension::Kept) / self.steps
    }

    /// The grains `gap` steps before they meet.
    fn grains<D: Dim>(&self, gap: f64) -> Dem<D> {
        let mut materials = Materials::new();
        let material = Material {
            restitution: self.restitution,
            friction: 0.0,
            normal_stiffness: 0.0,
            elasticity: Some(GLASS),
            density: DENSITY,
            ..Material::default()
        };
        let glass = materials.add(material).unwrap();
        let apart = D::Vec::along(0, RADIUS + 0.5 * gap * self.speed * self.dt::<D>());
        let towards = D::Vec::along(0, 0.5 * self.speed);
        let grains = vec![
            Grain::at(-apart, RADIUS, glass).moving(towards),
            Grain::at(apart, RADIUS, glass).moving(-towards),
        ];
        let options = Options { tension: self.tension, contact: ContactModel::Hertz, ..Options::default() };
        Dem::new(Setup { materials, grains, walls: vec![], gravity: D::Vec::ZERO, options }).unwrap()
    }

    fn measured<D: Dim>(&self, gap: f64) -> f64 {
        let mut dem = self.grains::<D>(gap);
        let zeta = damping_for_restitution(self.restitution, self.tension);
        let duration = self.elastic::<D>().duration(zeta, self.tension);
        let dt = self.dt::<D>();
        dem.advance(dt, (gap + duration / dt) as u64 + 3).unwrap();
        (dem.grain(1).velocity - dem.grain(0).velocity).component(0) / self.speed
    }

    fn root_mean_square<D: Dim>(&self) -> f64 {
        let gaps = 64;
        let square = |k: u32| {
            let gap = 1.0 + f64::from(k) * 0.618_033_988_749 % 1.0;
            (self.measured::<D>(gap) - self.restitution).powi(2)
        };
        ((0..gaps).map(square).sum::<f64>() / f64::from(gaps)).sqrt()
    }
}

fn restitution_is_of_second_order<D: Dim>() {
    let steps = [23.1, 47.3, 95.7, 193.1, 387.7, 777.9];
    for tension in CUTS {
        for restitution in [0.9, 0.75, 0.5, 0.3] {
            let error = |steps| Impact { restitution, tension, speed: 0.1, steps }.root_mean_square::<D>();
            let errors: Vec<f64> = steps.iter().map(|&steps| error(steps)).collect();
            let found = -order(&steps, &errors);
            println!("{} {tension:?} e {restitution}: errors {errors:?} order {found:.3}", D::BALL);
            assert!(found >= 1.9, "{tension:?} e {restitution}: order {found}, errors {errors:?}");
        }
    }
}

#[test]
fn restitution_of_disks_is_of_second_order() {
    restitution_is_of_second_order::<D2>();
}

#[test]
fn restitution_of_spheres_is_of_second_order() {
    restitution_is_of_second_order::<D3>();
}

#[test]
fn restitution_does_not_depend_on_the_speed() {
    for tension in CUTS {
        for restitution in [0.9, 0.5, 0.2] {
            for speed in [1e-3, 0.1, 3.0] {
                let found = Impact { restitution, tension, speed, steps: 500.0 }.measured::<D3>(1.4);
                assert!((found - restitution).abs() < 1e-4, "{tension:?} {restitution} {speed}: {found}");
            }
        }
    }
}

#[test]
fn without_damping_overlap_force_and_duration_follow_the_closed_form() {
    for tension in CUTS {
        let impact = Impact { restitution: 1.0, tension, speed: 0.5, steps: 1000.0 };
        let (mut dem, dt) = (impact.grains::<D3>(1.5), impact.dt::<D3>());
        let (mut loaded, mut deepest, mut strongest) = (0_u32, 0.0_f64, 0.0_f64);
        for _ in 0..1100 {
            dem.step(dt).unwrap();
            dem.visit_contacts(&mut |contact| {
                loaded += 1;
                deepest = deepest.max(contact.overlap);
                strongest = strongest.max(contact.normal_force);
            });
        }
        let expected = impact.elastic::<D3>();
        assert!((deepest / expected.largest_overlap() - 1.0).abs() < 1e-5);
        assert!((strongest / expected.largest_force() - 1.0).abs() < 2e-5);
        assert!((f64::from(loaded) - 1000.0).abs() <= 2.0, "{loaded}");
    }
}

/// Work done on a contact that is driven along the normal and across it, the energy left in it
/// and its losses.
fn driven<D: Dim>(properties: &PairProperties, stride: f64, seed: u64) -> [f64; 3] {
    let law = <HertzMindlin as MaterialLaw<D>>::between(properties, Tension::Cut);
    let mut random = Random::new(seed);
    let (overlap, dt) = (1e-6, 1e-7);
    let normal = D::Vec::along(0, 1.0);
    let zero = <D::Spin as Linear>::ZERO;
    let mut kinematics = Kinematics::<D> {
        normal,
        gap: 0.0,
        overlap,
        presence: 1.0,
        approach: 0.0,
        start_approach: 0.0,
        slip: zero,
        roll: zero,
        start_slip: zero,
        start_roll: zero,
        twist: 0.0,
        twisting: 0.0,
        start_twisting: 0.0,
        effective_mass: 1e-6,
        effective_radius: 0.25e-3,
        dt,
        last_dt: dt,
    };
    let (mut memory, mut tally) =
        (<HertzMindlin as ContactLaw<D>>::Memory::default(), Tally::<true>::default());
    let before = ContactLaw::<D>::at_rest(&law, &kinematics, memory).1;
    let mut path = Vec::new();
    for _ in 0..12 {
        let across = D::cross(normal, random.vector::<D>(stride * overlap / dt));
        let along = (random.unit() - 0.5) * 0.1 * stride * overlap / dt;
        path.extend(std::iter::repeat_n((across, along), 1 + (random.unit() * 60.0) as usize));
    }
    let back: Vec<_> = path.iter().rev().map(|&(across, along)| (-across, -along)).collect();
    let mut work = 0.0;
    let mut last = kinematics.slip;
    for (across, along) in path.into_iter().chain(back) {
        kinematics.overlap += 0.5 * along * dt;
        kinematics.approach = along;
        (kinematics.start_slip, kinematics.slip) = ((last + across) * 0.5, across);
        last = across;
        let load = law.load(&kinematics, &mut memory, &mut tally);
        work += (load.normal * along - load.tangential.dot(across)) * dt;
        kinematics.overlap += 0.5 * along * dt;
    }
    (kinematics.slip, kinematics.approach) = (zero, 0.0);
    let stored = ContactLaw::<D>::at_rest(&law, &kinematics, memory).1 - before;
    [work, stored, crate::energy::lost(&tally)]
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn a_cycle_along_and_across_never_gives_energy(
        seed in any::<u64>(), friction in 0.1..2.0, damping_ratio in 0.0..1.0, stride in 0.001..0.02,
    ) {
        let glass = Material {
            friction, damping_ratio, restitution: 1.0, elasticity: Some(GLASS), ..Material::default()
        };
        let properties = PairProperties::mix(&glass, &glass);
        for [work, stored, lost] in [driven::<D2>(&properties, stride, seed), driven::<D3>(&properties, stride, seed)] {
            let scale = properties.effective_modulus * (0.25e-3_f64).sqrt() * 1e-6_f64.powf(2.5);
            prop_assert!(work >= -1e-3 * scale, "{work:e} of {scale:e}");
            prop_assert!(lost > 0.0, "{lost:e}");
            let missing = work - stored - lost;
            prop_assert!(missing.abs() < 0.05 * lost + 1e-3 * scale, "{missing:e} of {lost:e} and {scale:e}");
        }
    }
}
