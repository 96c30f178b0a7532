//! Contacts between two named materials.

use super::MaterialSpec;
use crate::material::PairOverride;
use granular_core::units::{Damping, Stiffness};
use schemars::JsonSchema;
use serde::Deserialize;

/// The contact between two materials, or between bodies of one: what is given here replaces what would follow from the
/// materials, even when a stage changes their friction.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Pair")]
pub struct PairSpec {
    /// Names of the two materials, in any order, such as `["glass", "steel"]`; one name twice for
    /// contacts between bodies of the same material.
    pub between: Vec<String>,
    /// Normal stiffness, for linear contacts. The tangential one keeps its ratio to it.
    #[serde(default)]
    pub normal_stiffness: Option<Stiffness>,
    /// Tangential over normal stiffness of linear contacts, 0 or more.
    #[serde(default)]
    pub stiffness_ratio: Option<f64>,
    /// Coefficient of restitution of a normal impact, above 0 and at most 1.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// Tangential over normal damping coefficient, 0 or more.
    #[serde(default)]
    pub damping_ratio: Option<f64>,
    /// Damping of the normal dashpot, 0 or more, whatever the masses of the two bodies, for linear contacts: takes the place of
    /// `restitution`.
    #[serde(default)]
    pub normal_damping: Option<Damping>,
    /// Damping of the tangential dashpot, 0 or more, for linear contacts: takes the place of `damping_ratio`.
    #[serde(default)]
    pub tangential_damping: Option<Damping>,
    /// Coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    pub friction: Option<f64>,
    /// Coefficient of rolling resistance, 0 or more.
    #[serde(default)]
    pub rolling_friction: Option<f64>,
    /// Coefficient of resistance against twisting, 0 or more; for spheres.
    #[serde(default)]
    pub twisting_friction: Option<f64>,
}

impl PairSpec {
    /// What is stated.
    pub fn stated(&self) -> PairOverride {
        PairOverride {
            normal_stiffness: self.normal_stiffness.map(|stiffness| stiffness.value()),
            stiffness_ratio: self.stiffness_ratio,
            restitution: self.restitution,
            damping_ratio: self.damping_ratio,
            normal_damping: self.normal_damping.map(|damping| damping.value()),
            tangential_damping: self.tangential_damping.map(|damping| damping.value()),
            friction: self.friction,
            rolling_friction: self.rolling_friction,
            twisting_friction: self.twisting_friction,
        }
    }

    /// The dashpots that are given as constants, which a material does not have; `None` without any.
    pub fn dashpots(&self) -> Option<Self> {
        let Self { normal_damping, tangential_damping, .. } = *self;
        let between = self.between.clone();
        (normal_damping.is_some() || tangential_damping.is_some()).then(|| Self {
            between,
            normal_damping,
            tangential_damping,
            ..Self::default()
        })
    }

    /// A material whose contacts among its own bodies are those stated here, all but [`Self::dashpots`].
    pub fn applied_to(&self, material: MaterialSpec) -> MaterialSpec {
        MaterialSpec {
            normal_stiffness: self.normal_stiffness.or(material.normal_stiffness),
            stiffness_ratio: self.stiffness_ratio.or(material.stiffness_ratio),
            restitution: self.restitution.or(material.restitution),
            damping_ratio: self.damping_ratio.unwrap_or(material.damping_ratio),
            friction: self.friction.unwrap_or(material.friction),
            rolling_friction: self.rolling_friction.unwrap_or(material.rolling_friction),
            twisting_friction: self.twisting_friction.unwrap_or(material.twisting_friction),
            ..material
        }
    }
}
