//! What a scene says of regions to which a sample is cut.

use granular_core::units::Length;
use schemars::JsonSchema;
use serde::Deserialize;

/// A region of the plane or of space. A sample that is cut to it keeps the grains that lie wholly inside.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum RegionSpec {
    /// A box with edges along the axes.
    Box {
        /// Corner with the lowest coordinates.
        low: Vec<Length>,
        /// Corner with the highest coordinates.
        high: Vec<Length>,
    },
    /// A half-space.
    HalfSpace {
        /// A point on its face, one length per axis.
        point: Vec<Length>,
        /// Normal of its face, which points inside; one number per axis, of any length.
        normal: Vec<f64>,
    },
    /// A cylinder; in space only.
    Cylinder {
        /// Middle of one end.
        from: Vec<Length>,
        /// Middle of the other end.
        to: Vec<Length>,
        /// Radius.
        radius: Length,
    },
}
