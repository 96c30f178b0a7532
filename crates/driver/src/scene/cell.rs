//! The periodic cell of a scene of grains, and what drives it.

use granular_core::units::{Frequency, Length, Pressure, Time};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A periodic cell: what leaves it through one face enters through the opposite one.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellSpec {
    /// Which axes are periodic, such as `[true, false]` for a chute with walls below and above. Walls are allowed only
    /// across axes that are not periodic.
    pub periodic: Vec<bool>,
    /// Size, one length per axis; ignored for axes that are not periodic. By default the size that the sample `Cell`
    /// needs.
    #[serde(default)]
    pub size: Vec<Length>,
    /// Lowest corner, one length per axis; the origin by default.
    #[serde(default)]
    pub low: Vec<Length>,
}

/// What drives the cell from here on. A component is named by two axes: `xy` is the velocity along x that grows
/// along y. Components that are not named are held still.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CellChange {
    /// Components of the velocity gradient that are given, such as `{ "xy": "10 1/s" }` for simple shear.
    pub rate: BTreeMap<String, Frequency>,
    /// Components that follow a stress, positive in compression, such as `{ "yy": "1 kPa" }`.
    pub stress: BTreeMap<String, Pressure>,
    /// Period of the response of the cell to a change of stress if the sample were elastic, at critical damping; by
    /// default that of the mean grain oscillating on one contact. A longer period compresses more gently.
    pub response: Option<Time>,
}
