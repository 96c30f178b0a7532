//! What scenes say of methods.

#[cfg(feature = "mpm")]
pub use super::mpm::ContinuumSpec;
use super::table::methods;
use crate::scene_file::SceneProblem;
#[cfg(feature = "dem")]
pub use granular_dem::spec::{GrainSpec, MaterialSpec, PairSpec};
use schemars::JsonSchema;
use serde::Deserialize;
#[cfg(not(feature = "mpm"))]
pub use without_continua::ContinuumSpec;
#[cfg(not(feature = "dem"))]
pub use without_grains::{GrainSpec, MaterialSpec, PairSpec};

macro_rules! feature_of {
    () => {
        None
    };
    ($feature:literal) => {
        Some($feature)
    };
}

macro_rules! specs {
    ($($(#[doc = $doc:literal])+ $name:ident($spec:ty) if $key:ident $(= $value:literal)?;)+) => {
        /// The method that solves the scene.
        #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
        pub enum SolverSpec {
            $($(#[doc = $doc])+ #[cfg($key $(= $value)?)] $name($spec),)+
        }

        impl SolverSpec {
            /// What the method is called in a scene.
            pub fn name(&self) -> &'static str {
                match self {
                    $(#[cfg($key $(= $value)?)] Self::$name(_) => stringify!($name),)+
                }
            }
        }

        /// Methods of this program.
        pub fn names() -> Vec<&'static str> {
            vec![$(#[cfg($key $(= $value)?)] stringify!($name),)+]
        }

        /// Methods that are cargo features, and these.
        const FEATURES: &[(&str, Option<&str>)] = &[$((stringify!($name), feature_of!($($value)?)),)+];
    };
}
methods!(specs);

/// Methods that this program was built without, and the cargo feature of each.
pub fn left_out() -> Vec<(&'static str, &'static str)> {
    let here = names();
    let features = FEATURES.iter().filter_map(|(name, feature)| Some((*name, (*feature)?)));
    features.filter(|(name, _)| !here.contains(name)).collect()
}

/// Says of a solver that cannot be read when its method is off.
pub(crate) fn explain(problem: SceneProblem) -> SceneProblem {
    let at_solvers = problem.place.path.as_ref().is_some_and(|path| path.starts_with("solvers"));
    let off = left_out();
    let named = off.iter().find(|(name, _)| at_solvers && problem.message.contains(&format!("`{name}`")));
    match named {
        Some((name, feature)) => problem.with_hint(format!(
            "{name} is there with the cargo feature `{feature}`, without which this program was built"
        )),
        None => problem,
    }
}

/// Stand-in for what only a continuum reads of a scene: anything is taken, and refused as a part that no method uses.
#[cfg(not(feature = "mpm"))]
mod without_continua {
    use schemars::JsonSchema;
    use serde::Deserialize;

    /// A continuum.
    #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct ContinuumSpec {}
}

/// The same for grains.
#[cfg(not(feature = "dem"))]
mod without_grains {
    use schemars::JsonSchema;
    use serde::Deserialize;

    /// A material; of walls of a continuum only the friction is read.
    #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct MaterialSpec {
        /// Coefficient of Coulomb friction.
        pub friction: f64,
    }

    /// A pair of materials.
    #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct PairSpec {}

    /// A grain.
    #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct GrainSpec {}
}
