//! Numbers that describe a stress or a rate of strain. Stress is positive in tension, pressure in compression.

use crate::axes::Axes;
use granular_core::SymmetricTensor;

/// Mean pressure p \[Pa\], `-tr(stress) / 3`.
#[inline(always)]
pub fn mean_pressure(stress: SymmetricTensor) -> f64 {
    stress.trace() * (-1.0 / 3.0)
}

/// Deviator stress q \[Pa\], `sqrt(3/2 s:s)`: the difference of axial and lateral stress in a triaxial test.
#[inline(always)]
pub fn deviator_stress(stress: SymmetricTensor) -> f64 {
    let s = stress.deviator();
    (1.5 * s.contract(s)).sqrt()
}

/// Shear stress \[Pa\], `sqrt(J2) = sqrt(s:s / 2)`: that of a state of pure shear.
#[inline(always)]
pub fn shear_stress(stress: SymmetricTensor) -> f64 {
    let s = stress.deviator();
    (0.5 * s.contract(s)).sqrt()
}

/// Mobilised friction, `sin(phi_m) = (s1 - s3) / |s1 + s3|` by the largest and the smallest principal stress. Zero without stress;
/// infinite in pure shear.
#[inline(always)]
pub fn mobilised_friction<A: Axes>(stress: SymmetricTensor) -> f64 {
    let [first, _, last] = A::principal(stress).values;
    let difference = first - last;
    if difference == 0.0 { 0.0 } else { difference / (first + last).abs() }
}

/// Lode angle \[rad\], from -pi/6 in triaxial extension to pi/6 in triaxial compression; zero for an isotropic stress.
#[inline(always)]
pub fn lode_angle<A: Axes>(stress: SymmetricTensor) -> f64 {
    let [first, middle, last] = A::principal(stress).values;
    let difference = first - last;
    let tangent = ((middle - first) + (middle - last)) / (3.0_f64.sqrt() * difference);
    if difference == 0.0 { 0.0 } else { tangent.atan() }
}

/// Shear rate \[1/s\] of a rate of strain \[1/s\], `sqrt(2 e':e')`: the velocity gradient in simple shear.
#[inline(always)]
pub fn shear_rate(rate: SymmetricTensor) -> f64 {
    let deviator = rate.deviator();
    (2.0 * deviator.contract(deviator)).sqrt()
}

/// Inertial number I \[-\] of dry grains, `shear rate * diameter * sqrt(grain density / pressure)` \[GdrMidi2004\]
/// (\[Kumar2014, eq. 2.6\] lacks the root over the density).
#[inline(always)]
pub fn inertial_number(shear_rate: f64, diameter: f64, grain_density: f64, pressure: f64) -> f64 {
    shear_rate * diameter * (grain_density / pressure).sqrt()
}

/// Viscous number \[-\] of grains in a liquid, `viscosity * shear rate / pressure` \[Boyer2011\].
#[inline(always)]
pub fn viscous_number(shear_rate: f64, viscosity: f64, pressure: f64) -> f64 {
    viscosity * shear_rate / pressure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::{InPlane, InSpace};

    const COMPRESSION: SymmetricTensor =
        SymmetricTensor { xx: -1e5, yy: -3e5, zz: -1e5, xy: 0.0, yz: 0.0, xz: 0.0 };
    const EXTENSION: SymmetricTensor =
        SymmetricTensor { xx: -3e5, yy: -1e5, zz: -3e5, xy: 0.0, yz: 0.0, xz: 0.0 };

    #[test]
    fn triaxial_states_have_the_measures_of_textbooks() {
        assert!((mean_pressure(COMPRESSION) - 5e5 / 3.0).abs() < 1e-9);
        assert!((deviator_stress(COMPRESSION) - 2e5).abs() < 1e-9);
        assert!((shear_stress(COMPRESSION) - 2e5 / 3.0_f64.sqrt()).abs() < 1e-9);
        assert_eq!(mobilised_friction::<InPlane>(COMPRESSION), 0.5);
        assert_eq!(mobilised_friction::<InSpace>(COMPRESSION), 0.5);
        assert!((lode_angle::<InSpace>(COMPRESSION) - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
        assert!((lode_angle::<InPlane>(EXTENSION) + std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    }

    #[test]
    fn no_stress_mobilises_nothing() {
        assert_eq!(mobilised_friction::<InSpace>(SymmetricTensor::ZERO), 0.0);
        assert_eq!(lode_angle::<InSpace>(SymmetricTensor::ZERO), 0.0);
    }

    #[test]
    fn simple_shear_has_the_rate_of_its_gradient() {
        let rate = SymmetricTensor { xy: 0.5 * 3.0, ..SymmetricTensor::ZERO };
        assert!((shear_rate(rate) - 3.0).abs() < 1e-15);
        assert!((inertial_number(3.0, 1e-3, 2500.0, 100.0) - 0.015).abs() < 1e-15);
        assert!((viscous_number(3.0, 1e-3, 100.0) - 3e-5).abs() < 1e-18);
    }
}
