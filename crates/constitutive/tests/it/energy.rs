//! Work is stored or lost, up to an error that falls with the increment.

use crate::support::{laws, norm, respond, start, stored};
use granular_constitutive::granular_core::SymmetricTensor;
use granular_constitutive::{AnyLaw, InSpace, Increment};

/// A strain that presses, then shears to and fro while it presses on; never straight.
fn strain_at(time: f64) -> SymmetricTensor {
    let shear = 4e-3 * (6.0 * time).sin();
    SymmetricTensor {
        xx: -1e-3 * time,
        yy: -2e-3 * time + 0.5 * shear,
        zz: -1.5e-3 * time - 0.3 * shear * time,
        xy: shear,
        yz: 0.3 * shear * time,
        xz: 0.0,
    }
}

/// Share of the work that is neither stored nor lost, and the stress at the end. Fluids store energy in their present volume; solids in rate form
/// have one of small strains.
fn balance(law: &AnyLaw, increments: u32) -> (f64, SymmetricTensor) {
    let is_fluid = matches!(law, AnyLaw::Newtonian(_) | AnyLaw::Bingham(_));
    let mut memory = start(law);
    let still = Increment::of_strain(SymmetricTensor::ZERO);
    let mut stress = respond::<InSpace>(law, SymmetricTensor::ZERO, &mut memory, &still).stress;
    let (mut work, mut lost, mut spent) = (-stored(law, stress), 0.0, 0.0);
    let dt = 1.0 / f64::from(increments);
    for number in 0..increments {
        let at = |n: u32| strain_at(f64::from(n) * dt);
        let strain = at(number + 1) - at(number);
        let volume_ratio = at(number + 1).trace().exp();
        let response = respond::<InSpace>(law, stress, &mut memory, &Increment { strain, dt, volume_ratio });
        let middle = if is_fluid { (0.5 * (at(number) + at(number + 1)).trace()).exp() } else { 1.0 };
        let added = middle * 0.5 * (stress + response.stress).contract(strain);
        (work, spent) = (work + added, spent + added.abs());
        lost += middle * (response.plastic_work + response.viscous_work);
        stress = response.stress;
    }
    let volume = if is_fluid { strain_at(1.0).trace().exp() } else { 1.0 };
    ((work - volume * stored(law, stress) - lost).abs() / spent, stress)
}

#[test]
fn work_is_stored_or_lost() {
    for law in laws() {
        let (coarse, fine) = (balance(&law, 3200).0, balance(&law, 25_600).0);
        assert!(fine < 5e-5, "{}: {coarse} {fine}", law.name());
        assert!(fine < 0.2 * coarse || fine < 1e-12, "{}: of first order: {coarse} {fine}", law.name());
    }
}

#[test]
fn more_increments_lead_to_the_same_stress() {
    for law in laws() {
        let reference = balance(&law, 51_200).1;
        let error = |increments: u32| norm(balance(&law, increments).1 - reference) / norm(reference);
        let (coarse, fine) = (error(3200), error(12_800));
        assert!(fine < 5e-4, "{}: {coarse} {fine}", law.name());
        assert!(fine < 0.4 * coarse || fine < 1e-4, "{}: of first order: {coarse} {fine}", law.name());
    }
}
