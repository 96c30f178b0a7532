//! The fluid of a scene, described apart from the method that solves it.

use granular_core::units::{
    Acceleration, AngularVelocity, Density, Frequency, KinematicViscosity, Length, Pressure, Velocity,
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
    /// Largest speed expected. By default the largest one given by faces, obstacles and the start.
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
    /// Body forces that vary in space or time; they are added to gravity. The speed of a flow that they drive is not
    /// known beforehand, so give `largest_speed`. If there are several and one varies both in space and in time, they
    /// cost more than the fluid itself.
    #[serde(default)]
    pub forces: Vec<ForceSpec>,
    /// Points at which pressure and velocity can be written, by names of your choice: the probes `pressure_at_<name>`
    /// and `velocity_at_<name>_x`.
    #[serde(default)]
    pub gauges: BTreeMap<String, Vec<Length>>,
}

fn water() -> Density {
    1000.0.into()
}

/// A body force per mass: its size, times how it varies in space, times how it varies in time.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceSpec {
    /// Its size, one component per axis.
    pub acceleration: Vec<Acceleration>,
    /// How it varies in space.
    #[serde(default)]
    pub in_space: InSpaceSpec,
    /// How it varies in time.
    #[serde(default)]
    pub in_time: InTimeSpec,
}

/// How a force varies in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum InSpaceSpec {
    /// The same everywhere.
    #[default]
    Uniform,
    /// As `sin(2 pi x / wavelength + phase)`, x being the coordinate along an axis.
    Sine {
        /// The axis.
        along: AxisSpec,
        /// Wavelength.
        wavelength: Length,
        /// Phase where the coordinate is zero, in radians.
        #[serde(default)]
        phase: f64,
    },
}

/// How a force varies in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum InTimeSpec {
    /// Not at all.
    #[default]
    Steady,
    /// As `sin(2 pi frequency t + phase)`, t being the time since the start of the run.
    Oscillating {
        /// Frequency.
        frequency: Frequency,
        /// Phase at the start in radians.
        #[serde(default)]
        phase: f64,
    },
}

/// An axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum AxisSpec {
    /// To the right.
    X,
    /// Upwards in the plane, to the back in space.
    Y,
    /// Upwards, in space only.
    Z,
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
    /// What leaves here enters through the opposite face.
    Periodic,
    /// A wall at rest.
    Wall,
    /// A wall that moves along itself, one component per axis.
    MovingWall(Vec<Velocity>),
    /// A wall that moves along itself, fastest in its middle and at rest at its edges, so that a closed box has no jump
    /// of velocity in its corners: the velocity given, one component per axis, times `16 s^2 (1 - s)^2` with s from 0
    /// to 1 along the face; in space the product of two, of which periodic axes have none.
    RegularisedLid(Vec<Velocity>),
    /// A wall along which the fluid slips: its velocity less that of the wall is the slip length times the derivative
    /// of the velocity across the wall.
    NavierSlip {
        /// Slip length.
        length: Length,
        /// Velocity of the wall along itself, one component per axis; at rest by default.
        #[serde(default)]
        velocity: Vec<Velocity>,
    },
    /// No flow through and no friction along the face.
    FreeSlip,
    /// The fluid enters at a velocity.
    Inflow(ProfileSpec),
    /// The fluid leaves, or enters, at a pressure over that at rest, and straight through the face. It reflects all
    /// sound, which can look like vortex shedding for a long time: use Absorbing where a stream leaves.
    Outflow(Pressure),
    /// The fluid leaves, or enters; sound and vortices leave, and the mean pressure over the face settles at this one
    /// over that at rest.
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
    /// How the method represents its surface.
    #[serde(default)]
    pub surface: SurfaceSpec,
    /// Its motion; at rest by default. Only a `Ball` can move.
    #[serde(default)]
    pub path: Option<PathSpec>,
    /// Angular velocity of its surface: one value in the plane, three components in space; zero by default.
    #[serde(default)]
    pub spin: Vec<AngularVelocity>,
    /// Speed and length that make forces the coefficients `drag_coefficient_of_<name>` and
    /// `lift_coefficient_of_<name>`.
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
    /// Everything outside a shape, such as `Hole(Ball(centre: [0, 0], radius: "1 cm"))`: the fluid is inside, as in a
    /// tank. With an obstacle within it, it is an annulus.
    Hole(Box<ShapeSpec>),
}

/// How the method represents the surface of a body. None of them lets mass through.
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

/// A prescribed motion.
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
