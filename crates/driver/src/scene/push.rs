//! How a push is spread over the grains.

use schemars::JsonSchema;
use serde::Deserialize;

/// How a push is spread over the height of the grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum PushProfileSpec {
    /// The same velocity for all.
    #[default]
    Uniform,
    /// In proportion to the depth below the highest grain: most for the lowest grain, nothing for the highest, as from a quake
    /// along the bottom.
    Gradient,
}
