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
}

fn one() -> f64 {
    1.0
}

impl CouplingSpec {
    /// Solvers with long and with short steps.
    pub fn ends(&self) -> Ends<'_> {
        match self {
            Self::Carried { grains, fluid, .. } => Ends { slow: ("fluid", fluid), fast: ("grains", grains) },
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
