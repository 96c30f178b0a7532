//! The scene: one file that describes a granular problem once.
//!
//! These types are what a scene file may say. `docs/scene-reference.md` is generated from them.

pub mod boundaries;
pub mod cell;
pub mod coupling;
pub(crate) mod files;
pub mod fluid;
pub mod names;
pub mod outputs;
pub mod push;
pub mod region;
mod walls;

pub use outputs::{Chosen, EverySpec, FigureSpec, GridSpec, Output, ReferenceCurve, Writer};

pub use crate::methods::specs::SolverSpec;
use crate::methods::specs::{ContinuumSpec, GrainSpec, MaterialSpec, PairSpec};
use boundaries::{InletSpec, MotionSpec, OutletSpec};
use cell::{CellChange, CellSpec};
use coupling::CouplingSpec;
use fluid::FluidSpec;
use granular_core::units::{Acceleration, AngularVelocity, Energy, Frequency, Length, Time, Velocity};
use push::PushProfileSpec;
use region::RegionSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A granular problem: the whole file, `Scene(...)`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of this format: 1.
    pub version: u32,
    /// Whether grains are disks or spheres.
    pub dimension: Dimension,
    /// One line about the scene, for figures and reports.
    #[serde(default)]
    pub title: String,
    /// Gravity along each axis, such as `[0.0, -9.81]`; none by default. On a fluid it acts as a force that drives it.
    #[serde(default)]
    pub gravity: Vec<Acceleration>,
    /// Materials of grains and walls, by names of your choice.
    #[serde(default)]
    pub materials: BTreeMap<String, MaterialSpec>,
    /// Laws of continua, by the names of materials: what a sample of this material is when a method takes it as a continuum.
    #[serde(default)]
    pub continua: BTreeMap<String, ContinuumSpec>,
    /// Contacts between two materials whose properties are given instead of mixed from both; none by default.
    #[serde(default)]
    pub pairs: Vec<PairSpec>,
    /// The grains, or the continuum in their place, described apart from the method.
    #[serde(default)]
    pub sample: Option<Sample>,
    /// The fluid, described apart from the method.
    #[serde(default)]
    pub fluid: Option<FluidSpec>,
    /// The periodic cell around the grains; none by default.
    #[serde(default)]
    pub cell: Option<CellSpec>,
    /// Walls of grains and continua; none by default.
    #[serde(default)]
    pub walls: Vec<WallSpec>,
    /// Boxes in which grains are inserted during the run; none by default.
    #[serde(default)]
    pub inlets: Vec<InletSpec>,
    /// Where grains are removed during the run; nowhere by default.
    #[serde(default)]
    pub outlets: Vec<OutletSpec>,
    /// The stages of the run, in order.
    pub stages: Vec<Stage>,
    /// The methods, under names of your choice, such as `{ "grains": Dem(()) }` or
    /// `{ "water": Lbm((spacing: "1 mm")) }`. Several must be joined by `couplings`.
    pub solvers: BTreeMap<String, SolverSpec>,
    /// Laws between solvers; none by default.
    #[serde(default)]
    pub couplings: Vec<CouplingSpec>,
    /// What to write during the run.
    #[serde(default)]
    pub outputs: Vec<Output>,
    /// Figures made at the end of the run.
    #[serde(default)]
    pub figures: Vec<FigureSpec>,
    /// Wall-clock time between snapshots, from which `granular resume` continues; one is also taken at the start of
    /// every stage and on interruption.
    #[serde(default = "default_snapshot_interval")]
    pub snapshot_every: Time,
    /// Folder of the scene file, from which paths of files to read count.
    #[serde(skip)]
    pub folder: std::path::PathBuf,
}

fn default_snapshot_interval() -> Time {
    60.0.into()
}

/// Plane or space: how many components positions and velocities have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Dimension {
    /// The plane, x to the right and y up; grains are disks, and everything is per metre of depth.
    Plane,
    /// Space, z up; grains are spheres.
    Space,
}

/// What is there at the start: grains, or a continuum of the same outline.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Sample {
    /// A column that stands on y = 0 (z = 0 in space) with its left side at x = 0.
    Column {
        /// Size of the column, as a number of grains or a width.
        extent: Extent,
        /// Height over width of the packed column; `Loose` stands up to twice as high before it settles.
        aspect_ratio: f64,
        /// Depth along y over the width: needed in space, not allowed in the plane.
        #[serde(default)]
        depth_ratio: Option<f64>,
        /// Sizes of the grains; a continuum without a count of grains needs none.
        #[serde(default)]
        grading: Option<GradingSpec>,
        /// Name of the material.
        material: String,
        /// How the grains are placed; a continuum needs no packing.
        #[serde(default)]
        packing: Option<PackingSpec>,
        /// Random seed of sizes and places: the same seed gives the same sample.
        #[serde(default = "default_seed")]
        seed: u64,
    },
    /// A cylinder, or half of one, that stands on z = 0 about the axis x = y = 0; in space only.
    Cylinder {
        /// Size of the cylinder, as a number of grains or a width, which is its diameter.
        extent: Extent,
        /// Initial height over radius.
        aspect_ratio: f64,
        /// Whether only its half with y above 0 is made.
        #[serde(default)]
        half: bool,
        /// Sizes of the grains; a continuum without a count of grains needs none.
        #[serde(default)]
        grading: Option<GradingSpec>,
        /// Name of the material.
        material: String,
        /// How the grains are placed: Loose or Hexagonal; a continuum needs no packing.
        #[serde(default)]
        packing: Option<PackingSpec>,
        /// Random seed of sizes and places: the same seed gives the same sample.
        #[serde(default = "default_seed")]
        seed: u64,
    },
    /// Grains scattered in the periodic cell of the scene, which is made a square or cube, to be compressed by a stage.
    Cell {
        /// Number of grains.
        grains: usize,
        /// Initial area or volume of the grains over that of the cell; grains must not overlap.
        solid_fraction: f64,
        /// Sizes of the grains.
        grading: GradingSpec,
        /// Name of the material of the grains.
        material: String,
        /// Random seed of sizes and places: the same seed gives the same sample.
        #[serde(default = "default_seed")]
        seed: u64,
    },
    /// Grains one by one.
    Grains(Vec<GrainSpec>),
    /// Bodies of a continuum by their outlines.
    Bodies(Vec<BodySpec>),
    /// Grains that a stage of another scene saved; their materials must be materials of this scene.
    File {
        /// The file; its path counts from the folder of the scene.
        path: String,
        /// Only grains wholly inside all these regions are taken; all by default. If the shift moves a Box to the
        /// origin, the sample is a column, which may have a Gate.
        #[serde(default)]
        cut: Vec<RegionSpec>,
        /// Shift of the grains after the cut, one length per axis; none by default.
        #[serde(default)]
        shift: Vec<Length>,
        /// Whether the grains keep the motion that was saved; they are at rest by default.
        #[serde(default)]
        moving: bool,
    },
}

fn default_seed() -> u64 {
    1
}

/// A body of a continuum.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    /// Its outline.
    pub shape: fluid::ShapeSpec,
    /// Name of its material.
    pub material: String,
    /// Velocity, one component per axis; at rest by default.
    #[serde(default)]
    pub velocity: Vec<granular_core::units::Velocity>,
}

/// Size of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum Extent {
    /// By its number of grains; the width follows.
    Grains(usize),
    /// By its width; the number of grains follows.
    Width(Length),
}

/// Sizes of grains.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum GradingSpec {
    /// One diameter.
    Single(Length),
    /// Diameters between `min` and `max` whose share of area (plane) or volume (space) follows the
    /// beta distribution.
    Beta {
        /// Smallest diameter.
        min: Length,
        /// Largest diameter.
        max: Length,
        /// First shape parameter.
        a: f64,
        /// Second shape parameter.
        b: f64,
    },
    /// The same area (plane) or volume (space) in every interval of diameter.
    EqualMass {
        /// Smallest diameter.
        min: Length,
        /// Largest diameter.
        max: Length,
    },
}

/// How grains are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum PackingSpec {
    /// One by one, each rolling down to two supports (plane only).
    Ballistic,
    /// On a hexagonal lattice (one size only).
    Hexagonal,
    /// Loosely on a regular lattice, to be settled by a stage.
    Loose,
}

/// A wall.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum WallSpec {
    /// The plane y = 0 (z = 0 in space) below the sample, called `floor`.
    Floor {
        /// Name of the material.
        material: String,
    },
    /// The plane x = 0 left of the sample, called `left`.
    Left {
        /// Name of the material.
        material: String,
    },
    /// The plane right of a column, called `right`.
    Right {
        /// Name of the material.
        material: String,
    },
    /// The plane right of a column, or the tube around a cylinder, called `gate`, which is removed at the start of a
    /// stage.
    Gate {
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start the gate opens.
        opens: String,
    },
    /// Planes in front of and behind a column in space, called `front` and `back`; for half a cylinder the plane of its
    /// flat face, `front`.
    Sides {
        /// Name of the material.
        material: String,
    },
    /// A plane anywhere. Grains are on the side to which its normal points.
    Plane {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// A point on it, one length per axis.
        point: Vec<Length>,
        /// Its normal, one number per axis, of any length.
        normal: Vec<f64>,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// A straight line between two points, with grains on both sides.
    Segment {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// One end.
        from: Vec<Length>,
        /// The other end.
        to: Vec<Length>,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// A solid block with edges along the axes; flat along one axis it is a plate.
    Block {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// Corner with the lowest coordinates.
        low: Vec<Length>,
        /// Corner with the highest coordinates.
        high: Vec<Length>,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// The curved surface of a cylinder, open at both ends, with grains on both sides; in the plane two parallel
    /// segments.
    Tube {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// Middle of one end.
        from: Vec<Length>,
        /// Middle of the other end.
        to: Vec<Length>,
        /// Radius.
        radius: Length,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// A circle with grains on both sides, such as a drum in the plane; in space the shell of a sphere.
    Circle {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// Centre.
        centre: Vec<Length>,
        /// Radius.
        radius: Length,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// Segments from point to point, with grains on both sides; one wall, with smooth contact across its joints.
    Chain {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// Its points, one length per axis each.
        points: Vec<Vec<Length>>,
        /// Whether the last point is joined to the first.
        #[serde(default)]
        closed: bool,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// Triangles of an STL file, text or binary, with grains on both sides; one wall, with smooth contact across edges
    /// where it is flat. In space only.
    Mesh {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// The file; its path counts from the folder of the scene.
        file: String,
        /// Length of one unit of the file; a metre by default.
        #[serde(default = "metre")]
        unit: Length,
        /// Where the origin of the file is, one length per axis; at the origin by default.
        #[serde(default)]
        at: Vec<Length>,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// Fixed grains on a lattice in a box: a rough wall. A box that is flat along an axis gives a row or a layer.
    HeldGrains {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// Corner with the lowest coordinates; centres are placed from here.
        low: Vec<Length>,
        /// Corner with the highest coordinates.
        high: Vec<Length>,
        /// Diameter of the held grains.
        diameter: Length,
        /// Distance between their centres along each axis.
        spacing: Length,
        /// Largest random displacement along each axis; none by default.
        #[serde(default)]
        scatter: Length,
        /// Random seed of the scatter.
        #[serde(default = "default_seed")]
        seed: u64,
        /// Name of the material.
        material: String,
        /// Name of the stage at whose start it is removed; it stays by default.
        #[serde(default)]
        opens: Option<String>,
        /// How it moves; at rest by default.
        #[serde(default)]
        moves: Option<MotionSpec>,
    },
    /// A closed box around the grains, made of planes called `<name>_<axis>_low` and `_high`.
    Box {
        /// Name, for probes such as `force_on_<name>_x` and for changes that open it.
        name: String,
        /// Corner with the lowest coordinates.
        low: Vec<Length>,
        /// Corner with the highest coordinates.
        high: Vec<Length>,
        /// Name of the material.
        material: String,
    },
}

fn metre() -> Length {
    1.0.into()
}

/// A part of the run, such as settling under gravity or collapsing.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Name; each stage has its own.
    pub name: String,
    /// When it ends.
    pub end: End,
    /// Name of the solver whose rest, density or flow ends it; of several the first that can, in the order of their names.
    #[serde(default)]
    pub of: Option<String>,
    /// What changes at its start, in this order.
    #[serde(default)]
    pub changes: Vec<Change>,
    /// Step during this stage; by default that of the solver.
    #[serde(default)]
    pub time_step: Option<Time>,
    /// File in the run folder to which the grains are saved at the end of the stage, as a sample for other scenes.
    #[serde(default)]
    pub save: Option<String>,
}

/// End of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum End {
    /// After this time.
    For(Time),
    /// When the grains have come to rest.
    Quiet {
        /// Kinetic over potential energy below which grains are at rest, such as 1e-6.
        kinetic_over_potential: f64,
        /// Time after which the stage ends in any case. The grains must be at rest for a twentieth
        /// of it.
        within: Time,
    },
    /// When the bulk of the grains has reached a density.
    Packed {
        /// Solid fraction of the bulk, above 0 and below 1.
        solid_fraction: f64,
        /// Time after which the stage ends in any case.
        within: Time,
    },
    /// When the flow of a fluid has become steady.
    Steady {
        /// Relative change of its kinetic energy over a twentieth of `within` below which it is steady, such as 1e-6.
        change: f64,
        /// Time after which the stage ends in any case.
        within: Time,
    },
}

impl End {
    /// Time after which the stage ends in any case \[s\].
    pub fn longest(&self) -> f64 {
        match self {
            Self::For(time) => time.value(),
            Self::Quiet { within, .. } | Self::Steady { within, .. } | Self::Packed { within, .. } => {
                within.value()
            }
        }
    }
}

/// A change at the start of a stage.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Change {
    /// The friction of a material. Pairs whose friction is given keep it.
    Friction {
        /// Name of the material.
        material: String,
        /// New coefficient.
        value: f64,
    },
    /// Gravity, one component per axis.
    Gravity(Vec<Acceleration>),
    /// The velocity of a face of the fluid, uniform over the face: of a wall along itself, or of an Inflow.
    FaceVelocity {
        /// Which one: left, right, bottom or top; in space also front or back.
        face: String,
        /// New velocity, one component per axis.
        velocity: Vec<Velocity>,
    },
    /// The angular velocity of the surface of an obstacle without a path.
    ObstacleSpin {
        /// Name of the obstacle.
        obstacle: String,
        /// New angular velocity: one value in the plane, three components in space.
        spin: Vec<AngularVelocity>,
    },
    /// All velocities and spins become zero.
    StopMotion,
    /// A sudden change of velocity of all grains, as by a blow or an earthquake, added to the velocity that they have.
    /// Its strength is given by one of `speed`, `energy` and `energy_per_grain`. The energy and momentum added are in
    /// `run.json`, under the stage.
    Push {
        /// Where to, one number per axis, of any length; along x by default.
        #[serde(default)]
        direction: Vec<f64>,
        /// Velocity of the grains that it moves fastest.
        #[serde(default)]
        speed: Option<Velocity>,
        /// Kinetic energy that all grains get together; per metre of depth in the plane.
        #[serde(default)]
        energy: Option<Energy>,
        /// The same for each grain, in units of mean mass times gravity times mean diameter, `m g d`.
        #[serde(default)]
        energy_per_grain: Option<f64>,
        /// How it is spread over the height of the grains.
        #[serde(default)]
        profile: PushProfileSpec,
        /// Name of the solver whose grains it moves; those of all by default.
        #[serde(default)]
        of: Option<String>,
    },
    /// Shaking, during this stage only: an oscillating acceleration in addition to gravity, as seen from a shaking
    /// table.
    Shake {
        /// Largest acceleration, one component per axis.
        acceleration: Vec<Acceleration>,
        /// Frequency at the start of a pass.
        from: Frequency,
        /// Frequency at the end of a pass.
        to: Frequency,
        /// Duration of a pass; passes follow each other.
        pass: Time,
    },
    /// The wall of this name, such as `gate`, is removed.
    Open(String),
    /// The wall of this name comes back.
    Close(String),
    /// The moving wall or the inlet of this name starts; before, it waits.
    Start(String),
    /// The moving wall or the inlet of this name halts where it is.
    Halt(String),
    /// What drives the periodic cell.
    Cell(CellChange),
}
