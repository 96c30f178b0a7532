//! From a scene to a simulation: all checks that need no step, then the build by the method of the scene.

mod boundaries;
mod cell;
mod fluid;
mod grains;
mod outputs;
pub(crate) mod push;
mod region;
mod sample;
mod walls;

pub(crate) use boundaries::crowded_inlets;
pub(crate) use grains::{NamedMaterials, Whereabouts};
pub use outputs::{all_shown, shown_on_grids};
pub use push::{PushAction, PushRecord};

use crate::failure::Failure;
use crate::scene::{Dimension, End, Scene, SolverSpec};
use crate::scene_file::SceneProblem;
use granular_core::units::{Measured, Unit};
use granular_core::{D2, D3, Dim, Limits, Simulation, Solver, Vector};
use granular_dem::MaterialId;
use granular_lbm::{D2Q9, D3Q19};
use std::path::Path;

/// A scene that was checked and built.
#[derive(Debug)]
pub struct Model {
    /// The solver with its clock, before the first step.
    pub simulation: Simulation,
    /// What happens at the start of each stage, in their order.
    pub stages: Vec<Vec<Action>>,
    /// Step that the solver takes unless a stage chooses its own \[s\]; `None` for the recommended one.
    pub time_step: Option<f64>,
    /// Width and height asked for, when the sample is a column \[m\].
    pub column: Option<ColumnSize>,
    /// Axis that points up.
    pub up: usize,
}

/// Size of a column \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnSize {
    /// Width along x; the radius of a cylinder.
    pub width: f64,
    /// Height asked for; what comes to rest may differ.
    pub height: f64,
    /// Depth along y in space; none for a cylinder.
    pub depth: Option<f64>,
    /// Whether it is a cylinder about the z axis.
    pub round: Option<Round>,
}

/// How much of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Round {
    /// All of it.
    Whole,
    /// The half with y above 0.
    Half,
}

impl ColumnSize {
    /// The number that says how far it spread.
    pub fn front(&self) -> &'static str {
        if self.round.is_some() { "radial_front" } else { "front" }
    }
}

/// A change of the solver between stages.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Friction of a material.
    Friction(MaterialId, f64),
    /// Gravity \[m/s^2\].
    Gravity(Vec<f64>),
    /// Velocity of a face of the fluid by its name \[m/s\].
    FaceVelocity(String, Vec<f64>),
    /// Spin of an obstacle in the fluid by its name \[1/s\], about x, y and z.
    ObstacleSpin(String, [f64; 3]),
    /// All velocities become zero.
    StopMotion,
    /// All grains get a velocity.
    Push(PushAction),
    /// A shaking begins, or ends.
    Shake(Option<Shake>),
    /// A wall opens or closes.
    Wall(String, bool),
    /// A moving wall or an inlet starts or halts.
    Moving(String, bool),
    /// What drives the periodic cell.
    Cell(granular_dem::CellControl),
}

/// An oscillating acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Shake {
    /// Largest acceleration, one component per axis \[m/s^2\].
    pub acceleration: Vec<f64>,
    /// Frequency at the start and at the end of a pass \[Hz\].
    pub frequency: [f64; 2],
    /// Duration of a pass \[s\].
    pub pass: f64,
}

/// Collects problems by scene path.
#[derive(Debug, Default)]
pub(crate) struct Problems(pub(crate) Vec<SceneProblem>);

impl Problems {
    pub(crate) fn add(
        &mut self,
        path: impl Into<String>,
        value: impl std::fmt::Display,
        allowed: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.0.push(SceneProblem::at_path(path, value, allowed, hint));
    }

    /// A vector of the right number of components.
    pub(crate) fn vector<D: Dim, U: Unit>(&mut self, path: &str, values: &[Measured<U>]) -> Option<D::Vec> {
        let numbers: Vec<f64> = values.iter().map(|value| value.value()).collect();
        let vector = D::Vec::from_slice(&numbers);
        if vector.is_none() {
            let allowed = format!("{} values, one per axis", D::N);
            self.add(path, format!("a list of {}", values.len()), allowed, "");
        }
        vector
    }
}

/// "did you mean" for the nearest of some names; empty when none is near.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let near = known
        .into_iter()
        .map(|other| (strsim::damerau_levenshtein(name, other), other))
        .filter(|&(distance, other)| distance <= 1 + other.len() / 3)
        .min();
    near.map_or(String::new(), |(_, other)| format!("did you mean `{other}`?"))
}

/// Builds the simulation of a scene.
///
/// # Errors
/// With all problems of the scene.
pub fn build(scene: &Scene) -> Result<Model, Vec<SceneProblem>> {
    let mut problems = Problems::default();
    check_frame(scene, &mut problems);
    outputs::check_files(scene, &mut problems);
    if scene.solvers.len() != 1 {
        let allowed =
            "exactly one, such as { \"grains\": Dem(()) } or { \"water\": Lbm((spacing: \"1 mm\")) }";
        problems.add("solvers", format!("a map of {}", scene.solvers.len()), allowed, "");
    }
    let Some((name, solver)) = scene.solvers.iter().next() else { return Err(problems.0) };
    match (scene.dimension, solver) {
        (Dimension::Plane, SolverSpec::Dem(spec)) => grains::build::<D2>(scene, name, spec, problems),
        (Dimension::Space, SolverSpec::Dem(spec)) => grains::build::<D3>(scene, name, spec, problems),
        (Dimension::Plane, SolverSpec::Lbm(spec)) => fluid::build::<D2Q9, 9>(scene, name, spec, problems),
        (Dimension::Space, SolverSpec::Lbm(spec)) => fluid::build::<D3Q19, 19>(scene, name, spec, problems),
    }
}

/// Limits of a fluid of so many cells that building it takes long; nothing for other scenes, and for those that are wrong.
pub(crate) fn early_limits(scene: &Scene) -> Option<Limits> {
    match (scene.dimension, scene.solvers.iter().next()?) {
        (Dimension::Plane, (name, SolverSpec::Lbm(spec))) => {
            fluid::early_limits::<D2Q9, 9>(scene, name, spec)
        }
        (Dimension::Space, (name, SolverSpec::Lbm(spec))) => {
            fluid::early_limits::<D3Q19, 19>(scene, name, spec)
        }
        _ => None,
    }
}

/// Makes all changes at the start of a stage; the solver is the one that [`build`] made. Returns what its pushes did, if there are any.
pub fn begin(actions: &[Action], solver: &mut dyn Solver) -> Option<PushRecord> {
    let mut pushed = None;
    for action in actions {
        grains::apply(action, solver, &mut pushed);
        fluid::apply(action, solver);
    }
    pushed
}

/// What a check says of a scene that can be run, and of which little will come.
pub(crate) fn warnings(scene: &Scene, model: &Model) -> Vec<String> {
    grains::falling::warnings(scene, model.simulation.solver())
}

/// Saves the grains as they are now, as a sample for other scenes.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn save_sample(scene: &Scene, model: &Model, path: &Path) -> Result<(), Failure> {
    grains::save_sample(scene, model, path)
}

/// Checks that need neither dimension nor solver.
fn check_frame(scene: &Scene, problems: &mut Problems) {
    if scene.version != 1 {
        problems.add("version", scene.version, "1", "this program reads scenes of version 1");
    }
    if scene.stages.is_empty() {
        problems.add("stages", "empty", "at least one stage", "add (name: \"run\", end: For(\"1 s\"))");
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        let (key, time) = match stage.end {
            End::For(time) => ("end", time),
            End::Quiet { within, .. } | End::Steady { within, .. } | End::Packed { within, .. } => {
                ("end.within", within)
            }
        };
        if let End::Packed { solid_fraction, .. } = stage.end
            && !(solid_fraction > 0.0 && solid_fraction < 1.0)
        {
            problems.add(format!("stages.{k}.end.solid_fraction"), solid_fraction, "above 0 and below 1", "");
        }
        if let End::Quiet { kinetic_over_potential: ratio, .. } = stage.end
            && ratio <= 0.0
        {
            let path = format!("stages.{k}.end.kinetic_over_potential");
            problems.add(path, ratio, "above 0, such as 1e-6", "");
        }
        if let End::Steady { change, .. } = stage.end
            && change <= 0.0
        {
            problems.add(format!("stages.{k}.end.change"), change, "above 0, such as 1e-6", "");
        }
        if time.value() <= 0.0 {
            problems.add(format!("stages.{k}.{key}"), time, "a positive time", "");
        }
        if scene.stages[..k].iter().any(|other| other.name == stage.name) {
            problems.add(
                format!("stages.{k}.name"),
                format!("`{}` again", stage.name),
                "a name of its own",
                "",
            );
        }
        if let Some(step) = stage.time_step.filter(|step| step.value() <= 0.0) {
            problems.add(format!("stages.{k}.time_step"), step, "a positive time", "");
        }
    }
    if scene.snapshot_every.value() <= 0.0 {
        problems.add("snapshot_every", scene.snapshot_every, "a positive time", "");
    }
}
