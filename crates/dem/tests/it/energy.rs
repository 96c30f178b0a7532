//! Energy is never created, and the ledger accounts for all of it.

use crate::conservation::{Case, any_case, cases};
use crate::sample::{Lattice, Random, down};
use granular_core::glam::DVec2;
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_dem::law::Kinematics;
use granular_dem::{
    ContactLaw, ContactModel, Dem, Dem2, Elasticity, Grain, LinearFrictional, LinearRolling, Material,
    MaterialLaw, Materials, Options, PairProperties, Setup, Tally, Tension, Wall,
};
use proptest::prelude::*;

/// A box of grains that collide, at a share of the recommended step.
fn soup<D: Dim>(case: Case, share: f64) -> (Dem<D>, f64) {
    let mut materials = Materials::new();
    let glass = materials.add(case.material()).unwrap();
    let lattice = Lattice {
        side: 5,
        jitter: 30e-6,
        radii: (0.38e-3, 0.45e-3),
        speed: if D::N == 2 { 1.0 } else { 20.0 },
        seed: case.seed,
        ..Lattice::default()
    };
    let (mut grains, walls) = (lattice.grains::<D>(&[glass]), lattice.walls::<D>(glass));
    let mut random = Random::new(!case.seed);
    grains
        .iter_mut()
        .for_each(|grain| grain.spin = random.spin::<D>(if case.friction > 0.0 { 1000.0 } else { 0.0 }));
    let options =
        Options { ledger: true, tension: case.tension, contact: case.contact, ..Options::default() };
    let setup = Setup { materials, grains, walls, gravity: down::<D>(9.81), options };
    let dem = Dem::<D>::new(setup).unwrap();
    let dt = dem.recommended_step() * share;
    (dem, dt)
}

/// Largest residual of the ledger and largest gain of mechanical energy over that at the start,
/// looked for `looks` times in `time` \[s\].
fn books<D: Dim>(case: Case, share: f64, time: f64, looks: u64) -> (f64, f64) {
    let (mut dem, dt) = soup::<D>(case, share);
    let start = dem.energies().mechanical();
    let (mut residual, mut gain) = (0.0_f64, 0.0_f64);
    for _ in 0..looks {
        dem.advance(dt, (time / dt / looks as f64) as u64).unwrap();
        residual = residual.max(dem.energy_residual().unwrap().abs() / start);
        gain = gain.max((dem.energies().mechanical() - start) / start);
    }
    let losses = dem.losses();
    let parts = [losses.sliding, losses.sliding_at_walls, losses.tangential_damping, losses.rolling];
    // The normal dashpot gives energy back where the cut replaces it by the spring's return.
    assert!(parts.iter().all(|&part| part >= -1e-3 * start), "{losses:?}");
    assert!(losses.normal_damping >= -1e-3 * start, "{losses:?}");
    (residual, gain)
}

proptest! {
    #![proptest_config(cases(12))]

    #[test]
    fn energy_is_never_created_and_all_of_it_is_accounted_for(case in any_case()) {
        for (residual, gain) in [books::<D2>(case, 1.0, 2e-3, 20), books::<D3>(case, 1.0, 1e-4, 20)] {
            prop_assert!(residual < 0.02, "residual {residual:e}");
            prop_assert!(gain < 0.005, "gain {gain:e}");
        }
    }
}

/// Some damping, and neither friction nor resistance.
pub(crate) const QUIET: Case = Case {
    seed: 0,
    restitution: 0.7,
    friction: 0.0,
    rolling: 0.0,
    twisting: 0.0,
    tension: Tension::Cut,
    contact: ContactModel::Linear,
};

#[test]
fn the_residual_falls_with_the_step() {
    for tension in [Tension::Cut, Tension::Kept] {
        // With the square of the step. Where friction begins and ends to slide the books are coarser.
        for (friction, least, contact) in [
            (0.0, 1.9, ContactModel::Linear),
            (0.1, 1.3, ContactModel::Linear),
            (0.5, 1.2, ContactModel::Linear),
            (0.0, 1.9, ContactModel::Hertz),
            (0.1, 1.3, ContactModel::Hertz),
            (0.5, 1.2, ContactModel::Hertz),
        ] {
            // The mean over samples: a single residual may pass through zero.
            let mean = |share: f64| {
                let one = |seed| {
                    let case = Case { seed, friction, tension, contact, ..QUIET };
                    books::<D2>(case, share, 1.5e-3, 10).0
                };
                (0..6).map(one).sum::<f64>() / 6.0
            };
            let (coarse, fine) = (mean(1.0), mean(0.0625));
            let order = (coarse / fine).ln() / 16.0_f64.ln();
            println!("{contact:?} {tension:?} friction {friction}: {coarse:.2e} {fine:.2e} order {order:.2}");
            assert!(coarse < 1e-3 && fine < 2e-5, "{tension:?} {friction}: {coarse:e} {fine:e}");
            assert!(order > least, "{tension:?} {friction}: order {order}");
        }
    }
}

/// Work that a contact law takes in, and what is left of it.
#[derive(Debug, Default)]
struct Cycle {
    work: f64,
    stored: f64,
    lost: f64,
    scale: f64,
}

fn properties(friction: f64, damping_ratio: f64) -> PairProperties {
    PairProperties {
        normal_stiffness: 1e6,
        tangential_stiffness: 4e5,
        restitution: 0.8,
        damping_ratio,
        normal_damping: None,
        tangential_damping: None,
        friction,
        rolling_friction: 0.2,
        twisting_friction: 0.2,
        effective_modulus: 1e9,
        effective_shear_modulus: 3e8,
    }
}

/// Drives a contact tangentially at rest along the normal, with slips of up to `stride` times
/// the slip at which it slides.
fn drive<D: Dim, L: ContactLaw<D>>(law: L, friction: f64, stride: f64, seed: u64) -> Cycle {
    let mut random = Random::new(seed);
    let (overlap, dt) = (1e-5, 1e-6);
    let hold = friction * 1e6 * overlap / 4e5;
    let mut memory = L::Memory::default();
    let mut tally = Tally::<true>::default();
    let mut cycle = Cycle { scale: friction * 1e6 * overlap * hold, ..Cycle::default() };
    let normal = D::Vec::along(0, 1.0);
    let mut kinematics = Kinematics::<D> {
        normal,
        gap: 0.0,
        overlap,
        presence: 1.0,
        approach: 0.0,
        start_approach: 0.0,
        slip: <D::Spin as Linear>::ZERO,
        roll: <D::Spin as Linear>::ZERO,
        start_slip: <D::Spin as Linear>::ZERO,
        start_roll: <D::Spin as Linear>::ZERO,
        twist: 0.0,
        twisting: 0.0,
        start_twisting: 0.0,
        effective_mass: 1e-3,
        effective_radius: 1e-3,
        dt,
        last_dt: dt,
    };
    let before = law.at_rest(&kinematics, memory).1;
    // Back and forth: random speeds, each held for some steps, returning in the end.
    let mut path = Vec::new();
    for _ in 0..12 {
        let rate = D::cross(normal, random.vector::<D>(stride * hold / dt));
        path.extend(std::iter::repeat_n(rate, 1 + (random.unit() * 6.0) as usize));
    }
    let back: Vec<_> = path.iter().map(|&rate| -rate).collect();
    for rate in path.into_iter().chain(back) {
        // The rate between two steps is the mean of theirs.
        kinematics.start_slip = (kinematics.slip + rate) * 0.5;
        kinematics.slip = rate;
        kinematics.start_roll = kinematics.start_slip * (1.0 / kinematics.effective_radius);
        kinematics.roll = rate * (1.0 / kinematics.effective_radius);
        let load = law.load(&kinematics, &mut memory, &mut tally);
        cycle.work -= (load.tangential.dot(kinematics.slip) + load.rolling.dot(kinematics.roll)) * dt;
    }
    kinematics.slip = <D::Spin as Linear>::ZERO;
    kinematics.roll = <D::Spin as Linear>::ZERO;
    cycle.stored = law.at_rest(&kinematics, memory).1 - before;
    cycle.lost = lost(&tally);
    cycle
}

pub(crate) fn lost(tally: &Tally<true>) -> f64 {
    // The tally prints what it holds; its sums are not public.
    let text = format!("{tally:?}");
    let number = |part: &str| {
        let rest = part.split_once(": ")?.1;
        rest.trim_end_matches([' ', '}', ',']).parse::<f64>().ok()
    };
    text.split(", ").filter_map(|part| number(part.trim_start_matches("Tally { losses: Losses { "))).sum()
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn a_tangential_cycle_never_gives_energy(
        seed in any::<u64>(), friction in 0.05..1.0, damping in 0.0..1.0, stride in 0.02..0.5,
    ) {
        let properties = properties(friction, damping);
        let sliding = <LinearFrictional as MaterialLaw<D2>>::between(&properties, Tension::Cut);
        let rolling = <LinearRolling as MaterialLaw<D3>>::between(&properties, Tension::Cut);
        for cycle in [
            drive::<D2, _>(sliding, friction, stride, seed),
            drive::<D3, _>(sliding, friction, stride, seed),
            drive::<D2, _>(rolling, friction, stride, seed),
            drive::<D3, _>(rolling, friction, stride, seed),
        ] {
            prop_assert!(cycle.work >= -1e-9 * cycle.scale, "{cycle:?}");
            prop_assert!(cycle.work - cycle.stored >= -1e-9 * cycle.scale, "{cycle:?}");
        }
    }
}

#[test]
fn a_small_cycle_is_elastic_and_a_large_one_pays_for_its_sliding() {
    let elastic = properties(1.0, 0.0);
    let law = <LinearFrictional as MaterialLaw<D2>>::between(&elastic, Tension::Cut);
    let cycle = drive::<D2, _>(law, 1.0, 0.005, 1);
    assert!(cycle.work.abs() < 1e-12 * cycle.scale && cycle.lost.abs() < 1e-12 * cycle.scale, "{cycle:?}");
    let cycle = drive::<D2, _>(law, 1.0, 0.3, 1);
    assert!(cycle.work > cycle.scale, "{cycle:?}");
    // What went in is stored or lost; the rest is the error of the scheme.
    let rest = cycle.work - cycle.stored - cycle.lost;
    assert!(rest.abs() < 0.05 * cycle.work, "{rest:e} of {cycle:?}");
}

/// Energy missing after a disk has hit a floor, over its energy before, mean over moments of the impact within a step.
fn missing_after_impact(glass: Material, contact: ContactModel, tension: Tension, per_contact: f64) -> f64 {
    let moments = 40;
    let missing = |moment: i32| {
        let mut materials = Materials::new();
        let glass = materials.add(glass).unwrap();
        let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap();
        // At 45 degrees: first it slides, then it may stick.
        let contact_time = if contact == ContactModel::Linear { 0.113e-3 } else { 1.43e-3 };
        let (radius, speed, dt) = (0.5e-3, 0.1, contact_time / per_contact);
        let height = radius + speed * dt * (2.0 + (f64::from(moment) + 0.5) / f64::from(moments));
        let disk = Grain::at(DVec2::new(0.0, height), radius, glass).moving(DVec2::new(speed, -speed));
        let options = Options { ledger: true, contact, tension, ..Options::default() };
        let (grains, walls) = (vec![disk], vec![floor]);
        let mut dem = Dem2::new(Setup { materials, grains, walls, gravity: DVec2::ZERO, options }).unwrap();
        let start = dem.energies().mechanical();
        dem.advance(dt, (4.0 * per_contact) as u64).unwrap();
        assert!(dem.grain(0).velocity.y > 0.0 && dem.energies().contact == 0.0);
        dem.energy_residual().unwrap() / start
    };
    (0..moments).map(missing).sum::<f64>() / f64::from(moments)
}

#[test]
fn the_books_of_an_impact_close() {
    for tension in [Tension::Cut, Tension::Kept] {
        for (restitution, friction) in
            [(1.0, 0.2), (0.75, 0.0), (0.75, 0.2), (0.75, 0.53), (0.3, 0.0), (0.3, 0.53)]
        {
            let glass = Material {
                restitution,
                friction,
                normal_stiffness: 1.6e6,
                density: 2650.0,
                ..Material::default()
            };
            let missing = |steps| missing_after_impact(glass, ContactModel::Linear, tension, steps).abs();
            let (coarse, fine) = (missing(25.0), missing(50.0));
            // A tangential dashpot that still acts when it slips or is cut leaves most.
            let allowed = if friction > 0.5 { 2.5e-3 } else { 3e-4 };
            assert!(
                coarse < allowed && fine < allowed / 3.0,
                "{tension:?} {restitution} {friction}: {coarse:e} {fine:e}"
            );
            let elasticity = Some(Elasticity { young_modulus: 1e8, poisson_ratio: 0.25 });
            let missing =
                missing_after_impact(Material { elasticity, ..glass }, ContactModel::Hertz, tension, 50.0);
            assert!(missing.abs() < 1e-3, "{tension:?} {restitution} {friction}, Hertz: {missing:e}");
        }
    }
}
