//! What a run writes and draws.

use super::fluid::ReferenceSpec;
use granular_core::units::{Length, Time};
use granular_tessellate::FREE_SURFACE;
use schemars::JsonSchema;
use serde::Deserialize;

/// Something to write on a schedule.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// How often.
    pub every: EverySpec,
    /// Name of the solver that is shown; of several the first in the order of their names by default.
    #[serde(default)]
    pub of: Option<String>,
    /// What to write, and where.
    pub write: Writer,
}

/// How often something is written: at the start and then in equal intervals.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum EverySpec {
    /// In intervals of simulated time, at the first step at or after each.
    Time(Time),
    /// In intervals of steps, 1 or more.
    Steps(u64),
}

/// What is written.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Writer {
    /// One row of numbers per output time, in a CSV file with units in its header; the first column is `time`.
    Table {
        /// File in the run folder, such as `series.csv`.
        path: String,
        /// Numbers to write; `granular info <scene>` lists all there are.
        probes: Vec<String>,
        /// Voronoi cells larger than this many times the mean belong to the free surface and not to the bulk, 2 by
        /// default; sizes are in units of the grain's own area or volume.
        #[serde(default = "free_surface")]
        free_surface: f64,
    },
    /// Fields of all grains or cells, for ParaView: one `.vtp` or `.vti` per frame and one `.pvd` that lists them.
    Fields {
        /// Name of the files in the run folder, without ending.
        path: String,
        /// Fields to write; `granular info <scene>` lists all there are.
        fields: Vec<String>,
        /// Cells over which grains are averaged; the fields are then those of a continuum.
        #[serde(default)]
        grid: Option<GridSpec>,
        /// Voronoi cells larger than this many times the mean belong to the free surface and not to the bulk, 2 by
        /// default; sizes are in units of the grain's own area or volume.
        #[serde(default = "free_surface")]
        free_surface: f64,
    },
    /// Contacts as lines between grains, for ParaView.
    Contacts {
        /// Name of the files in the run folder, without ending.
        path: String,
        /// Fields of contacts (`Link`) to write; `granular info <scene>` lists all there are.
        fields: Vec<String>,
    },
    /// Fields along a line through a fluid or a `grid` of grains, as rows of a CSV file: time, distance, place, then
    /// the fields.
    Profile {
        /// File in the run folder, such as `profile.csv`.
        path: String,
        /// One end of the line, one length per axis.
        from: Vec<Length>,
        /// The other end.
        to: Vec<Length>,
        /// Points on the line with its ends, 2 or more.
        points: usize,
        /// Fields to write; `granular info <scene>` lists all there are.
        fields: Vec<String>,
        /// Cells over which grains are averaged; the fields are then those of a continuum.
        #[serde(default)]
        grid: Option<GridSpec>,
    },
    /// Places of single grains and their fields, as rows of a CSV file: time, id, place, then the fields.
    Tracks {
        /// File in the run folder, such as `tracks.csv`.
        path: String,
        /// Which grains.
        grains: Chosen,
        /// Fields to write, such as `velocity`, `spin` and `force`; `granular info <scene>` lists all there are.
        fields: Vec<String>,
    },
    /// Fields of all grains or cells in one temporal `.vtkhdf` file (cargo feature `hdf5`).
    Hdf5 {
        /// Name of the file in the run folder, without ending.
        path: String,
        /// Fields to write; `granular info <scene>` lists all there are.
        fields: Vec<String>,
        /// Cells over which grains are averaged; the fields are then those of a continuum.
        #[serde(default)]
        grid: Option<GridSpec>,
    },
}

/// Square or cubic cells over which grains are averaged: coarse graining with a kernel that ends at twice its scale.
/// Mass and momentum in the cells are exactly those of the grains; what lies beyond the cells is written as
/// `mass_outside`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridSpec {
    /// Lower corner, one length per axis.
    pub from: Vec<Length>,
    /// Upper corner; the last cells may reach beyond it.
    pub to: Vec<Length>,
    /// Edge of a cell.
    pub spacing: Length,
    /// Scale of the kernel over the spacing, 1 to 8. Fields are smooth when the scale is at least a mean diameter.
    #[serde(default = "one_cell")]
    pub width: usize,
}

fn transient() -> f64 {
    0.84
}

fn free_surface() -> f64 {
    FREE_SURFACE
}

fn one_cell() -> usize {
    1
}

/// Which grains.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum Chosen {
    /// Those with these identifiers, counted from 0.
    Ids(Vec<u32>),
    /// Every n-th, from identifier 0 on; 1 for all.
    Every(u32),
}

impl Chosen {
    /// Whether a grain is one of them.
    pub(crate) fn holds(&self, id: u32) -> bool {
        match self {
            Self::Ids(ids) => ids.contains(&id),
            Self::Every(count) => id.is_multiple_of(*count),
        }
    }
}

/// A figure, as `<path>.svg` and `<path>.png` in the run folder.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FigureSpec {
    /// Columns of a table over time; one chart for each unit.
    Series {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Table` output to read.
        table: String,
        /// Columns to draw, at least one.
        columns: Vec<String>,
        /// Name of the stage from whose start on the columns are drawn, over time in units of sqrt(H/g) of a column; by
        /// default all of the run is drawn over seconds.
        #[serde(default)]
        stage: Option<String>,
        /// Curves from elsewhere, over the same time.
        #[serde(default)]
        references: Vec<ReferenceCurve>,
    },
    /// Columns of a table over another column of it, such as stress over strain; one chart for each unit.
    Curve {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Table` output to read.
        table: String,
        /// Column along x.
        x: String,
        /// Columns to draw, at least one.
        columns: Vec<String>,
        /// Name of the stage from whose start on the rows are drawn; by default all of the run is drawn.
        #[serde(default)]
        stage: Option<String>,
        /// Curves from elsewhere, over the same column, in the unit of the first one to draw.
        #[serde(default)]
        references: Vec<ReferenceCurve>,
    },
    /// Run-out and height of a collapsing column over time: lengths in units of the width of the column, times in units
    /// of sqrt(H/g).
    Runout {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Table` output to read; it must hold `front`, or `radial_front` of a cylinder, and `height`.
        table: String,
        /// Name of the stage in which the column collapses.
        stage: String,
        /// Laws of the final run-out and height, to compare.
        #[serde(default)]
        laws: Vec<LawSpec>,
        /// Curves of the run-out over time from elsewhere.
        #[serde(default)]
        references: Vec<ReferenceCurve>,
    },
    /// Height of the surface of a collapsing cylinder over the distance from its axis at several times, in units of its
    /// radius: the highest point of rings two mean radii wide, in each sector of 30 degrees, averaged over sectors.
    RadialProfile {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Fields` output to read; it must hold `radius`.
        fields: String,
        /// Name of the stage in which the cylinder collapses.
        stage: String,
        /// Times, at least one, in units of sqrt(H/g).
        times: Vec<f64>,
        /// Laws of the final run-out and height, to compare.
        #[serde(default)]
        laws: Vec<LawSpec>,
    },
    /// Where the energy goes after a stage begins, over the energy at its start.
    Energies {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Table` output to read; it must hold the energies and losses.
        table: String,
        /// Name of the stage at whose start the balance begins.
        stage: String,
        /// Curves from elsewhere.
        #[serde(default)]
        references: Vec<ReferenceCurve>,
    },
    /// Grains, coloured by a field, at several times.
    Flow {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Fields` output to read; it must hold `radius` and the field of the colour.
        fields: String,
        /// Field that gives the colour.
        color: String,
        /// Name of the stage from whose start times count.
        stage: String,
        /// Times, at least one, in units of sqrt(H/g) of a column that spreads (behind a Gate, or with nothing at its
        /// right); in seconds for all others. Time 0 is the last frame before the stage begins.
        times: Vec<f64>,
    },
    /// Voronoi cells over the grains, grey by their packing density, dark where it is high and white at the free
    /// surface; in the plane.
    Cells {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Fields` output to read; it must hold `radius`, `local_density` and `in_bulk`.
        fields: String,
        /// First and last density of the greys; from the data by default.
        #[serde(default)]
        range: Option<Vec<f64>>,
        /// Name of the stage from whose start times count.
        stage: String,
        /// Times, at least one, in units of sqrt(H/g) of a column that spreads (behind a Gate, or with nothing at its
        /// right); in seconds for all others. Time 0 is the last frame before the stage begins.
        times: Vec<f64>,
    },
    /// Force chains: contacts of one frame, their width by the normal force.
    ForceChains {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Contacts` output to read; it must hold `normal_force`.
        contacts: String,
        /// Name of the stage from whose start the time counts.
        stage: String,
        /// Time in units of sqrt(H/g) of a column that spreads (behind a Gate, or with nothing at its right); in
        /// seconds for all others. Time 0 is the last frame before the stage begins.
        time: f64,
    },
    /// A field of a fluid, or of grains on a grid, as a colour map, at several times; in space its middle layer along
    /// y.
    Map {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Fields` output to read; it must hold the field of the colour.
        fields: String,
        /// Field that gives the colour: its value, or the length of a vector.
        color: String,
        /// Path of a `Fields` output of grains with their `radius`, written as often, to draw them over the map; none by default. In space those that
        /// the middle layer cuts.
        #[serde(default)]
        grains: Option<String>,
        /// Whether the colours are symmetric about zero, as for a vorticity.
        #[serde(default)]
        diverging: bool,
        /// First and last value of the colours, in the unit of the field; from the data by default.
        #[serde(default)]
        range: Option<Vec<f64>>,
        /// Name of the stage from whose start times count.
        stage: String,
        /// Times, at least one, in seconds.
        times: Vec<f64>,
    },
    /// A field along a line at several times, with curves to compare.
    Profile {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Profile` output to read.
        profile: String,
        /// Column of it, such as `velocity_x`.
        column: String,
        /// Name of the stage from whose start times count.
        stage: String,
        /// Times, at least one, in seconds.
        times: Vec<f64>,
        /// Lengths are divided by this; 1 m by default.
        #[serde(default)]
        length: Option<Length>,
        /// Values are divided by this, in the unit of the column; 1 by default.
        #[serde(default)]
        scale: Option<f64>,
        /// Curves from elsewhere.
        #[serde(default)]
        references: Vec<ReferenceCurve>,
    },
    /// The response of grains to a push: their front, energies of motion, and the decay of motion along x. The numbers
    /// that it measures become metrics of the run, explained in `docs/impacts.md`.
    Impact {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Table` output to read; it must hold `front`, `kinetic_energy` and `kinetic_energy_x`.
        table: String,
        /// Name of the stage that begins with the push.
        stage: String,
        /// Time after the push from which the decay of motion along x counts, in units of sqrt(H/g) with the height H
        /// of the grains at the push; 0.84 by default, which is 7.5 sqrt(d/g) of a pile 80 mean diameters high.
        #[serde(default = "transient")]
        transient: f64,
    },
    /// The spectrum of a column of a table from a stage on. Its highest peak is a metric of the run:
    /// `frequency_of_<column>`, and with a reference `strouhal_of_<column>`.
    Spectrum {
        /// Name of the figure in the run folder, without ending.
        path: String,
        /// Path of the `Table` output to read.
        table: String,
        /// Column of it.
        column: String,
        /// Name of the stage from whose start the series counts.
        stage: String,
        /// Length and speed that make frequencies a Strouhal number, `frequency length / speed`.
        #[serde(default)]
        reference: Option<ReferenceSpec>,
    },
}

/// A law of the deposit of a column over its aspect ratio, of two powers: `coefficient * a^exponent`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawSpec {
    /// Source of the law.
    pub label: String,
    /// Whether the law gives the final height over the width (or radius) instead of the run-out.
    #[serde(default)]
    pub of_height: bool,
    /// Coefficient and exponent up to the switch.
    pub low: (f64, f64),
    /// Aspect ratio from which the second power applies.
    pub switch: f64,
    /// Coefficient and exponent from the switch on.
    pub high: (f64, f64),
}

impl LawSpec {
    /// Its value at an aspect ratio.
    pub fn at(&self, aspect_ratio: f64) -> f64 {
        let (coefficient, exponent) = if aspect_ratio < self.switch { self.low } else { self.high };
        coefficient * aspect_ratio.powf(exponent)
    }
}

/// A curve from elsewhere, for figures.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceCurve {
    /// Description and source of the curve.
    pub label: String,
    /// Its points, as pairs of distance and value in the units of the figure.
    pub points: Vec<(f64, f64)>,
    /// Whether to draw a line through the points instead of markers.
    #[serde(default)]
    pub line: bool,
}
