//! Fluids: pressure of a nearly incompressible liquid, and viscous stress.

mod exponential;
#[cfg(test)]
mod tests;

use crate::axes::Axes;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use exponential::relative_decay;
use granular_core::{SetupError, SymmetricTensor};

/// The equation of state of Tait for nearly incompressible liquids, `p = B ((rho / rho_0)^7 - 1)` with `B = rho_0 c_0^2 / 7`
/// \[Monaghan1994\].
///
/// A speed of sound of ten times the fastest flow keeps changes of density near one percent. Pressure follows from the volume over that at the
/// start of the run, when the density is `rho_0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tait {
    density: f64,
    sound_speed: f64,
    /// B \[Pa\].
    scale: f64,
    least: f64,
}

impl Tait {
    /// By the density \[kg/m^3\] without pressure and the speed of sound \[m/s\] there.
    ///
    /// # Errors
    /// When either is not above 0.
    pub fn new(density: f64, sound_speed: f64) -> Result<Self, SetupError> {
        if !(density > 0.0 && density.is_finite()) {
            return Err(SetupError::new("density", density, "above 0 kg/m^3, and finite"));
        }
        if !(sound_speed > 0.0 && sound_speed.is_finite()) {
            return Err(SetupError::new("speed of sound", sound_speed, "above 0 m/s, and finite"));
        }
        let scale = density * sound_speed * sound_speed / 7.0;
        Ok(Self { density, sound_speed, scale, least: f64::NEG_INFINITY })
    }

    /// The same liquid that carries no tension: it comes apart instead.
    pub const fn without_tension(self) -> Self {
        Self { least: 0.0, ..self }
    }

    /// Density \[kg/m^3\] without pressure.
    pub const fn density(&self) -> f64 {
        self.density
    }

    /// Speed of sound \[m/s\] without pressure.
    pub const fn sound_speed(&self) -> f64 {
        self.sound_speed
    }

    /// Pressure \[Pa\] at a volume over that without pressure; not a number where that is not above 0.
    #[inline(always)]
    pub fn pressure(&self, volume_ratio: f64) -> f64 {
        let ratio = 1.0 / if volume_ratio > 0.0 { volume_ratio } else { f64::NAN };
        let cube = ratio * ratio * ratio;
        let pressure = self.scale * (cube * cube * ratio - 1.0);
        if pressure < self.least { self.least } else { pressure }
    }

    /// Energy \[J/m^3\] per present volume at a pressure \[Pa\]. With tension cut, that of tension is zero.
    pub fn energy(&self, pressure: f64) -> f64 {
        // Of the volume ratio v, per volume without pressure: B ((v^-6 - 1) / 6 + v - 1).
        let ratio = (pressure / self.scale).ln_1p() / 7.0;
        self.scale * (((6.0 * ratio).exp_m1() / 6.0 + (-ratio).exp_m1()) * ratio.exp())
    }

    /// Speed of sound \[m/s\] at a density \[kg/m^3\], and at least that without pressure.
    pub fn speed_at(&self, density: f64) -> f64 {
        self.sound_speed * (density / self.density).max(1.0).powi(3)
    }
}

/// A fluid whose shear stress is in proportion to the rate, with the pressure of [`Tait`].
///
/// `stress = -p 1 + 2 eta e'`, with the deviator e' of the rate of strain. Keeps no memory: the stress before the increment is not used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newtonian {
    viscosity: f64,
    state: Tait,
}

impl Newtonian {
    /// By the dynamic viscosity \[Pa s\] and the equation of state.
    ///
    /// # Errors
    /// When the viscosity is negative.
    pub fn new(viscosity: f64, state: Tait) -> Result<Self, SetupError> {
        check_viscosity(viscosity)?;
        Ok(Self { viscosity, state })
    }

    /// The equation of state.
    pub const fn state(&self) -> &Tait {
        &self.state
    }
}

/// A fluid that flows beyond a yield stress, after Bingham, made smooth after Papanastasiou, with the pressure of [`Tait`].
///
/// `stress = -p 1 + 2 eta e'` with `eta = mu_B + tau_y (1 - exp(-m g)) / g`, where `g = sqrt(2 e':e')` is the shear rate \[Papanastasiou1987\].
/// Below the yield stress it creeps with the viscosity `mu_B + m tau_y`, which limits explicit steps: the larger m, the more
/// like a solid, and the smaller the step. Work on the yield stress is booked as plastic, the rest as viscous.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bingham {
    viscosity: f64,
    yield_stress: f64,
    /// m \[s\].
    growth: f64,
    state: Tait,
}

impl Bingham {
    /// By the plastic viscosity mu_B \[Pa s\], the yield stress tau_y \[Pa\], the time m \[s\] of Papanastasiou, and the equation of state.
    ///
    /// # Errors
    /// When a value is negative, or the time not above 0.
    pub fn new(viscosity: f64, yield_stress: f64, growth: f64, state: Tait) -> Result<Self, SetupError> {
        check_viscosity(viscosity)?;
        if !(yield_stress >= 0.0 && yield_stress.is_finite()) {
            return Err(SetupError::new("yield stress", yield_stress, "0 Pa or more, and finite"));
        }
        if !(growth > 0.0 && growth.is_finite()) {
            return Err(SetupError::new(
                "time of growth of the yield stress",
                growth,
                "above 0 s, and finite",
            ));
        }
        Ok(Self { viscosity, yield_stress, growth, state })
    }

    /// The equation of state.
    pub const fn state(&self) -> &Tait {
        &self.state
    }

    /// The part of the viscosity \[Pa s\] that makes the yield stress, at a shear rate \[1/s\].
    #[inline(always)]
    fn yielding(&self, shear_rate: f64) -> f64 {
        self.yield_stress * self.growth * relative_decay(self.growth * shear_rate)
    }

    /// Dynamic viscosity \[Pa s\] at a shear rate \[1/s\].
    #[inline(always)]
    pub fn viscosity_at(&self, shear_rate: f64) -> f64 {
        self.viscosity + self.yielding(shear_rate)
    }
}

fn check_viscosity(viscosity: f64) -> Result<(), SetupError> {
    if viscosity >= 0.0 && viscosity.is_finite() {
        return Ok(());
    }
    Err(SetupError::new("viscosity", viscosity, "0 Pa s or more, and finite"))
}

/// The deviator of the rate of strain \[1/s\]; zero without duration.
#[inline(always)]
fn rate_of(increment: &Increment) -> SymmetricTensor {
    let strain = increment.strain;
    let deviator = strain - SymmetricTensor::IDENTITY * (strain.trace() * (1.0 / 3.0));
    let lasts = increment.dt > 0.0;
    deviator * (if lasts { 1.0 } else { 0.0 } / if lasts { increment.dt } else { 1.0 })
}

impl ConstitutiveLaw for Newtonian {
    type Memory = [f64; 0];

    const KEPT: &'static [Kept] = &[];

    fn start(&self) -> [f64; 0] {
        []
    }

    #[inline(always)]
    fn respond<A: Axes>(&self, _: SymmetricTensor, _: &mut [f64; 0], increment: &Increment) -> Response {
        let viscous = rate_of(increment) * (2.0 * self.viscosity);
        let pressure = self.state.pressure(increment.volume_ratio);
        Response {
            stress: viscous - SymmetricTensor::IDENTITY * pressure,
            viscous_work: viscous.contract(increment.strain),
            ..Response::default()
        }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _: &[f64; 0]) -> f64 {
        self.state.energy(crate::measures::mean_pressure(stress))
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.state.speed_at(density)
    }

    fn greatest_viscosity(&self) -> f64 {
        self.viscosity
    }
}

impl ConstitutiveLaw for Bingham {
    type Memory = [f64; 0];

    const KEPT: &'static [Kept] = &[];

    fn start(&self) -> [f64; 0] {
        []
    }

    #[inline(always)]
    fn respond<A: Axes>(&self, _: SymmetricTensor, _: &mut [f64; 0], increment: &Increment) -> Response {
        let rate = rate_of(increment);
        let square = 2.0 * rate.contract(rate);
        let yielding = self.yielding(square.sqrt());
        let pressure = self.state.pressure(increment.volume_ratio);
        let work = square * increment.dt;
        Response {
            stress: rate * (2.0 * (self.viscosity + yielding)) - SymmetricTensor::IDENTITY * pressure,
            plastic_work: yielding * work,
            viscous_work: self.viscosity * work,
        }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _: &[f64; 0]) -> f64 {
        self.state.energy(crate::measures::mean_pressure(stress))
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.state.speed_at(density)
    }

    fn greatest_viscosity(&self) -> f64 {
        self.viscosity + self.growth * self.yield_stress
    }
}
