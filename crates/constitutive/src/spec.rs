//! What a scene says of a continuum (feature `serde`).

use crate::{AnyLaw, ConeMatch, DruckerPrager, LinearElastic, MohrCoulomb, Strength};
use granular_core::SetupError;
use granular_core::units::{Angle, Density, Pressure};
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
    pub law: LawSpec,
}

/// A constitutive law.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LawSpec {
    /// Linear elasticity in rate form.
    LinearElastic {
        /// Young's modulus.
        young_modulus: Pressure,
        /// Poisson's ratio, above -1 and below 0.5.
        poisson_ratio: f64,
    },
    /// Elastic up to the strength of Mohr-Coulomb, then perfectly plastic.
    MohrCoulomb {
        /// Young's modulus.
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
        /// Young's modulus.
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

fn strength(friction: Angle, dilation: Option<Angle>, cohesion: Option<Pressure>) -> Strength {
    Strength {
        friction_angle: friction.value(),
        dilation_angle: dilation.map_or(0.0, |angle| angle.value()),
        cohesion: cohesion.map_or(0.0, |cohesion| cohesion.value()),
    }
}

impl TryFrom<&LawSpec> for AnyLaw {
    type Error = SetupError;

    fn try_from(spec: &LawSpec) -> Result<Self, SetupError> {
        Ok(match *spec {
            LawSpec::LinearElastic { young_modulus, poisson_ratio } => {
                Self::LinearElastic(LinearElastic::new(young_modulus.value(), poisson_ratio)?)
            }
            LawSpec::MohrCoulomb {
                young_modulus,
                poisson_ratio,
                friction_angle,
                dilation_angle,
                cohesion,
                tensile_strength,
            } => {
                let elastic = LinearElastic::new(young_modulus.value(), poisson_ratio)?;
                let law = MohrCoulomb::new(elastic, strength(friction_angle, dilation_angle, cohesion))?;
                match tensile_strength {
                    None => Self::MohrCoulomb(law),
                    Some(tension) => Self::MohrCoulombWithCut(law.with_tensile_strength(tension.value())?),
                }
            }
            LawSpec::DruckerPrager {
                young_modulus,
                poisson_ratio,
                friction_angle,
                dilation_angle,
                cohesion,
                cone,
            } => {
                let elastic = LinearElastic::new(young_modulus.value(), poisson_ratio)?;
                let strength = strength(friction_angle, dilation_angle, cohesion);
                Self::DruckerPrager(DruckerPrager::new(elastic, strength, cone.into())?)
            }
        })
    }
}
