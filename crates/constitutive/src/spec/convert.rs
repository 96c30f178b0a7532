//! From what a scene says to laws.

use super::{ConeSpec, ConstitutiveLawSpec, FrictionSpec, GrainsSpec};
use crate::{
    AnyLaw, Bingham, ConeMatch, DruckerPrager, Grains, LinearElastic, LinearFriction, MohrCoulomb, MuI,
    Newtonian, NorSand, NorSandConstants, NorSandState, PressureElastic, SaturatingFriction, Strength, Tait,
};
use granular_core::SetupError;
use granular_core::units::{Angle, Pressure, Velocity};

impl From<ConeSpec> for ConeMatch {
    fn from(spec: ConeSpec) -> Self {
        match spec {
            ConeSpec::PlaneStrain => Self::PlaneStrain,
            ConeSpec::PlaneStrainDilation => Self::PlaneStrainDilation,
            ConeSpec::Compression => Self::Compression,
            ConeSpec::Extension => Self::Extension,
        }
    }
}

impl From<GrainsSpec> for Grains {
    fn from(spec: GrainsSpec) -> Self {
        match spec {
            GrainsSpec::Dry { diameter, density } => {
                Self::Dry { diameter: diameter.value(), density: density.value() }
            }
            GrainsSpec::InLiquid { viscosity } => Self::InLiquid { viscosity: viscosity.value() },
        }
    }
}

fn strength(friction: Angle, dilation: Option<Angle>, cohesion: Option<Pressure>) -> Strength {
    Strength {
        friction_angle: friction.value(),
        dilation_angle: dilation.map_or(0.0, |angle| angle.value()),
        cohesion: cohesion.map_or(0.0, |cohesion| cohesion.value()),
    }
}

fn elastic(young_modulus: Pressure, poisson_ratio: f64) -> Result<LinearElastic, SetupError> {
    LinearElastic::new(young_modulus.value(), poisson_ratio)
}

fn mohr_coulomb(
    elastic: LinearElastic,
    strength: Strength,
    tensile_strength: Option<Pressure>,
) -> Result<AnyLaw, SetupError> {
    let law = MohrCoulomb::new(elastic, strength)?;
    match tensile_strength.map(|tension| tension.value()) {
        None => Ok(law.into()),
        // Dry grains carry none as they are.
        Some(0.0) if strength.apex() == 0.0 => Ok(law.into()),
        Some(tension) => law.with_tensile_strength(tension).map(AnyLaw::from),
    }
}

fn mu_i(elastic: LinearElastic, friction: FrictionSpec, grains: Grains) -> Result<AnyLaw, SetupError> {
    match friction {
        FrictionSpec::Linear { at_rest, growth } => {
            MuI::new(elastic, LinearFriction::new(at_rest, growth)?, grains).map(AnyLaw::from)
        }
        FrictionSpec::Saturating { at_rest, greatest, number } => {
            MuI::new(elastic, SaturatingFriction::new(at_rest, greatest, number)?, grains).map(AnyLaw::from)
        }
    }
}

/// The image pressure of sand that was pressed before.
fn image_pressure(pressed: Pressure, coupling: f64) -> Result<f64, SetupError> {
    if pressed.value() > 0.0 {
        return Ok(NorSand::image_pressure(pressed.value(), coupling));
    }
    Err(SetupError::new("preconsolidation pressure", pressed.value(), "above 0 Pa"))
}

fn state(density: f64, sound_speed: Velocity, tension: bool) -> Result<Tait, SetupError> {
    let state = Tait::new(density, sound_speed.value())?;
    Ok(if tension { state } else { state.without_tension() })
}

impl AnyLaw {
    /// The law that a scene asks for, of a material with a density \[kg/m^3\] at the start, which only fluids use.
    ///
    /// # Errors
    /// When a value is out of its range; the error says which, and what is allowed.
    pub fn from_spec(spec: &ConstitutiveLawSpec, density: f64) -> Result<Self, SetupError> {
        match *spec {
            ConstitutiveLawSpec::LinearElastic { young_modulus, poisson_ratio } => {
                elastic(young_modulus, poisson_ratio).map(Self::from)
            }
            ConstitutiveLawSpec::MohrCoulomb {
                young_modulus,
                poisson_ratio,
                friction_angle,
                dilation_angle,
                cohesion,
                tensile_strength,
            } => mohr_coulomb(
                elastic(young_modulus, poisson_ratio)?,
                strength(friction_angle, dilation_angle, cohesion),
                tensile_strength,
            ),
            ConstitutiveLawSpec::DruckerPrager {
                young_modulus,
                poisson_ratio,
                friction_angle,
                dilation_angle,
                cohesion,
                cone,
            } => {
                let strength = strength(friction_angle, dilation_angle, cohesion);
                DruckerPrager::new(elastic(young_modulus, poisson_ratio)?, strength, cone.into())
                    .map(Self::from)
            }
            ConstitutiveLawSpec::MuI { young_modulus, poisson_ratio, friction, grains } => {
                mu_i(elastic(young_modulus, poisson_ratio)?, friction, grains.into())
            }
            ConstitutiveLawSpec::NorSand {
                shear_modulus,
                reference_pressure,
                poisson_ratio,
                exponent,
                greatest_pressure,
                critical_ratio,
                critical_void_ratio,
                critical_slope,
                coupling,
                dilation_limit,
                hardening,
                void_ratio,
                preconsolidation_pressure,
            } => {
                let (shear, reference) = (shear_modulus.value(), reference_pressure.value());
                let greatest = greatest_pressure.value();
                let elastic = PressureElastic::new(shear, reference, poisson_ratio, exponent, greatest)?;
                let constants = NorSandConstants {
                    critical_ratio,
                    critical_void_ratio,
                    critical_slope,
                    coupling,
                    dilation_limit,
                    hardening,
                };
                let image_pressure = image_pressure(preconsolidation_pressure, coupling)?;
                NorSand::new(elastic, constants, NorSandState { void_ratio, image_pressure }).map(Self::from)
            }
            ConstitutiveLawSpec::Newtonian { viscosity, sound_speed, tension } => {
                Newtonian::new(viscosity.value(), state(density, sound_speed, tension)?).map(Self::from)
            }
            ConstitutiveLawSpec::Bingham {
                viscosity,
                yield_stress,
                smoothing_time,
                sound_speed,
                tension,
            } => {
                let state = state(density, sound_speed, tension)?;
                Bingham::new(viscosity.value(), yield_stress.value(), smoothing_time.value(), state)
                    .map(Self::from)
            }
        }
    }
}
