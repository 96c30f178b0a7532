//! Linear elasticity.

use crate::axes::Axes;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use granular_core::{SetupError, SymmetricTensor};

/// Isotropic linear elasticity in rate form: `d sigma = lambda tr(d eps) 1 + 2 G d eps`.
///
/// Keeps no memory and loses no work. With an objective update it is hypoelastic: strains add up as logarithms do when
/// the directions stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    /// Bulk modulus K \[Pa\].
    bulk: f64,
    /// Shear modulus G \[Pa\].
    shear: f64,
}

impl LinearElastic {
    /// By Young's modulus \[Pa\] and Poisson's ratio.
    ///
    /// # Errors
    /// When the modulus is not positive or the ratio not within -1 and 0.5.
    pub fn new(young: f64, poisson: f64) -> Result<Self, SetupError> {
        if !(young > 0.0 && young.is_finite()) {
            return Err(SetupError::new("Young's modulus", young, "more than zero Pa, and finite"));
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(SetupError::new("Poisson's ratio", poisson, "between -1 and 0.5, both excluded"));
        }
        Ok(Self { bulk: young / (3.0 * (1.0 - 2.0 * poisson)), shear: young / (2.0 * (1.0 + poisson)) })
    }

    /// Bulk modulus \[Pa\].
    pub const fn bulk(&self) -> f64 {
        self.bulk
    }

    /// Shear modulus \[Pa\].
    pub const fn shear(&self) -> f64 {
        self.shear
    }

    /// Change of stress \[Pa\] that goes with a strain.
    #[inline(always)]
    pub fn stress_of(&self, strain: SymmetricTensor) -> SymmetricTensor {
        let mean = (self.bulk - self.shear * (2.0 / 3.0)) * strain.trace();
        SymmetricTensor::IDENTITY * mean + strain * (2.0 * self.shear)
    }

    /// Energy per volume \[J/m^3\] at a stress \[Pa\].
    #[inline(always)]
    pub fn energy_at(&self, stress: SymmetricTensor) -> f64 {
        let (deviator, mean) = (stress.deviator(), stress.trace() / 3.0);
        deviator.contract(deviator) / (4.0 * self.shear) + mean * mean / (2.0 * self.bulk)
    }

    /// Speed \[m/s\] of compression waves, `sqrt((K + 4G/3) / rho)`.
    pub fn compression_speed(&self, density: f64) -> f64 {
        ((self.bulk + self.shear * (4.0 / 3.0)) / density).sqrt()
    }
}

impl ConstitutiveLaw for LinearElastic {
    type Memory = [f64; 0];

    const KEPT: &'static [Kept] = &[];

    fn start(&self) -> [f64; 0] {
        []
    }

    #[inline(always)]
    fn respond<A: Axes>(
        &self,
        stress: SymmetricTensor,
        _memory: &mut [f64; 0],
        increment: &Increment,
    ) -> Response {
        Response { stress: stress + self.stress_of(increment.strain), ..Response::default() }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _memory: &[f64; 0]) -> f64 {
        self.energy_at(stress)
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.compression_speed(density)
    }
}
