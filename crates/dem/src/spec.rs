//! What a scene says of this method (feature `serde`).

use crate::material::{Material, Tension};
use crate::setup::{LeverArm, Options};
use granular_core::units::{Density, Length, Stiffness, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// The discrete element method; all keys may be left out: `Dem(())`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DemSpec {
    /// Whether parting contacts may pull.
    pub tension: TensionSpec,
    /// Where contact forces act.
    pub lever_arm: LeverArmSpec,
    /// Steps in the shortest contact time, 1 or more; this sets the step where `time_step` does not.
    pub steps_per_contact: f64,
    /// How far beyond contact neighbour lists reach, over the mean diameter. It changes the speed,
    /// never the forces.
    pub skin: f64,
    /// The step; by default it follows from `steps_per_contact`.
    pub time_step: Option<Time>,
}

/// Whether contacts that part may pull, which a dashpot does at the end of an impact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum TensionSpec {
    /// Contacts never attract.
    #[default]
    Cut,
    /// A parting contact may pull until its overlap ends.
    Kept,
}

/// Where contact forces act on the grains, which decides their torques.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum LeverArmSpec {
    /// At the middle of the overlap: angular momentum is kept to round-off.
    #[default]
    Exact,
    /// At the radius, as in the thesis.
    Radius,
}

impl Default for DemSpec {
    fn default() -> Self {
        let options = Options::default();
        Self {
            tension: TensionSpec::Cut,
            lever_arm: LeverArmSpec::Exact,
            steps_per_contact: options.steps_per_contact,
            skin: options.skin,
            time_step: None,
        }
    }
}

impl DemSpec {
    /// The choices of the method; `ledger` when an output asks for losses of energy.
    pub fn options(&self, ledger: bool) -> Options {
        Options {
            tension: match self.tension {
                TensionSpec::Cut => Tension::Cut,
                TensionSpec::Kept => Tension::Kept,
            },
            lever_arm: match self.lever_arm {
                LeverArmSpec::Exact => LeverArm::Exact,
                LeverArmSpec::Radius => LeverArm::Radius,
            },
            ledger,
            steps_per_contact: self.steps_per_contact,
            skin: self.skin,
        }
    }
}

/// What a grain or wall is made of.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Density of the grains; a material of walls needs none.
    #[serde(default = "default_density")]
    pub density: Density,
    /// Normal stiffness between two bodies of this material. Between two materials springs act
    /// in series.
    pub normal_stiffness: Stiffness,
    /// Tangential over normal stiffness, 0 or more.
    #[serde(default = "default_stiffness_ratio")]
    pub stiffness_ratio: f64,
    /// Coefficient of restitution of a normal impact, above 0 and at most 1. Between two
    /// materials the lower one holds.
    pub restitution: f64,
    /// Tangential over normal damping coefficient, 0 or more.
    #[serde(default = "default_damping_ratio")]
    pub damping_ratio: f64,
    /// Coefficient of Coulomb friction, 0 or more. Between two materials the lower one holds.
    pub friction: f64,
    /// Coefficient of rolling resistance, 0 or more. Between two materials the lower one holds.
    #[serde(default)]
    pub rolling_friction: f64,
}

fn default_density() -> Density {
    Material::default().density.into()
}

fn default_stiffness_ratio() -> f64 {
    Material::default().stiffness_ratio
}

fn default_damping_ratio() -> f64 {
    Material::default().damping_ratio
}

impl From<MaterialSpec> for Material {
    fn from(spec: MaterialSpec) -> Self {
        Self {
            density: spec.density.value(),
            normal_stiffness: spec.normal_stiffness.value(),
            stiffness_ratio: spec.stiffness_ratio,
            restitution: spec.restitution,
            damping_ratio: spec.damping_ratio,
            friction: spec.friction,
            rolling_friction: spec.rolling_friction,
        }
    }
}

/// One grain.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainSpec {
    /// Centre, one length per axis.
    pub position: Vec<Length>,
    /// Radius, above 0.
    pub radius: Length,
    /// Velocity, one component per axis; at rest by default.
    #[serde(default)]
    pub velocity: Vec<granular_core::units::Velocity>,
    /// Angular velocity: one value, about z, in the plane and three components in space; none by
    /// default.
    #[serde(default)]
    pub spin: Vec<granular_core::units::AngularVelocity>,
    /// Name of its material.
    pub material: String,
}
