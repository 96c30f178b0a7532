use super::*;
use crate::axes::InSpace;

fn water() -> Tait {
    Tait::new(1000.0, 30.0).unwrap()
}

#[test]
fn pressure_and_speed_are_those_of_the_state() {
    let state = water();
    assert_eq!(state.pressure(1.0), 0.0);
    // The slope at rest is the bulk modulus.
    let slope = -(state.pressure(1.0 + 1e-6) - state.pressure(1.0 - 1e-6)) / 2e-6;
    assert!((slope / (1000.0 * 30.0 * 30.0) - 1.0).abs() < 1e-9);
    let slope = |density: f64| {
        (state.pressure(1000.0 / (density + 1e-3)) - state.pressure(1000.0 / (density - 1e-3))) / 2e-3
    };
    assert!((state.speed_at(1020.0) - slope(1020.0).sqrt()).abs() < 1e-5);
    assert_eq!(state.speed_at(900.0), 30.0);
    assert!(state.pressure(1.01) < 0.0);
    assert_eq!(state.without_tension().pressure(1.01), 0.0);
    assert!(state.without_tension().pressure(f64::NAN).is_nan() && state.pressure(-1.0).is_nan());
}

/// The energy per present volume, against the work of the pressure.
#[test]
fn energy_is_the_work_of_pressure() {
    let state = water();
    for volume in [0.9, 0.999, 1.0, 1.001, 1.05] {
        let steps = 10_000;
        let width = (volume - 1.0) / f64::from(steps);
        let work: f64 =
            (0..steps).map(|step| -state.pressure(1.0 + (f64::from(step) + 0.5) * width) * width).sum();
        let energy = state.energy(state.pressure(volume)) * volume;
        assert!((energy - work).abs() <= 1e-6 * work.abs() + 1e-12, "{energy} {work}");
    }
}

#[test]
fn a_newtonian_fluid_loses_what_shear_costs() {
    let law = Newtonian::new(0.5, water()).unwrap();
    let strain = SymmetricTensor { xy: 0.5e-3, xx: 2e-4, ..SymmetricTensor::ZERO };
    let increment = Increment { strain, dt: 1e-2, volume_ratio: 1.0 };
    let response = law.respond::<InSpace>(SymmetricTensor::ZERO, &mut [], &increment);
    assert!((response.stress.xy - 0.5 * 0.1).abs() < 1e-15);
    assert!(response.stress.trace().abs() < 1e-15);
    assert!((response.viscous_work - response.stress.contract(strain)).abs() < 1e-18);
    let at_once = law.respond::<InSpace>(SymmetricTensor::ZERO, &mut [], &Increment { dt: 0.0, ..increment });
    assert_eq!(at_once.stress, SymmetricTensor::ZERO * -1.0);
}

#[test]
fn a_bingham_fluid_has_its_yield_stress_in_flow_and_creeps_below() {
    let law = Bingham::new(2.0, 50.0, 100.0, water()).unwrap();
    let shear_stress = |rate: f64| {
        let dt = 1e-3;
        let strain = SymmetricTensor { xy: 0.5 * rate * dt, ..SymmetricTensor::ZERO };
        let increment = Increment { strain, dt, volume_ratio: 1.0 };
        let response = law.respond::<InSpace>(SymmetricTensor::ZERO, &mut [], &increment);
        let lost = response.plastic_work + response.viscous_work;
        assert!((lost - response.stress.contract(strain)).abs() <= 1e-14 * lost);
        response.stress.xy
    };
    assert!((shear_stress(3.0) - (50.0 + 2.0 * 3.0)).abs() < 1e-12);
    let slow = 1e-7;
    assert!((shear_stress(slow) / slow - law.greatest_viscosity()).abs() < 0.03);
    assert_eq!(shear_stress(0.0), 0.0);
    let middle: f64 = 0.013;
    let wanted = 2.0 * middle - 50.0 * (-100.0 * middle).exp_m1();
    assert!((shear_stress(middle) - wanted).abs() < 1e-12);
}

#[test]
fn constants_out_of_range_are_refused() {
    assert!(Tait::new(0.0, 1.0).is_err() && Tait::new(1.0, f64::INFINITY).is_err());
    assert!(Newtonian::new(-1.0, water()).is_err());
    assert!(Bingham::new(1.0, -1.0, 1.0, water()).is_err());
    let error = Bingham::new(1.0, 1.0, 0.0, water()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "time of growth of the yield stress is 0, but must be above 0 s, and finite"
    );
}
