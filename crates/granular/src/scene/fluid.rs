//! The fluid of a scene, described apart from the method that solves it.

use granular_core::units::{
    AngularVelocity, Density, Frequency, KinematicViscosity, Length, Pressure, Velocity,
};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A fluid in a box.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluidSpec {
    /// Lowest corner of the box, one length per axis; zero by default.
    #[serde(default)]
    pub low: Vec<Length>,
    /// Size of the box, one length per axis.
    pub size: Vec<Length>,
    /// Kinematic viscosity.
    pub viscosity: KinematicViscosity,
    /// Density; that of water by default.
    #[serde(default = "water")]
    pub density: Density,
    /// Largest speed that is expected. By default the largest that faces, obstacles and the start name.
    #[serde(default)]
    pub largest_speed: Option<Velocity>,
    /// What bounds the box.
    #[serde(default)]
    pub faces: FacesSpec,
    /// Bodies in the fluid.
    #[serde(default)]
    pub obstacles: Vec<ObstacleSpec>,
    /// How it moves at the start.
    #[serde(default)]
    pub start: StartSpec,
    /// Points at which pressure and velocity can be written, by names of your choice: the probes `pressure_at_<name>` and
    /// `velocity_at_<name>_x`.
    #[serde(default)]
    pub gauges: BTreeMap<String, Vec<Length>>,
}

fn water() -> Density {
    1000.0.into()
}

/// Faces of the box. A pair of opposite faces that is left out is periodic.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FacesSpec {
    /// Low x.
    pub left: Option<FaceSpec>,
    /// High x.
    pub right: Option<FaceSpec>,
    /// Low y, in space only.
    pub front: Option<FaceSpec>,
    /// High y, in space only.
    pub back: Option<FaceSpec>,
    /// Low y in the plane, low z in space.
    pub bottom: Option<FaceSpec>,
    /// High y in the plane, high z in space.
    pub top: Option<FaceSpec>,
}

/// A face of the box.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FaceSpec {
    /// What leaves here enters through the face opposite.
    Periodic,
    /// A wall at rest.
    Wall,
    /// A wall that moves along itself, one component per axis.
    MovingWall(Vec<Velocity>),
    /// No flow through and no friction along the face.
    FreeSlip,
    /// The fluid enters at a velocity.
    Inflow(ProfileSpec),
    /// The fluid leaves, or enters, at a pressure over that at rest, and straight through the face. Sound comes back.
    Outflow(Pressure),
    /// Sound leaves, and the pressure settles at this one over that at rest.
    Absorbing(Pressure),
}

/// Velocities on a face.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ProfileSpec {
    /// The same everywhere, one component per axis.
    Uniform(Vec<Velocity>),
    /// Straight into the box: a parabola between the edges of the face, in space the product of two.
    Parabola {
        /// Largest speed.
        peak: Velocity,
    },
}

/// A body in the fluid.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleSpec {
    /// Name, for probes such as `force_on_<name>_x`.
    pub name: String,
    /// Shape and place.
    pub shape: ShapeSpec,
    /// How the method meets its surface.
    #[serde(default)]
    pub surface: SurfaceSpec,
    /// How it moves; at rest by default. Only a `Ball` moves.
    #[serde(default)]
    pub path: Option<PathSpec>,
    /// How its surface turns: one value in the plane, three components in space; not at all by default.
    #[serde(default)]
    pub spin: Vec<AngularVelocity>,
    /// What forces are set over in `drag_coefficient_of_<name>` and `lift_coefficient_of_<name>`.
    #[serde(default)]
    pub reference: Option<ReferenceSpec>,
}

/// Speed and length that make numbers without dimension.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceSpec {
    /// Speed, such as the mean one of the stream.
    pub speed: Velocity,
    /// Length, such as the diameter; in space the root of an area.
    pub length: Length,
}

/// A shape.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ShapeSpec {
    /// A disk or sphere.
    Ball {
        /// Centre, one length per axis.
        centre: Vec<Length>,
        /// Radius.
        radius: Length,
    },
    /// A block with edges along the axes.
    Block {
        /// Corner with the lowest coordinates.
        low: Vec<Length>,
        /// Corner with the highest coordinates.
        high: Vec<Length>,
    },
    /// A polygon in the plane, its corners in order around it.
    Polygon(Vec<Vec<Length>>),
}

/// How the surface of a body is met. No choice lets mass through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum SurfaceSpec {
    /// Where it is, by linear interpolation in two cases (Bouzidi, Firdaouss and Lallemand).
    #[default]
    Interpolated,
    /// Where it is, by one formula (Yu, Mei, Luo and Shyy; eq. 5.51 of the thesis).
    Yu,
    /// As steps half-way between cells: of first order for a curved surface.
    HalfWay,
}

/// A motion known beforehand.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum PathSpec {
    /// At a velocity, one component per axis.
    Steady(Vec<Velocity>),
    /// About its place: displacement `amplitude sin(2 pi frequency t + phase)`.
    Oscillation {
        /// Largest displacement, one length per axis.
        amplitude: Vec<Length>,
        /// Frequency.
        frequency: Frequency,
        /// Phase at the start in radians.
        #[serde(default)]
        phase: f64,
    },
    /// On a circle about a centre.
    Orbit {
        /// Centre, one length per axis.
        centre: Vec<Length>,
        /// Angular velocity: one value in the plane, three components in space.
        rate: Vec<AngularVelocity>,
    },
}

/// How the fluid moves at the start.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum StartSpec {
    /// Not at all.
    #[default]
    Rest,
    /// Everywhere at one velocity, one component per axis.
    Uniform(Vec<Velocity>),
    /// Everywhere as at the left face, which must be an `Inflow`.
    LikeInflow,
}
