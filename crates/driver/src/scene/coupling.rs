//! Laws between solvers of a scene.

use schemars::JsonSchema;
use serde::Deserialize;

/// A law between two solvers of the scene, which then share one simulation.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum CouplingSpec {
    /// Each grain carries an obstacle of its size through a fluid: the fluid is pushed aside and flows around it, and does not
    /// act on the grain. The obstacles are called `grain 0`, `grain 1`, ... after the identifiers of the grains.
    Carried {
        /// Name of the solver of the grains.
        grains: String,
        /// Name of the solver of the fluid.
        fluid: String,
        /// Radius of the obstacles over that of the grains; 1 by default.
        #[serde(default = "one")]
        radius: f64,
    },
    /// Grains and the fluid between them move each other: the fluid flows around each grain, which gets its force and torque, with
    /// buoyancy. The pressure of the fluid is then that above the hydrostatic one, in all directions that are not periodic.
    Resolved {
        /// Name of the solver of the grains.
        grains: String,
        /// Name of the solver of the fluid.
        fluid: String,
        /// Hydrodynamic radius over that of the grains, above 0 and at most 1, at which the fluid meets them; 1 by default. Disks
        /// that touch leave no way through, as spheres would: 0.7 to 0.95 stand for the permeability of a bed of spheres. Weights and
        /// buoyancy are those of whole grains.
        #[serde(default = "one")]
        radius: f64,
        /// What grains feel during a step of the fluid.
        #[serde(default)]
        held: HeldLoadSpec,
    },
}

/// The force of the fluid that grains feel during one of its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "HeldLoad")]
pub enum HeldLoadSpec {
    /// That of its last step.
    #[default]
    OneStep,
    /// The mean of its last two steps: what changes its sign from step to step is not felt.
    TwoSteps,
}

fn one() -> f64 {
    1.0
}

impl CouplingSpec {
    /// Solvers with long and with short steps.
    pub fn ends(&self) -> Ends<'_> {
        match self {
            Self::Carried { grains, fluid, .. } | Self::Resolved { grains, fluid, .. } => {
                Ends { slow: ("fluid", fluid), fast: ("grains", grains) }
            }
        }
    }
}

/// The two solvers of a law: the key under which the scene names each, and the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ends<'a> {
    /// The one with long steps.
    pub slow: (&'static str, &'a str),
    /// The one that takes several steps within one of the other.
    pub fast: (&'static str, &'a str),
}
