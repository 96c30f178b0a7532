//! Bodies in contact.

use crate::sample::{SCHEMES, alone};
use granular_constitutive::LinearElastic;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Solver, contract_tests};
use granular_mpm::{BodyId, Condition, Contact, Mpm2, Mpm3, Options, Particle, Scheme, Setup, Wall};

const SLIPPERY: Contact = Contact { friction: 0.0 };

/// Two disks that fly at one another along a diagonal \[Sulsky1994\].
fn disks(options: Options, contact: Contact, cell: f64) -> (Mpm2, [BodyId; 2]) {
    let mut mpm = Mpm2::new(Setup { options, ..Setup::new(cell) }).unwrap();
    let law = LinearElastic::new(1000.0, 0.3).unwrap();
    let bodies = [(0.2, 0.1), (0.8, -0.1)].map(|(centre, velocity)| {
        let (centre, reach) = (DVec2::splat(centre), DVec2::splat(0.2));
        let inside = |at: DVec2| (at - centre).length() < 0.2;
        let disk: Vec<_> = Particle::<D2>::filling_part(centre - reach, centre + reach, 0.25 * cell, inside)
            .iter()
            .map(|particle| particle.moving(DVec2::splat(velocity)))
            .collect();
        mpm.body(law, 1000.0, &disk).unwrap()
    });
    mpm.contact(bodies[0], bodies[1], contact).unwrap();
    (mpm, bodies)
}

/// They meet when their outlines do, not a cell before, and keep their energy within 2 % where a cell is an eighth of their radius.
/// In cells twice as large 5 % are lost: rims stop one another node by node.
#[test]
fn two_disks_bounce_and_separate() {
    alone(|| {
        let (mut mpm, [first, second]) = disks(Options::default(), SLIPPERY, 0.025);
        let start = mpm.energies().translational();
        let mut touches = Vec::new();
        while mpm.time() < 3.2 {
            mpm.advance(5e-3, 2).unwrap();
            let force = mpm.contact_force(first, second).unwrap();
            assert_eq!(mpm.contact_force(second, first).unwrap(), -force);
            if force.length() > 0.0 {
                assert!(force.x > 0.0 && force.y > 0.0, "{force}");
                touches.push(mpm.time());
            }
            assert!(mpm.momentum().length() < 1e-12);
        }
        let (from, to) = (touches[0], touches[touches.len() - 1]);
        assert!((from - 1.586).abs() < 0.02, "they meet at {from} s");
        assert!(to < 2.8, "they part at {to} s");
        let kept = mpm.energies().mechanical() / start;
        assert!((kept - 1.0).abs() < 0.02, "{kept}");
        assert!(mpm.energies().translational() > 0.8 * start);
    });
}

/// Momentum is kept to round-off with friction, by every scheme, also of a body that hits at an angle and turns.
#[test]
fn momentum_is_kept_to_round_off() {
    alone(|| {
        for scheme in SCHEMES {
            let options = Options { scheme, ledger: true, ..Options::default() };
            let (mut mpm, [first, second]) = disks(options, Contact { friction: 0.5 }, 0.05);
            mpm.add_velocity(|body, _| body == first, |_| DVec2::new(1.0, 0.9)).unwrap();
            let before = mpm.momentum();
            let dt = 0.7 * mpm.stable_step();
            let mut has_met = false;
            while mpm.time() < 0.6 {
                mpm.advance(dt, 10).unwrap();
                has_met |= mpm.contact_force(first, second).unwrap().length() > 0.0;
                assert!((mpm.momentum() - before).length() < 1e-12 * before.length(), "{scheme:?}");
            }
            let losses = mpm.losses();
            assert!(has_met && losses.contact_friction > 0.0 && losses.contact_stopping > 0.0, "{scheme:?}");
        }
    });
}

/// A block on a deformable bed, which is held at its base; gravity leans by an angle once it rests. Returns its acceleration along the bed
/// as if it had kept its height: it hops, and the change of its momentum across the bed took friction.
fn slides(degrees: f64, friction: f64, is_damped: bool) -> f64 {
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, Condition::Fixed).unwrap();
    let options = Options { local_damping: 0.3, ..Options::default() };
    let gravity = DVec2::new(0.0, -9.81);
    let mut mpm = Mpm2::new(Setup { gravity, walls: vec![floor], options, ..Setup::new(0.1) }).unwrap();
    let law = LinearElastic::new(2e6, 0.3).unwrap();
    let bed = Particle::filling(DVec2::new(-0.5, 0.0), DVec2::new(2.0, 0.3), 0.05);
    let bed = mpm.body(law, 1000.0, &bed).unwrap();
    let block = Particle::filling(DVec2::new(0.0, 0.3), DVec2::new(0.8, 0.6), 0.05);
    let block = mpm.body(law, 1000.0, &block).unwrap();
    mpm.contact(bed, block, Contact { friction }).unwrap();
    let dt = mpm.recommended_step();
    mpm.advance(dt, (0.2 / dt) as u64).unwrap();
    mpm.set_local_damping(if is_damped { 0.3 } else { 0.0 }).unwrap();
    mpm.set_gravity(DVec2::new(degrees.to_radians().sin(), -degrees.to_radians().cos()) * 9.81).unwrap();
    mpm.advance(dt, (0.3 / dt) as u64).unwrap();
    mpm.set_local_damping(0.0).unwrap();
    let of_block = |mpm: &Mpm2| {
        let all: Vec<_> = mpm.particles().filter(|(id, _)| *id >= 50 * 6).collect();
        all.iter().map(|(_, particle)| particle.velocity).sum::<DVec2>() / all.len() as f64
    };
    let (before, start) = (of_block(&mpm), mpm.time());
    mpm.advance(dt, (0.3 / dt) as u64).unwrap();
    let change = (of_block(&mpm) - before) / (mpm.time() - start);
    change.x + if is_damped { 0.0 } else { friction * change.y }
}

#[test]
fn a_block_slides_or_sticks_on_a_deformable_bed() {
    alone(|| {
        for (degrees, friction) in [(30.0, 0.466), (40.0, 0.2)] {
            let (sine, cosine) = f64::to_radians(degrees).sin_cos();
            let expected = 9.81 * (sine - friction * cosine);
            let off = slides(degrees, friction, false) / expected - 1.0;
            assert!(off.abs() < 0.02, "{degrees}: {off}");
        }
        let creep = slides(24.0, 0.466, true) / (9.81 * 24.0_f64.to_radians().sin());
        assert!(creep.abs() < 1e-3, "{creep}");
    });
}

/// A soft block lies on a stiff one.
fn unequal(ratio: f64, options: Options) -> (Mpm2, [BodyId; 2]) {
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, Condition::frictional(0.3)).unwrap();
    let gravity = DVec2::new(0.0, -9.81);
    let mut mpm = Mpm2::new(Setup { gravity, walls: vec![floor], options, ..Setup::new(0.1) }).unwrap();
    let fill = |low: DVec2, size: DVec2| Particle::<D2>::filling(low, low + size, 0.05);
    let stiff = fill(DVec2::ZERO, DVec2::new(0.8, 0.3));
    let stiff = mpm.body(LinearElastic::new(1e4 * ratio, 0.2).unwrap(), 2e4, &stiff).unwrap();
    let soft = fill(DVec2::new(0.2, 0.3), DVec2::new(0.4, 0.3));
    let soft = mpm.body(LinearElastic::new(1e4, 0.3).unwrap(), 500.0, &soft).unwrap();
    mpm.contact(soft, stiff, Contact { friction: 0.3 }).unwrap();
    (mpm, [stiff, soft])
}

/// The step is that of the stiff body; nothing else changes with the ratio, and the soft one comes to lie on it.
#[test]
fn a_body_a_million_times_as_stiff_carries_another() {
    alone(|| {
        let (mut mpm, [stiff, soft]) = unequal(1e6, Options { local_damping: 0.4, ..Options::default() });
        let dt = mpm.recommended_step();
        let mut force = DVec2::ZERO;
        let (steps, from) = ((0.6 / dt) as u64, (0.4 / dt) as u64);
        mpm.advance(dt, from).unwrap();
        let samples = (steps - from) / 50;
        for _ in 0..samples {
            mpm.advance(dt, 50).unwrap();
            force += mpm.contact_force(stiff, soft).unwrap() / samples as f64;
        }
        let weight = 0.4 * 0.3 * 500.0 * 9.81;
        assert!((force - DVec2::new(0.0, weight)).length() < 0.05 * weight, "{force} of {weight} N");
    });
}

/// In space.
#[test]
fn a_cube_rests_on_another() {
    alone(|| {
        let floor = Wall::plane("floor", DVec3::ZERO, DVec3::Z, Condition::frictional(0.3)).unwrap();
        let options = Options { local_damping: 0.3, ..Options::default() };
        let gravity = DVec3::new(0.0, 0.0, -9.81);
        let mut mpm = Mpm3::new(Setup { gravity, walls: vec![floor], options, ..Setup::new(0.1) }).unwrap();
        let law = LinearElastic::new(2e5, 0.2).unwrap();
        let cubes = [(DVec3::ZERO, 0.4), (DVec3::new(0.1, 0.1, 0.4), 0.2)].map(|(low, side)| {
            mpm.body(law, 1000.0, &Particle::<D3>::filling(low, low + side, 0.05)).unwrap()
        });
        mpm.contact(cubes[1], cubes[0], Contact { friction: 0.3 }).unwrap();
        let dt = mpm.recommended_step();
        mpm.advance(dt, (0.6 / dt) as u64).unwrap();
        let mut force = DVec3::ZERO;
        for _ in 0..200 {
            mpm.step(dt).unwrap();
            force += mpm.contact_force(cubes[0], cubes[1]).unwrap() / 200.0;
        }
        let expected = DVec3::new(0.0, 0.0, 0.2_f64.powi(3) * 9810.0);
        assert!((force - expected).length() < 0.02 * expected.z, "{force} {expected}");
    });
}

#[test]
fn contacts_are_checked() {
    let (mut mpm, [one, other]) = disks(Options::default(), SLIPPERY, 0.05);
    assert!(mpm.contact(one, one, SLIPPERY).is_err());
    assert!(mpm.contact(other, one, SLIPPERY).is_err());
    let third = mpm.body(LinearElastic::new(1.0, 0.0).unwrap(), 1.0, &[]).unwrap();
    let error = mpm.contact(one, third, Contact { friction: -0.1 }).unwrap_err();
    assert!(error.to_string().contains("friction"), "{error}");
    assert!(mpm.contact_force(one, third).is_none());
}

contract_tests!(
    two_in_contact,
    || {
        let (mut mpm, _) = unequal(10.0, Options { ledger: true, local_damping: 0.1, ..Options::default() });
        let third = Particle::filling(DVec2::new(0.2, 0.65), DVec2::new(0.6, 0.8), 0.05);
        mpm.body(LinearElastic::new(1e4, 0.3).unwrap(), 500.0, &third).unwrap();
        mpm
    },
    1e-3
);
contract_tests!(
    two_in_contact_stress_first,
    || unequal(10.0, Options { scheme: Scheme::StressFirst, ..Options::default() }).0,
    1e-3
);
