use super::*;
use crate::axes::{InPlane, InSpace};
use std::f64::consts::TAU;

const STRESS: SymmetricTensor =
    SymmetricTensor { xx: -3e5, yy: -1e5, zz: -2e5, xy: 0.4e5, yz: 0.7e5, xz: -0.2e5 };

fn norm(tensor: SymmetricTensor) -> f64 {
    tensor.contract(tensor).sqrt()
}

/// Gradient of a turn: `L v = w x v`.
fn turning(w: DVec3) -> DMat3 {
    DMat3::from_cols(w.cross(DVec3::X), w.cross(DVec3::Y), w.cross(DVec3::Z))
}

fn full_turn(update: impl Fn(SymmetricTensor) -> SymmetricTensor, steps: usize) -> f64 {
    let mut stress = STRESS;
    for _ in 0..steps {
        stress = update(stress);
    }
    norm(stress - STRESS) / norm(STRESS)
}

#[test]
fn a_full_turn_brings_the_stress_back() {
    let steps = 1000;
    // The half tangent makes the angle of a step exact where it is 2 tan(angle / 2).
    let angle = 2.0 * (TAU / steps as f64 / 2.0).tan();
    let axis = DVec3::new(2.0, -1.0, 2.0) / 3.0;
    let space = turning(axis * angle);
    assert!(full_turn(|stress| hughes_winget::<InSpace>(stress, space), steps) < 1e-12);
    let plane = DMat2::from_cols_array(&[0.0, angle, -angle, 0.0]);
    let in_plane = SymmetricTensor { yz: 0.0, xz: 0.0, ..STRESS };
    let turned = (0..steps).fold(in_plane, |stress, _| hughes_winget::<InPlane>(stress, plane));
    assert!(norm(turned - in_plane) < 1e-12 * norm(in_plane));
}

#[test]
fn the_rate_of_jaumann_errs_in_proportion_to_the_step() {
    let error = |steps: usize| {
        let gradient = turning(DVec3::new(2.0, -1.0, 2.0) / 3.0 * (TAU / steps as f64));
        full_turn(|stress| jaumann::<InSpace>(stress, gradient), steps)
    };
    let (coarse, fine) = (error(50_000), error(100_000));
    assert!((coarse / fine - 2.0).abs() < 0.01, "{coarse} {fine}");
    assert!(fine < 1e-3, "{fine}");
}

/// Both updates against products of matrices.
#[test]
fn updates_are_products_of_matrices() {
    let matrix = |t: SymmetricTensor| {
        DMat3::from_cols(
            DVec3::new(t.xx, t.xy, t.xz),
            DVec3::new(t.xy, t.yy, t.yz),
            DVec3::new(t.xz, t.yz, t.zz),
        )
    };
    let gradient = DMat3::from_cols_array(&[0.1, 0.3, -0.2, 0.5, -0.1, 0.05, 0.25, -0.4, 0.2]);
    let spin = (gradient - gradient.transpose()) * 0.5;
    let stress = matrix(STRESS);
    let same = |found: SymmetricTensor, wanted: DMat3| {
        assert!((matrix(found) - wanted).to_cols_array().iter().all(|part| part.abs() < 1e-9), "{found:?}");
    };
    same(jaumann::<InSpace>(STRESS, gradient), stress + spin * stress - stress * spin);
    let q = (DMat3::IDENTITY - spin * 0.5).inverse() * (DMat3::IDENTITY + spin * 0.5);
    same(hughes_winget::<InSpace>(STRESS, gradient), q * stress * q.transpose());
}

#[test]
fn the_plane_is_a_slice_of_space() {
    let plane = DMat2::from_cols_array(&[0.1, 0.3, -0.2, 0.5]);
    let space = DMat3::from_mat2(plane);
    let space = DMat3 { z_axis: DVec3::ZERO, ..space };
    let stress = SymmetricTensor { yz: 0.0, xz: 0.0, ..STRESS };
    let close = |a: SymmetricTensor, b: SymmetricTensor| assert!(norm(a - b) < 1e-15 * norm(a) * 4.0);
    close(jaumann::<InPlane>(stress, plane), jaumann::<InSpace>(stress, space));
    close(hughes_winget::<InPlane>(stress, plane), hughes_winget::<InSpace>(stress, space));
    assert_eq!(InPlane::strain(plane), InSpace::strain(space));
}

/// Largest error of the stresses of hypoelastic simple shear, `xy = G sin(g)` and `xx = G (1 - cos(g))`.
fn error_of_shear(
    step: f64,
    turn: impl Fn(SymmetricTensor, SymmetricTensor, DMat2) -> SymmetricTensor,
) -> f64 {
    let gradient = DMat2::from_cols_array(&[0.0, 0.0, step, 0.0]);
    let added = InPlane::strain(gradient) * 2.0; // G = 1
    let mut stress = SymmetricTensor::ZERO;
    let mut worst: f64 = 0.0;
    for number in 1..=(TAU / step) as usize {
        stress = turn(stress, added, gradient);
        let shear = number as f64 * step;
        worst = worst.max((stress.xy - shear.sin()).abs());
        worst = worst.max((stress.xx - (1.0 - shear.cos())).abs());
        worst = worst.max((stress.yy + stress.xx).abs());
    }
    worst
}

#[test]
fn simple_shear_of_a_hypoelastic_material_oscillates() {
    let halves = |stress, added, gradient: DMat2| {
        let half = gradient * 0.5;
        hughes_winget::<InPlane>(hughes_winget::<InPlane>(stress, half) + added, half)
    };
    let (coarse, fine) = (error_of_shear(2e-3, halves), error_of_shear(1e-3, halves));
    assert!(fine < 1e-6, "{fine}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "of second order: {coarse} {fine}");
    let at_once = |stress, added, gradient| hughes_winget::<InPlane>(stress, gradient) + added;
    let (coarse, fine) = (error_of_shear(2e-3, at_once), error_of_shear(1e-3, at_once));
    assert!((coarse / fine - 2.0).abs() < 0.1, "of first order: {coarse} {fine}");
    let rate = |stress, added, gradient| jaumann::<InPlane>(stress, gradient) + added;
    let (coarse, fine) = (error_of_shear(2e-3, rate), error_of_shear(1e-3, rate));
    assert!((coarse / fine - 2.0).abs() < 0.1, "of first order: {coarse} {fine}");
}
