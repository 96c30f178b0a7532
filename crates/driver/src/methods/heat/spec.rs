//! What a scene says of the toy.

use granular_core::units::Length;
use schemars::JsonSchema;
use serde::Deserialize;

/// Diffusion of a temperature that begins as one wave along x.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatSpec {
    /// Edge of the square.
    pub size: Length,
    /// Cells along an edge.
    pub cells: usize,
    /// Diffusivity \[m^2/s\].
    pub diffusivity: f64,
}
