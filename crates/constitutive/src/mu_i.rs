//! Granular flow whose friction depends on the rate: mu(I).

#[cfg(test)]
mod tests;

use crate::axes::Axes;
use crate::elastic::LinearElastic;
use crate::gap;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use granular_core::{SetupError, SymmetricTensor};
use std::fmt::Debug;

/// Linear elasticity below a friction that grows with the rate of shear, `sqrt(J2) = mu(I) p`, without dilation
/// \[Jop2006\], \[Kumar2014, section 4.3\].
///
/// I is the inertial number of dry grains or the viscous number of grains in a liquid ([`Grains`]), of the rate of plastic shear. The stress after
/// a step satisfies the law with the rate of that step: a closed form that is stable for any step
/// \[DunatungaKamrin2015\]. Without duration (`dt = 0`) the linear law answers elastically, since its friction has no bound.
///
/// The cone is that of simple shear in plane strain: `mu` is the ratio of shear to normal stress there. A friction angle that was read
/// as `mu = tan(phi)` for Mohr-Coulomb, as in the thesis, has the strength of `mu = sin(phi)` here.
///
/// Grains that are pulled apart carry nothing until the gap is closed, as in [`MohrCoulomb`](crate::MohrCoulomb). Work on friction at rest is
/// booked as plastic, work on what the rate adds as viscous.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MuI<F: RateFriction = SaturatingFriction> {
    elastic: LinearElastic,
    friction: F,
    /// The number I times pressure over shear rate, squared, is `inertia * p + viscosity^2`.
    inertia: f64,
    viscosity: f64,
}

/// What makes the dimensionless number of the rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grains {
    /// Dry: the inertial number `I = shear rate * diameter * sqrt(density / p)`.
    Dry {
        /// Mean diameter \[m\].
        diameter: f64,
        /// Density \[kg/m^3\] of the grains, not of the bulk.
        density: f64,
    },
    /// In a viscous liquid: the viscous number `viscosity * shear rate / p`.
    InLiquid {
        /// Dynamic viscosity \[Pa s\] of the liquid.
        viscosity: f64,
    },
}

/// Friction as a function of the number I, and what follows from it in closed form.
pub trait RateFriction: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Friction coefficient at rest.
    fn at_rest(&self) -> f64;

    /// Friction coefficient at a number I of 0 or more.
    fn at(&self, number: f64) -> f64;

    /// Shear stress \[Pa\] after a step.
    ///
    /// `trial` \[Pa\] is the elastic one, above that of friction at rest; `pressure` \[Pa\] is 0 or more. The rate of plastic shear is
    /// `(trial - stress) / relaxed`, where `relaxed` \[Pa s\] is the shear modulus times the step, and the number I is this times
    /// `viscosity` \[Pa s\] over the pressure.
    fn stress(&self, trial: f64, pressure: f64, relaxed: f64, viscosity: f64) -> f64;
}

/// `mu = mu_0 + b I` \[DaCruz2005\]; the thesis has 0.22 and 1 \[Kumar2014, section 4.3\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearFriction {
    at_rest: f64,
    slope: f64,
}

impl LinearFriction {
    /// By the coefficient at rest and its growth with I.
    ///
    /// # Errors
    /// When the coefficient is not above 0, or the slope negative.
    pub fn new(at_rest: f64, slope: f64) -> Result<Self, SetupError> {
        check_friction("friction at rest", at_rest)?;
        if !(slope >= 0.0 && slope.is_finite()) {
            return Err(SetupError::new("growth of friction with I", slope, "0 or more, and finite"));
        }
        Ok(Self { at_rest, slope })
    }
}

impl RateFriction for LinearFriction {
    fn at_rest(&self) -> f64 {
        self.at_rest
    }

    fn at(&self, number: f64) -> f64 {
        self.at_rest + self.slope * number
    }

    #[inline(always)]
    fn stress(&self, trial: f64, pressure: f64, relaxed: f64, viscosity: f64) -> f64 {
        let resting = self.at_rest * pressure;
        let viscosity = self.slope * viscosity;
        let sum = viscosity + relaxed;
        let share = viscosity / if sum > 0.0 { sum } else { 1.0 };
        resting + (trial - resting) * share
    }
}

/// `mu = mu_s + (mu_2 - mu_s) / (1 + I_0 / I)`, between a coefficient at rest and one of very fast flow \[Jop2006\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaturatingFriction {
    at_rest: f64,
    greatest: f64,
    scale: f64,
}

impl SaturatingFriction {
    /// By the coefficients at rest and in very fast flow, and the number I at which half of the way is gone.
    ///
    /// # Errors
    /// When a coefficient is not above 0, the second is below the first, or the number not above 0.
    pub fn new(at_rest: f64, greatest: f64, scale: f64) -> Result<Self, SetupError> {
        check_friction("friction at rest", at_rest)?;
        if !(greatest >= at_rest && greatest.is_finite()) {
            let allowed = "no less than that at rest, and finite";
            return Err(SetupError::new("greatest friction", greatest, allowed));
        }
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(SetupError::new(
                "number I of half of the growth of friction",
                scale,
                "above 0, and finite",
            ));
        }
        Ok(Self { at_rest, greatest, scale })
    }

    /// Glass beads: 0.38, 0.64 and 0.28 \[Jop2006\], \[DunatungaKamrin2015\].
    pub const fn glass_beads() -> Self {
        Self { at_rest: 0.38, greatest: 0.64, scale: 0.28 }
    }
}

impl RateFriction for SaturatingFriction {
    fn at_rest(&self) -> f64 {
        self.at_rest
    }

    fn at(&self, number: f64) -> f64 {
        self.at_rest + (self.greatest - self.at_rest) * number / (self.scale + number)
    }

    #[inline(always)]
    fn stress(&self, trial: f64, pressure: f64, relaxed: f64, viscosity: f64) -> f64 {
        // The smaller root of `x^2 - (limit + trial + a) x + limit trial + resting a`, where a is the difference of trial stress and
        // stress at which half of the growth is reached.
        let (resting, limit) = (self.at_rest * pressure, self.greatest * pressure);
        let a = self.scale * relaxed * pressure / if viscosity > 0.0 { viscosity } else { 1.0 };
        let sum = limit + trial + a;
        let difference = limit - trial;
        // The discriminant as a sum of what is never negative.
        let square = difference * difference + a * (a + 2.0 * ((limit - resting) + (trial - resting)));
        let product = limit * trial + resting * a;
        let divisor = sum + square.sqrt();
        2.0 * product / if divisor > 0.0 { divisor } else { 1.0 }
    }
}

fn check_friction(what: &str, value: f64) -> Result<(), SetupError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(SetupError::new(what, value, "above 0, and finite"))
}

impl<F: RateFriction> MuI<F> {
    /// By elastic constants, the law of friction, and what the rate is compared with.
    ///
    /// # Errors
    /// When diameter, density or viscosity is not above 0.
    pub fn new(elastic: LinearElastic, friction: F, grains: Grains) -> Result<Self, SetupError> {
        let positive = |what: &str, value: f64, allowed: &'static str| {
            let right = value > 0.0 && value.is_finite();
            if right { Ok(value) } else { Err(SetupError::new(what, value, allowed)) }
        };
        let (inertia, viscosity) = match grains {
            Grains::Dry { diameter, density } => {
                let diameter = positive("diameter of the grains", diameter, "above 0 m, and finite")?;
                let density = positive("density of the grains", density, "above 0 kg/m^3, and finite")?;
                (density * diameter * diameter, 0.0)
            }
            Grains::InLiquid { viscosity } => {
                (0.0, positive("viscosity of the liquid", viscosity, "above 0 Pa s, and finite")?)
            }
        };
        Ok(Self { elastic, friction, inertia, viscosity })
    }

    /// The elastic law below the strength.
    pub const fn elastic(&self) -> &LinearElastic {
        &self.elastic
    }

    /// The law of friction.
    pub const fn friction(&self) -> &F {
        &self.friction
    }

    /// The number I at a shear rate \[1/s\] and a pressure \[Pa\].
    pub fn number(&self, shear_rate: f64, pressure: f64) -> f64 {
        self.per_rate(pressure) * shear_rate / pressure
    }

    /// The number I times pressure, over the shear rate \[Pa s\].
    #[inline(always)]
    fn per_rate(&self, pressure: f64) -> f64 {
        (self.inertia * pressure + self.viscosity * self.viscosity).sqrt()
    }
}

const GAP: usize = 0;
const PLASTIC: usize = 1;

impl<F: RateFriction> ConstitutiveLaw for MuI<F> {
    type Memory = [f64; 2];

    /// The gap, and the plastic shear strain, that of simple shear.
    const KEPT: &'static [Kept] =
        &[Kept { name: "gap_strain", unit: "1" }, Kept { name: "plastic_strain", unit: "1" }];

    fn start(&self) -> [f64; 2] {
        [0.0; 2]
    }

    #[inline(always)]
    fn respond<A: Axes>(
        &self,
        stress: SymmetricTensor,
        memory: &mut [f64; 2],
        increment: &Increment,
    ) -> Response {
        let (strain, gap) = gap::close(memory[GAP], increment.strain);
        let trial = stress + self.elastic.stress_of(strain);
        let pressure = crate::measures::mean_pressure(trial);
        let separates = pressure < 0.0;
        let pressed = if separates { 0.0 } else { pressure };
        let deviator = trial + SymmetricTensor::IDENTITY * pressure;
        let shear = (0.5 * deviator.contract(deviator)).sqrt();
        let resting = self.friction.at_rest() * pressed;
        let flows = shear > resting;
        let relaxed = self.elastic.shear() * increment.dt;
        let flowing = self.friction.stress(shear, pressed, relaxed, self.per_rate(pressed));
        let after = if flows { flowing } else { shear };
        let scale = after / if shear > 0.0 { shear } else { 1.0 };
        let slipped = trial + deviator * (scale - 1.0);
        // The product keeps what is not finite.
        let nothing = trial * 0.0;
        let changed = crate::mohr_coulomb::select(separates, nothing, slipped);
        let sheared = (shear - after) * (1.0 / self.elastic.shear());
        let opened = -pressure * (1.0 / self.elastic.bulk());
        memory[GAP] = if separates { opened } else { gap };
        memory[PLASTIC] += sheared;
        Response {
            stress: crate::mohr_coulomb::select(flows || separates, changed, trial),
            plastic_work: if flows { resting * sheared } else { 0.0 },
            viscous_work: if flows && !separates { (after - resting) * sheared } else { 0.0 },
        }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _memory: &[f64; 2]) -> f64 {
        self.elastic.energy_at(stress)
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.elastic.compression_speed(density)
    }
}
