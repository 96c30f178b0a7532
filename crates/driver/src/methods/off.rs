//! Methods that this program was built without.

use crate::scene_file::SceneProblem;

/// Says of a solver that cannot be read when its method is off.
pub(crate) fn explain(problem: SceneProblem) -> SceneProblem {
    let at_solvers = problem.place.path.as_ref().is_some_and(|path| path.starts_with("solvers"));
    let off = super::left_out();
    let named = off.iter().find(|(name, _)| at_solvers && problem.message.contains(&format!("`{name}`")));
    match named {
        Some((name, feature)) => problem.with_hint(format!(
            "{name} is there with the cargo feature `{feature}`, without which this program was built"
        )),
        None => problem,
    }
}

/// Stand-ins for what only grains read of a scene: anything is taken, and refused as a part that no method uses.
#[cfg(not(feature = "dem"))]
mod unread {
    use schemars::JsonSchema;
    use serde::Deserialize;

    /// A material.
    #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct MaterialSpec {}

    /// A pair of materials.
    #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct PairSpec {}

    /// A grain.
    #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
    pub struct GrainSpec {}
}

#[cfg(not(feature = "dem"))]
pub(crate) use unread::{GrainSpec, MaterialSpec, PairSpec};
