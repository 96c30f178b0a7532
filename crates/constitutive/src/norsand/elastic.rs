//! Elasticity that grows with pressure, with an energy.

use crate::measures;
use granular_core::{SetupError, SymmetricTensor};

/// Elasticity whose moduli grow as a power of pressure, and that gains nothing on closed paths \[Houlsby2005\].
///
/// At a pressure p without shear the moduli are `K = K_r (p / p_r)^n` and `G = G_r (p / p_r)^n`. Stress and strain are related by
/// their sizes `p_o = sqrt(p^2 + w q^2)` and `eps_o = sqrt(eps_v^2 + eps_q^2 / w)` with `w = (1 - n) K_r / (3 G_r)`, along one
/// direction: `p_o^(1 - n) = (1 - n) K_r p_r^(-n) eps_o`. Above a greatest pressure the moduli stay, so that there is a fastest
/// wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureElastic {
    /// `K_r p_r^(-n)`.
    scale: f64,
    exponent: f64,
    /// w.
    weight: f64,
    /// Size of the stress from which the moduli stay.
    greatest: f64,
}

/// Elastic strain by its invariants: volumetric, positive in compression, and `eps_q = sqrt(2/3 e:e)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Strained {
    pub(super) volumetric: f64,
    pub(super) shear: f64,
}

impl Strained {
    pub(super) fn of(strain: SymmetricTensor) -> Self {
        let e = strain.deviator();
        Self { volumetric: -strain.trace(), shear: (e.contract(e) * (2.0 / 3.0)).sqrt() }
    }
}

impl PressureElastic {
    /// By the shear modulus \[Pa\] at a reference pressure \[Pa\], Poisson's ratio of small loads from an isotropic state, the exponent n, and the greatest pressure
    /// \[Pa\] up to which the moduli grow.
    ///
    /// # Errors
    /// When a modulus or pressure is not above 0, Poisson's ratio is not within -1 and 0.5, or the exponent not within 0 and less than 1.
    pub fn new(
        shear_modulus: f64,
        reference_pressure: f64,
        poisson: f64,
        exponent: f64,
        greatest_pressure: f64,
    ) -> Result<Self, SetupError> {
        for (what, value) in [
            ("shear modulus", shear_modulus),
            ("reference pressure", reference_pressure),
            ("greatest pressure", greatest_pressure),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SetupError::new(what, value, "above 0 Pa, and finite"));
            }
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(SetupError::new("Poisson's ratio", poisson, "between -1 and 0.5, both excluded"));
        }
        if !(0.0..1.0).contains(&exponent) {
            return Err(SetupError::new("exponent of pressure", exponent, "0 or more, and less than 1"));
        }
        let ratio = 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
        Ok(Self {
            scale: shear_modulus * ratio * reference_pressure.powf(-exponent),
            exponent,
            weight: (1.0 - exponent) * ratio / 3.0,
            greatest: greatest_pressure,
        })
    }

    /// Size of the strain of a size of stress.
    fn strain_size(&self, stress: f64) -> f64 {
        let n = self.exponent;
        let bounded = stress.min(self.greatest);
        let steepest = self.scale * self.greatest.powf(n);
        bounded.powf(1.0 - n) / (self.scale * (1.0 - n)) + (stress - bounded) / steepest
    }

    /// Size of the stress of a size of strain.
    fn stress_size(&self, strain: f64) -> f64 {
        let n = self.exponent;
        let steepest = self.scale * self.greatest.powf(n);
        let knee = self.greatest.powf(1.0 - n) / (self.scale * (1.0 - n));
        if strain <= knee {
            (self.scale * (1.0 - n) * strain).powf(1.0 / (1.0 - n))
        } else {
            self.greatest + steepest * (strain - knee)
        }
    }

    /// Pressure p and deviator stress q \[Pa\] of an elastic strain.
    pub(super) fn invariants(&self, strain: Strained) -> (f64, f64) {
        let Strained { volumetric, shear } = strain;
        let size = (volumetric * volumetric + shear * shear / self.weight).sqrt();
        let stiffness = if size > 0.0 { self.stress_size(size) / size } else { 0.0 };
        (stiffness * volumetric, stiffness * shear / self.weight)
    }

    /// Stress \[Pa\] of an elastic strain.
    pub fn stress_of(&self, strain: SymmetricTensor) -> SymmetricTensor {
        let Strained { volumetric, shear } = Strained::of(strain);
        let size = (volumetric * volumetric + shear * shear / self.weight).sqrt();
        let stiffness = if size == 0.0 { 0.0 } else { self.stress_size(size) / size };
        strain.deviator() * (stiffness / (1.5 * self.weight))
            - SymmetricTensor::IDENTITY * (stiffness * volumetric)
    }

    /// Elastic strain of a stress \[Pa\].
    pub fn strain_of(&self, stress: SymmetricTensor) -> SymmetricTensor {
        let size = self.size(stress);
        let compliance = if size == 0.0 { 0.0 } else { self.strain_size(size) / size };
        let mean = measures::mean_pressure(stress);
        stress.deviator() * (1.5 * self.weight * compliance)
            - SymmetricTensor::IDENTITY * (compliance * mean / 3.0)
    }

    fn size(&self, stress: SymmetricTensor) -> f64 {
        let (p, q) = (measures::mean_pressure(stress), measures::deviator_stress(stress));
        (p * p + self.weight * q * q).sqrt()
    }

    /// Energy per volume \[J/m^3\] at a stress \[Pa\].
    pub fn energy_at(&self, stress: SymmetricTensor) -> f64 {
        let size = self.size(stress);
        let bounded = size.min(self.greatest);
        let n = self.exponent;
        let steepest = self.scale * self.greatest.powf(n);
        bounded.powf(2.0 - n) / (self.scale * (2.0 - n))
            + (size * size - bounded * bounded) / (2.0 * steepest)
    }

    /// Speed \[m/s\] of compression waves where the moduli are greatest, whatever the direction of the stress.
    pub fn greatest_wave_speed(&self, density: f64) -> f64 {
        let bulk = self.scale * self.greatest.powf(self.exponent);
        let shear = bulk / (3.0 * self.weight);
        ((bulk + shear * (4.0 / 3.0)) / density).sqrt()
    }
}
