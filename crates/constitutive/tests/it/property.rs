//! Random stresses and strains.

use crate::support::{laws, norm, respond, solids, start};
use granular_constitutive::granular_core::SymmetricTensor;
use granular_constitutive::granular_core::glam::{DMat3, DQuat, DVec3};
use granular_constitutive::{AnyLaw, Axes, InPlane, InSpace, Increment, measures};
use proptest::prelude::*;

fn tensor() -> impl Strategy<Value = SymmetricTensor> {
    prop::array::uniform6(-1.0..1.0_f64).prop_map(|[xx, yy, zz, xy, yz, xz]| SymmetricTensor {
        xx,
        yy,
        zz,
        xy,
        yz,
        xz,
    })
}

/// Stresses of the order of the strength, mostly in compression, and strains that load beyond it.
fn state() -> impl Strategy<Value = (SymmetricTensor, Increment)> {
    (tensor(), 0.0..3.0_f64, tensor(), -6.0..-2.0_f64).prop_map(|(stress, pressed, strain, size)| {
        let stress = (stress - SymmetricTensor::IDENTITY * pressed) * 1e3;
        let strain = strain * 10.0_f64.powf(size);
        (stress, Increment { strain, dt: 1e-4, volume_ratio: 1.0 + strain.trace() })
    })
}

/// The stress as the law may have it: after an increment of nothing.
fn allowed<A: Axes>(law: &AnyLaw, stress: SymmetricTensor, memory: &mut [f64]) -> SymmetricTensor {
    respond::<A>(law, stress, memory, &Increment::of_strain(SymmetricTensor::ZERO)).stress
}

fn turned(rotation: DMat3, t: SymmetricTensor) -> SymmetricTensor {
    let matrix = DMat3::from_cols(
        DVec3::new(t.xx, t.xy, t.xz),
        DVec3::new(t.xy, t.yy, t.yz),
        DVec3::new(t.xz, t.yz, t.zz),
    );
    let m = rotation * matrix * rotation.transpose();
    SymmetricTensor {
        xx: m.x_axis.x,
        yy: m.y_axis.y,
        zz: m.z_axis.z,
        xy: m.y_axis.x,
        yz: m.z_axis.y,
        xz: m.z_axis.x,
    }
}

/// What round-off may do: to stresses as large as the trial's.
fn size(stress: SymmetricTensor, increment: &Increment) -> f64 {
    norm(stress) + 4e6 * norm(increment.strain)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn laws_know_no_direction((stress, increment) in state(), axis in tensor(), angle in 0.0..6.0_f64) {
        let axis = DVec3::new(axis.xx, axis.yy, axis.zz + 1e-3).normalize();
        let rotation = DMat3::from_quat(DQuat::from_axis_angle(axis, angle));
        for law in laws() {
            let (mut one, mut two) = (start(&law), start(&law));
            let here = allowed::<InSpace>(&law, stress, &mut one);
            two.copy_from_slice(&one);
            let found = respond::<InSpace>(&law, here, &mut one, &increment);
            let other = Increment { strain: turned(rotation, increment.strain), ..increment };
            let there = respond::<InSpace>(&law, turned(rotation, here), &mut two, &other);
            let off = norm(there.stress - turned(rotation, found.stress));
            prop_assert!(off <= 1e-11 * size(stress, &increment), "{}: {off}", law.name());
            let work = size(stress, &increment) * norm(increment.strain);
            prop_assert!((found.plastic_work - there.plastic_work).abs() <= 1e-9 * work, "{}", law.name());
            for (a, b) in one.iter().zip(&two) {
                prop_assert!((a - b).abs() <= 1e-9 * (norm(increment.strain) + a.abs()), "{}: {a} {b}", law.name());
            }
        }
    }

    #[test]
    fn the_plane_is_a_slice_of_space((stress, increment) in state()) {
        let flat = |t: SymmetricTensor| SymmetricTensor { yz: 0.0, xz: 0.0, ..t };
        let (stress, strain) = (flat(stress), flat(increment.strain));
        let strain = SymmetricTensor { zz: 0.0, ..strain };
        let increment = Increment { strain, ..increment };
        for law in laws() {
            let (mut one, mut two) = (start(&law), start(&law));
            let here = allowed::<InPlane>(&law, stress, &mut one);
            two.copy_from_slice(&one);
            let plane = respond::<InPlane>(&law, here, &mut one, &increment);
            let space = respond::<InSpace>(&law, here, &mut two, &increment);
            let off = norm(plane.stress - space.stress);
            prop_assert!(off <= 1e-12 * size(stress, &increment), "{}: {off}", law.name());
            prop_assert!(plane.stress.yz == 0.0 && plane.stress.xz == 0.0);
        }
    }

    #[test]
    fn nothing_is_gained_and_strength_is_kept((stress, increment) in state()) {
        for law in laws() {
            let mut memory = start(&law);
            let here = allowed::<InSpace>(&law, stress, &mut memory);
            let response = respond::<InSpace>(&law, here, &mut memory, &increment);
            let work = size(stress, &increment) * norm(increment.strain);
            prop_assert!(response.plastic_work >= -1e-13 * work, "{}: {}", law.name(), response.plastic_work);
            prop_assert!(response.viscous_work >= -1e-13 * work, "{}: {}", law.name(), response.viscous_work);
            // What is within the strength is not changed again, but for the rate of mu(I).
            if !matches!(law, AnyLaw::LinearMuI(_) | AnyLaw::MuI(_) | AnyLaw::Newtonian(_) | AnyLaw::Bingham(_)) {
                let still = Increment { strain: SymmetricTensor::ZERO, ..increment };
                let again = respond::<InSpace>(&law, response.stress, &mut memory, &still).stress;
                let off = norm(again - response.stress);
                prop_assert!(off <= 1e-12 * size(stress, &increment), "{}: {off}", law.name());
            }
        }
    }

    /// What was pulled apart carries nothing until the gap is closed, in however many increments.
    #[test]
    fn gaps_open_and_close((stress, increment) in state(), parts in 1..20_u32) {
        let opening = 1e-2;
        for law in solids().into_iter().filter(|law| law.kept().iter().any(|kept| kept.name == "gap_strain")) {
            let mut memory = start(&law);
            let here = allowed::<InSpace>(&law, stress, &mut memory);
            let all = |strain: f64| Increment::of_strain(SymmetricTensor::IDENTITY * (strain / 3.0));
            let pulled = respond::<InSpace>(&law, here, &mut memory, &all(opening));
            let opened = memory[0];
            if opened == 0.0 {
                continue; // Cohesive.
            }
            prop_assert!(norm(pulled.stress) == 0.0, "{}: {:?}", law.name(), pulled.stress);
            let mut apart = pulled.stress;
            let sheared = Increment { strain: increment.strain.deviator(), volume_ratio: 1.0, ..increment };
            apart = respond::<InSpace>(&law, apart, &mut memory, &sheared).stress;
            prop_assert!(norm(apart) == 0.0 && (memory[0] - opened).abs() < 1e-15);
            for _ in 0..parts {
                let step = all(-1.1 * opened / f64::from(parts));
                apart = respond::<InSpace>(&law, apart, &mut memory, &step).stress;
            }
            prop_assert_eq!(memory[0], 0.0);
            let mut fresh = start(&law);
            let direct = respond::<InSpace>(&law, SymmetricTensor::ZERO, &mut fresh, &all(-0.1 * opened));
            let wanted = measures::mean_pressure(direct.stress);
            let found = measures::mean_pressure(apart);
            prop_assert!((found / wanted - 1.0).abs() < 1e-10, "{}: {found} {wanted}", law.name());
        }
    }
}

#[test]
fn what_is_not_finite_comes_out_not_finite() {
    let pressed = SymmetricTensor::IDENTITY * -1e3;
    for law in laws() {
        for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for place in 0..4 {
                let mut parts = [0.0; 4];
                parts[place] = broken;
                let [xx, yy, zz, xy] = parts;
                let strain = SymmetricTensor { xx, yy, zz, xy, ..SymmetricTensor::ZERO };
                let increment = Increment { strain, dt: 1e-4, volume_ratio: 1.0 + strain.trace() };
                for gap in [0.0, 1e-3] {
                    let mut memory = start(&law);
                    if law.kept().first().is_some_and(|kept| kept.name == "gap_strain") {
                        memory[0] = gap;
                    }
                    let plane = respond::<InPlane>(&law, pressed, &mut memory.clone(), &increment).stress;
                    let space = respond::<InSpace>(&law, pressed, &mut memory, &increment).stress;
                    assert!(!norm(plane).is_finite(), "{} in the plane: {strain:?} to {plane:?}", law.name());
                    assert!(!norm(space).is_finite(), "{} in space: {strain:?} to {space:?}", law.name());
                }
            }
        }
    }
}
