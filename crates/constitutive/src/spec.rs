//! What a scene says of a continuum (feature `serde`).

mod convert;
#[cfg(test)]
mod tests;

use granular_core::units::{Angle, Density, Length, Pressure, Time, Velocity, Viscosity};
use schemars::JsonSchema;
use serde::Deserialize;

/// What a material is as a continuum.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContinuumSpec {
    /// Density of the bulk at the start. Where the sample is a column of grains of this material it follows from theirs.
    #[serde(default)]
    pub density: Option<Density>,
    /// How it answers to strain.
    pub law: ConstitutiveLawSpec,
}

/// A constitutive law.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ConstitutiveLawSpec {
    /// Linear elasticity in rate form.
    LinearElastic {
        /// Young's modulus, above 0.
        young_modulus: Pressure,
        /// Poisson's ratio, above -1 and below 0.5.
        poisson_ratio: f64,
    },
    /// Elastic up to the strength of Mohr-Coulomb, then perfectly plastic: dry or cohesive soil in slow flow.
    MohrCoulomb {
        /// Young's modulus, above 0.
        young_modulus: Pressure,
        /// Poisson's ratio, above -1 and below 0.5.
        poisson_ratio: f64,
        /// Angle of friction, 0 or more and less than a right angle: "23.2 deg".
        friction_angle: Angle,
        /// Angle of dilation, up to that of friction; none by default.
        #[serde(default)]
        dilation_angle: Option<Angle>,
        /// Cohesion; none by default.
        #[serde(default)]
        cohesion: Option<Pressure>,
        /// Greatest tension in any direction; by default that of the apex, cohesion over the tangent of the angle of friction.
        #[serde(default)]
        tensile_strength: Option<Pressure>,
    },
    /// Elastic up to a cone, then perfectly plastic.
    DruckerPrager {
        /// Young's modulus, above 0.
        young_modulus: Pressure,
        /// Poisson's ratio, above -1 and below 0.5.
        poisson_ratio: f64,
        /// Angle of friction, 0 or more and less than a right angle.
        friction_angle: Angle,
        /// Angle of dilation, up to that of friction; none by default.
        #[serde(default)]
        dilation_angle: Option<Angle>,
        /// Cohesion; none by default.
        #[serde(default)]
        cohesion: Option<Pressure>,
        /// Where the cone has the strength of Mohr-Coulomb.
        #[serde(default)]
        cone: ConeSpec,
    },
    /// Grains whose friction grows with the rate.
    MuI {
        /// Young's modulus, above 0.
        young_modulus: Pressure,
        /// Poisson's ratio, above -1 and below 0.5.
        poisson_ratio: f64,
        /// How friction grows with the number I.
        friction: FrictionSpec,
        /// What the rate is compared with.
        grains: GrainsSpec,
    },
    /// Sand whose strength follows from its density and pressure.
    NorSand {
        /// Shear modulus at the reference pressure, above 0.
        shear_modulus: Pressure,
        /// Pressure at which the shear modulus is given; 100 kPa by default.
        #[serde(default = "default_reference_pressure")]
        reference_pressure: Pressure,
        /// Poisson's ratio, above -1 and below 0.5.
        poisson_ratio: f64,
        /// Exponent of pressure in the moduli, from 0 to less than 1; 0.5 by default.
        #[serde(default = "default_exponent")]
        exponent: f64,
        /// Pressure up to which the moduli grow; it decides the step.
        greatest_pressure: Pressure,
        /// Critical stress ratio M in triaxial compression, above 0 and below 3.
        critical_ratio: f64,
        /// Critical void ratio at 1 kPa, above 0.
        critical_void_ratio: f64,
        /// Slope of the critical void ratio over the natural logarithm of pressure, 0 or more.
        critical_slope: f64,
        /// Coupling N of work, from 0 to less than 1; 0.3 by default.
        #[serde(default = "default_coupling")]
        coupling: f64,
        /// Limit of dilation, 0 or more; 3.5 by default.
        #[serde(default = "default_dilation_limit")]
        dilation_limit: f64,
        /// Plastic hardening, above 0.
        hardening: f64,
        /// Void ratio at the start, above 0.
        void_ratio: f64,
        /// Greatest pressure that pressed the sand from all sides before, above 0.
        preconsolidation_pressure: Pressure,
    },
    /// A fluid with one viscosity.
    Newtonian {
        /// Dynamic viscosity, 0 or more.
        viscosity: Viscosity,
        /// Speed of sound, above 0: ten times the fastest flow keeps changes of density near one percent.
        sound_speed: Velocity,
        /// Whether the fluid carries tension; by default it comes apart.
        #[serde(default)]
        tension: bool,
    },
    /// A fluid with a yield stress.
    Bingham {
        /// Plastic viscosity, 0 or more.
        viscosity: Viscosity,
        /// Yield stress, 0 or more.
        yield_stress: Pressure,
        /// Time over which the yield stress is smoothed, above 0: below the yield stress the fluid creeps with the viscosity
        /// `viscosity + smoothing_time * yield_stress`, which limits the step.
        smoothing_time: Time,
        /// Speed of sound, above 0: ten times the fastest flow keeps changes of density near one percent.
        sound_speed: Velocity,
        /// Whether the fluid carries tension; by default it comes apart.
        #[serde(default)]
        tension: bool,
    },
}

/// Where a cone has the strength of Mohr-Coulomb.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum ConeSpec {
    /// At collapse in plane strain, where dilation is as large as friction.
    #[default]
    PlaneStrain,
    /// At collapse in plane strain with the angle of dilation given.
    PlaneStrainDilation,
    /// In triaxial compression.
    Compression,
    /// In triaxial extension.
    Extension,
}

/// How friction grows with the number I.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FrictionSpec {
    /// `at_rest + growth * I`.
    Linear {
        /// Friction coefficient at rest, above 0.
        at_rest: f64,
        /// Growth, 0 or more.
        growth: f64,
    },
    /// `at_rest + (greatest - at_rest) / (1 + number / I)`.
    Saturating {
        /// Friction coefficient at rest, above 0.
        at_rest: f64,
        /// Friction coefficient of very fast flow, no less than that at rest.
        greatest: f64,
        /// The number I at which half of the growth is reached, above 0.
        number: f64,
    },
}

/// What the rate is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum GrainsSpec {
    /// Dry grains: the inertial number.
    Dry {
        /// Mean diameter, above 0.
        diameter: Length,
        /// Density of the grains, not of the bulk, above 0.
        density: Density,
    },
    /// Grains in a liquid: the viscous number.
    InLiquid {
        /// Dynamic viscosity of the liquid, above 0.
        viscosity: Viscosity,
    },
}

fn default_reference_pressure() -> Pressure {
    100e3.into()
}

const fn default_exponent() -> f64 {
    0.5
}

const fn default_coupling() -> f64 {
    0.3
}

const fn default_dilation_limit() -> f64 {
    3.5
}
