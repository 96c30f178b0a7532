//! What a scene says of this method (feature `serde`).

mod pair;

pub use pair::PairSpec;

use crate::material::{Elasticity, Material, Tension};
use crate::setup::{ContactModel, LeverArm, Options, SpringTurning};
use granular_core::units::{Density, Length, Pressure, Stiffness, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// The discrete element method; all keys may be left out: `Dem(())`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DemSpec {
    /// How the normal force grows with the overlap.
    pub contact: ContactSpec,
    /// Whether parting contacts may pull.
    pub tension: TensionSpec,
    /// Where contact forces act.
    pub lever_arm: LeverArmSpec,
    /// Steps in the shortest contact time, 1 or more; this sets the step where `time_step` does not.
    pub steps_per_contact: f64,
    /// Largest distance to which neighbour lists reach beyond contact, over the mean diameter; those of slow grains
    /// reach less far. It affects the speed, never the results.
    pub skin: f64,
    /// The step; by default it follows from `steps_per_contact`.
    pub time_step: Option<Time>,
}

/// How the normal force of a contact grows with the overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum ContactSpec {
    /// In proportion: linear springs. Materials state a `normal_stiffness`, or elastic constants
    /// from which one follows.
    #[default]
    Linear,
    /// As between elastic spheres, with friction after Mindlin; restitution does not depend on the
    /// speed. Materials state `young_modulus` and `poisson_ratio`. In the plane a disk has, per
    /// metre of depth, the contact of one sphere of its radius.
    Hertz,
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
            contact: ContactSpec::Linear,
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
            contact: match self.contact {
                ContactSpec::Linear => ContactModel::Linear,
                ContactSpec::Hertz => ContactModel::Hertz,
            },
            tension: match self.tension {
                TensionSpec::Cut => Tension::Cut,
                TensionSpec::Kept => Tension::Kept,
            },
            lever_arm: match self.lever_arm {
                LeverArmSpec::Exact => LeverArm::Exact,
                LeverArmSpec::Radius => LeverArm::Radius,
            },
            spring_turning: SpringTurning::default(),
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
    /// Density of the grains; materials of walls need none.
    #[serde(default = "default_density")]
    pub density: Density,
    /// Normal stiffness between two bodies of this material, for linear contacts. Between two
    /// materials springs act in series. Without it, linear contacts of spheres take `4 E r` from
    /// Young's modulus and the mean radius of the grains, and those of disks the stiffness of
    /// cylinders under the `typical_load`.
    #[serde(default)]
    pub normal_stiffness: Option<Stiffness>,
    /// Young's modulus, for Hertz contacts.
    #[serde(default)]
    pub young_modulus: Option<Pressure>,
    /// Poisson's ratio, above -1 and at most 0.5; given with Young's modulus.
    #[serde(default)]
    pub poisson_ratio: Option<f64>,
    /// Load of a typical contact per metre of depth, for linear contacts of disks whose stiffness
    /// follows from Young's modulus: a contact along a line is stiffer the more it carries.
    #[serde(default)]
    pub typical_load: Option<Stiffness>,
    /// Tangential over normal stiffness of linear contacts, 0 or more. By default 1, or what
    /// follows from Poisson's ratio, `2 (1 - nu)/(2 - nu)`, where the normal stiffness does.
    #[serde(default)]
    pub stiffness_ratio: Option<f64>,
    /// Coefficient of restitution of a normal impact, above 0 and at most 1. Between two materials the lower value
    /// applies. Grains and their walls need it.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// Tangential over normal damping coefficient, 0 or more.
    #[serde(default = "default_damping_ratio")]
    pub damping_ratio: f64,
    /// Coefficient of Coulomb friction, 0 or more. Between two materials the lower value applies.
    pub friction: f64,
    /// Coefficient of rolling resistance, 0 or more. Between two materials the lower value applies.
    #[serde(default)]
    pub rolling_friction: f64,
    /// Coefficient of resistance against twisting, turning about the normal of a contact, 0 or
    /// more; for spheres. Between two materials the lower value applies.
    #[serde(default)]
    pub twisting_friction: f64,
}

fn default_density() -> Density {
    Material::default().density.into()
}

fn default_damping_ratio() -> f64 {
    Material::default().damping_ratio
}

impl MaterialSpec {
    /// Elastic constants, where both are given.
    pub fn elasticity(&self) -> Option<Elasticity> {
        let (young_modulus, poisson_ratio) = self.young_modulus.zip(self.poisson_ratio)?;
        Some(Elasticity { young_modulus: young_modulus.value(), poisson_ratio })
    }
}

impl From<MaterialSpec> for Material {
    /// The normal stiffness is zero where it is not given: it may follow from elastic constants
    /// once the size of the grains is known.
    fn from(spec: MaterialSpec) -> Self {
        let elasticity = spec.elasticity();
        let derived = elasticity.filter(|_| spec.normal_stiffness.is_none());
        Self {
            density: spec.density.value(),
            normal_stiffness: spec.normal_stiffness.map_or(0.0, |stiffness| stiffness.value()),
            elasticity,
            stiffness_ratio: spec.stiffness_ratio.unwrap_or_else(|| {
                derived.map_or(Self::default().stiffness_ratio, |elastic| elastic.stiffness_ratio())
            }),
            // Whoever reads a scene says when it is missing.
            restitution: spec.restitution.unwrap_or(1.0),
            damping_ratio: spec.damping_ratio,
            friction: spec.friction,
            rolling_friction: spec.rolling_friction,
            twisting_friction: spec.twisting_friction,
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
