//! What a scene says of moving walls, and of grains that come and go.

use super::GradingSpec;
use granular_core::units::{Angle, AngularVelocity, Force, Frequency, Length, Mass, Pressure, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Motion of a wall. A wall that a stage starts waits until then; otherwise it moves from the beginning.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum MotionSpec {
    /// At a constant velocity, one component per axis.
    Steady(Vec<Velocity>),
    /// Oscillation about a mean position, starting where the wall is.
    Oscillate {
        /// Amplitude, one component per axis.
        amplitude: Vec<Length>,
        /// Frequency.
        frequency: Frequency,
        /// Phase of the sine at which it begins.
        #[serde(default)]
        phase: Angle,
    },
    /// Turning about a point or, in space, an axis through it.
    Rotate {
        /// A point of the axis.
        about: Vec<Length>,
        /// Angular velocity: one value, about z, in the plane and three components in space.
        spin: Vec<AngularVelocity>,
    },
    /// Pushed by a force along one direction, as a body with a mass and a dashpot.
    Servo {
        /// Direction of the force on the wall, one number per axis, of any length; the normal of a plane by default.
        #[serde(default)]
        direction: Vec<f64>,
        /// Force on the wall; in the plane per metre of depth.
        #[serde(default)]
        force: Option<Force>,
        /// Pressure on the wall instead of a force.
        #[serde(default)]
        pressure: Option<Pressure>,
        /// Area in m^2 on which the pressure acts; in the plane the length in m.
        #[serde(default)]
        area: Option<f64>,
        /// Instead of a constant area: pairs of names of opposite planes, such as `[["left", "right"]]`. The pressure
        /// acts on the current area between them; one pair in the plane, two in space.
        #[serde(default)]
        between: Vec<Vec<String>>,
        /// Mass of the wall, in the plane per metre of depth; that of all grains by default.
        #[serde(default)]
        mass: Option<Mass>,
        /// Damping in N s/m; by default the root of the mass times the normal stiffness of the material. A wall that
        /// nothing stops moves at a speed of the force over the damping; while it moves, the force on the grains is
        /// reduced by the damping times its speed.
        #[serde(default)]
        damping: Option<f64>,
        /// Largest speed of the wall; unlimited by default.
        #[serde(default)]
        max_speed: Option<Velocity>,
    },
}

/// A box in which grains are inserted where there is room. An inlet that a stage starts waits until then.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InletSpec {
    /// Name, for changes that start or halt it.
    pub name: String,
    /// Corner with the lowest coordinates; whole grains are placed in the box.
    pub low: Vec<Length>,
    /// Corner with the highest coordinates.
    pub high: Vec<Length>,
    /// Grains per second. Those that find no room are counted as `not_placed`.
    pub rate: f64,
    /// Total number of grains; unlimited by default.
    #[serde(default)]
    pub number: Option<u64>,
    /// Sizes of the grains.
    pub grading: GradingSpec,
    /// Name of their material.
    pub material: String,
    /// Their velocity, one component per axis; at rest by default.
    #[serde(default)]
    pub velocity: Vec<Velocity>,
    /// Random seed of sizes and places.
    #[serde(default = "one")]
    pub seed: u64,
}

fn one() -> u64 {
    1
}

/// Where grains are removed. They are counted as `removed`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum OutletSpec {
    /// Where the centre is beyond a plane.
    Beyond {
        /// A point of the plane.
        point: Vec<Length>,
        /// Its normal, which points to the side on which grains are removed.
        normal: Vec<f64>,
    },
    /// Where the centre is outside a box.
    Outside {
        /// Corner with the lowest coordinates.
        low: Vec<Length>,
        /// Corner with the highest coordinates.
        high: Vec<Length>,
    },
}
