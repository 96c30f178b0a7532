//! The scene: one file that describes a granular problem once.
//!
//! These types are what a scene file may say. `docs/scene-reference.md` is generated from them.

pub(crate) mod names;

use granular_core::units::{Acceleration, Length, Time};
use granular_dem::spec::{DemSpec, GrainSpec, MaterialSpec};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A granular problem.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of this format: 1.
    pub version: u32,
    /// Plane or space.
    pub dimension: Dimension,
    /// One line about the scene, for figures and reports.
    #[serde(default)]
    pub title: String,
    /// Gravity, one component per axis; none by default.
    #[serde(default)]
    pub gravity: Vec<Acceleration>,
    /// Materials by name.
    pub materials: BTreeMap<String, MaterialSpec>,
    /// The grains, described apart from the method.
    pub sample: Sample,
    /// Walls.
    #[serde(default)]
    pub walls: Vec<WallSpec>,
    /// What happens, one stage after the other.
    pub stages: Vec<Stage>,
    /// The method, under a name of your choice. One for now.
    pub solvers: BTreeMap<String, SolverSpec>,
    /// What to write during the run.
    #[serde(default)]
    pub outputs: Vec<Output>,
    /// Figures made at the end of the run.
    #[serde(default)]
    pub figures: Vec<FigureSpec>,
    /// Wall-clock time between snapshots; one is also taken at every stage and on interruption.
    #[serde(default = "default_snapshot_interval")]
    pub snapshot_every: Time,
}

fn default_snapshot_interval() -> Time {
    60.0.into()
}

/// Plane or space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Dimension {
    /// Disks in the plane, x to the right and y up; everything is per metre of depth.
    Plane,
    /// Spheres in space, z up.
    Space,
}

/// The method that solves the scene.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum SolverSpec {
    /// Discrete element method.
    Dem(DemSpec),
}

/// The grains.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Sample {
    /// A column that stands on y = 0 (z = 0 in space) with its left side at x = 0.
    Column {
        /// How large the column is.
        extent: Extent,
        /// Height over width.
        aspect_ratio: f64,
        /// Depth along y in space, over the width; not in the plane.
        #[serde(default)]
        depth_ratio: Option<f64>,
        /// Sizes of the grains.
        grading: GradingSpec,
        /// Material of the grains.
        material: String,
        /// How the grains are placed.
        packing: PackingSpec,
        /// Random seed of sizes and places.
        #[serde(default = "default_seed")]
        seed: u64,
    },
    /// Grains one by one.
    Grains(Vec<GrainSpec>),
}

fn default_seed() -> u64 {
    1
}

/// How large a sample is.
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
    /// Cumulative beta curve by area (plane) or volume (space).
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
    /// The plane y = 0 (z = 0 in space) below the sample.
    Floor {
        /// Material.
        material: String,
    },
    /// The plane x = 0 left of the sample.
    Left {
        /// Material.
        material: String,
    },
    /// The plane right of a column.
    Right {
        /// Material.
        material: String,
    },
    /// The plane right of a column, out of the way from a stage on.
    Gate {
        /// Material.
        material: String,
        /// Stage at whose start the gate opens.
        opens: String,
    },
    /// Planes before and behind a column in space.
    Sides {
        /// Material.
        material: String,
    },
    /// A plane anywhere; grains are on the side to which the normal points.
    Plane {
        /// Name, for outputs.
        name: String,
        /// A point on it.
        point: Vec<Length>,
        /// Normal, of any length.
        normal: Vec<f64>,
        /// Material.
        material: String,
        /// Stage at whose start it opens; never by default.
        #[serde(default)]
        opens: Option<String>,
    },
    /// A straight line between two points.
    Segment {
        /// Name, for outputs.
        name: String,
        /// One end.
        from: Vec<Length>,
        /// The other end.
        to: Vec<Length>,
        /// Material.
        material: String,
        /// Stage at whose start it opens; never by default.
        #[serde(default)]
        opens: Option<String>,
    },
    /// A solid block with edges along the axes; flat along one axis it is a plate.
    Block {
        /// Name, for outputs.
        name: String,
        /// Lower corner.
        low: Vec<Length>,
        /// Upper corner.
        high: Vec<Length>,
        /// Material.
        material: String,
        /// Stage at whose start it opens; never by default.
        #[serde(default)]
        opens: Option<String>,
    },
    /// A closed box around the grains, made of planes called `<name>_<axis>_low` and `_high`.
    Box {
        /// Name, for outputs.
        name: String,
        /// Lower corner.
        low: Vec<Length>,
        /// Upper corner.
        high: Vec<Length>,
        /// Material.
        material: String,
    },
}

/// A part of the run.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Name.
    pub name: String,
    /// When it ends.
    pub end: End,
    /// What changes at its start.
    #[serde(default)]
    pub changes: Vec<Change>,
    /// Step during this stage; that of the solver by default.
    #[serde(default)]
    pub time_step: Option<Time>,
}

/// End of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum End {
    /// After this time.
    For(Time),
    /// When the grains have come to rest.
    Quiet {
        /// Kinetic over potential energy below which grains are at rest.
        kinetic_over_potential: f64,
        /// Time after which the stage ends in any case.
        within: Time,
    },
}

/// A change at the start of a stage.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Change {
    /// Friction of one material.
    Friction {
        /// Material.
        material: String,
        /// New coefficient.
        value: f64,
    },
    /// Gravity.
    Gravity(Vec<Acceleration>),
    /// All velocities and spins become zero.
    StopMotion,
    /// A wall goes out of the way.
    Open(String),
    /// A wall comes back.
    Close(String),
}

/// Something to write on a schedule.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// When.
    pub every: EverySpec,
    /// What.
    pub write: Writer,
}

/// A schedule.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum EverySpec {
    /// Simulated time.
    Time(Time),
    /// Steps.
    Steps(u64),
}

/// What is written.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Writer {
    /// A row of numbers, in a CSV file.
    Table {
        /// File in the run folder.
        path: String,
        /// Numbers to write; `granular info --shown` lists them.
        probes: Vec<String>,
    },
    /// Fields of all grains, for ParaView: one `.vtp` per frame and one `.pvd` that lists them.
    Fields {
        /// Name of the files in the run folder, without ending.
        path: String,
        /// Fields to write.
        fields: Vec<String>,
    },
    /// Contacts as lines between grains, for ParaView.
    Contacts {
        /// Name of the files in the run folder, without ending.
        path: String,
        /// Fields of contacts to write.
        fields: Vec<String>,
    },
    /// Fields of all grains in one temporal `.vtkhdf` file (cargo feature `hdf5`).
    Hdf5 {
        /// Name of the file in the run folder, without ending.
        path: String,
        /// Fields to write.
        fields: Vec<String>,
    },
}

/// A figure, as `<path>.svg` and `<path>.png` in the run folder.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FigureSpec {
    /// Columns of a table over time.
    Series {
        /// Name of the figure.
        path: String,
        /// Table to read.
        table: String,
        /// Columns to draw.
        columns: Vec<String>,
    },
    /// Run-out and height of a collapsing column over time, in the units of the thesis.
    Runout {
        /// Name of the figure.
        path: String,
        /// Table with `front` and `height`.
        table: String,
        /// Stage in which the column collapses.
        stage: String,
    },
    /// Where the energy goes after a stage begins, over the energy at its start.
    Energies {
        /// Name of the figure.
        path: String,
        /// Table with the energies and losses.
        table: String,
        /// Stage at whose start the balance begins.
        stage: String,
    },
    /// Grains, coloured by a field, at several times.
    Flow {
        /// Name of the figure.
        path: String,
        /// `Fields` output to read; it must hold `radius` and the field of the colour.
        fields: String,
        /// Field that gives the colour.
        color: String,
        /// Stage from whose start times count.
        stage: String,
        /// Times in units of sqrt(H/g) of a column; in seconds for other samples.
        times: Vec<f64>,
    },
    /// Force chains: contacts of one frame, their width by the normal force.
    ForceChains {
        /// Name of the figure.
        path: String,
        /// `Contacts` output to read; it must hold `normal_force`.
        contacts: String,
        /// Stage from whose start the time counts.
        stage: String,
        /// Time in units of sqrt(H/g) of a column; in seconds for other samples.
        time: f64,
    },
}
