//! From a scene to a simulation: all checks that need no step, then the build.

mod outputs;
mod sample;
mod walls;

use crate::scene::{Change, Dimension, End, FigureSpec, Sample, Scene, SolverSpec, Writer};
use crate::scene_file::SceneProblem;
use granular_core::units::{Acceleration, Measured, Unit};
use granular_core::{D2, D3, Dim, Simulation, Solver, Vector};
use granular_dem::spec::DemSpec;
use granular_dem::{Dem, MaterialId, Materials, Setup};
use std::any::Any;
use std::collections::BTreeMap;
use walls::Beside;

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
    /// Width along x.
    pub width: f64,
    /// Height asked for; what comes to rest may differ.
    pub height: f64,
    /// Depth along y in space.
    pub depth: Option<f64>,
}

/// A change of the solver between stages.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Friction of a material.
    Friction(MaterialId, f64),
    /// Gravity \[m/s^2\].
    Gravity(Vec<f64>),
    /// All velocities become zero.
    StopMotion,
    /// A wall opens or closes.
    Wall(String, bool),
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

/// Materials of a scene, by name.
#[derive(Debug, Default)]
pub(crate) struct NamedMaterials {
    pub(crate) list: Materials,
    /// None for a material that was refused, so that its users are not blamed too.
    ids: BTreeMap<String, Option<MaterialId>>,
}

impl NamedMaterials {
    fn of(scene: &Scene, problems: &mut Problems) -> Self {
        let mut named = Self::default();
        for (name, &spec) in &scene.materials {
            let added = named.list.add(spec.into()).map_err(|error| {
                let key = error.what.replace(' ', "_");
                problems.add(format!("materials.{}.{key}", quoted(name)), error.value, error.allowed, "");
            });
            named.ids.insert(name.clone(), added.ok());
        }
        named
    }

    pub(crate) fn find(&self, path: &str, name: &str, problems: &mut Problems) -> Option<MaterialId> {
        let found = self.ids.get(name).copied();
        if found.is_none() {
            let known: Vec<&str> = self.ids.keys().map(String::as_str).collect();
            let hint = nearest(name, known.iter().copied());
            let allowed = format!("a material of this scene: {}", known.join(", "));
            problems.add(path, format!("`{name}`, which is no material of this scene"), allowed, hint);
        }
        found.flatten()
    }
}

/// A key as a scene path writes it: one with a dot needs quotes.
fn quoted(key: &str) -> String {
    if key.contains(['.', '=', '[']) { format!("\"{key}\"") } else { key.to_owned() }
}

/// "did you mean" for the nearest of some names; empty when none is near.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
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
    match scene.dimension {
        Dimension::Plane => build_in::<D2>(scene),
        Dimension::Space => build_in::<D3>(scene),
    }
}

fn build_in<D: Dim>(scene: &Scene) -> Result<Model, Vec<SceneProblem>> {
    let mut problems = Problems::default();
    check_frame(scene, &mut problems);
    outputs::check_files(scene, &mut problems);
    let gravity = if scene.gravity.is_empty() {
        Some(D::Vec::default())
    } else {
        problems.vector::<D, _>("gravity", &scene.gravity)
    };
    let materials = NamedMaterials::of(scene, &mut problems);
    let sample = sample::grains::<D>(&scene.sample, &materials, &mut problems);
    let column = sample.as_ref().and_then(|sample| sample.column);
    // A column that cannot be built has been blamed already; the walls beside it are not.
    let beside = match (&sample, &scene.sample) {
        (None, Sample::Column { .. }) => Beside::Unknown,
        _ => column.map_or(Beside::Nothing, Beside::Column),
    };
    let walls = walls::walls::<D>(&scene.walls, beside, &materials, &mut problems);
    let stages = actions::<D>(scene, &walls.openings, &materials, &mut problems);
    check_wall_names(scene, walls.list.iter().map(|wall| wall.name.as_str()).collect(), &mut problems);
    let spec = solver_spec(scene, &mut problems);
    let (Some(gravity), Some(sample), Some(spec), true) = (gravity, sample, spec, problems.0.is_empty())
    else {
        return Err(problems.0);
    };
    let setup = Setup {
        materials: materials.list,
        grains: sample.grains,
        walls: walls.list,
        gravity,
        options: spec.options(needs_ledger(scene)),
    };
    let dem = Dem::<D>::new(setup).map_err(|error| {
        let path = format!("solvers.{}", scene.solvers.keys().next().map_or("", String::as_str));
        vec![SceneProblem::at_path(path, error.to_string(), error.allowed, "")]
    })?;
    outputs::check_names(scene, &dem, &mut problems);
    if !problems.0.is_empty() {
        return Err(problems.0);
    }
    Ok(Model {
        simulation: Simulation::new(Box::new(dem)),
        stages,
        time_step: spec.time_step.map(|step| step.value()),
        column,
        up: D::UP,
    })
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
            End::Quiet { within, .. } => ("end.within", within),
        };
        if let End::Quiet { kinetic_over_potential: ratio, .. } = stage.end
            && ratio <= 0.0
        {
            let path = format!("stages.{k}.end.kinetic_over_potential");
            problems.add(path, ratio, "above 0, such as 1e-6", "");
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

fn check_wall_names(scene: &Scene, names: Vec<&str>, problems: &mut Problems) {
    for (k, name) in names.iter().enumerate() {
        if names[..k].contains(name) {
            problems.add("walls", format!("two walls called `{name}`"), "walls with names of their own", "");
        }
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        for (c, change) in stage.changes.iter().enumerate() {
            let (Change::Open(name) | Change::Close(name)) = change else { continue };
            if !names.contains(&name.as_str()) {
                let path = format!("stages.{k}.changes.{c}");
                problems.add(
                    path,
                    format!("`{name}`"),
                    names.join(", "),
                    nearest(name, names.iter().copied()),
                );
            }
        }
    }
}

fn solver_spec(scene: &Scene, problems: &mut Problems) -> Option<DemSpec> {
    if scene.solvers.len() != 1 {
        let allowed = "exactly one, such as { \"grains\": Dem(()) }";
        problems.add("solvers", format!("a map of {}", scene.solvers.len()), allowed, "");
    }
    let (name, SolverSpec::Dem(spec)) = scene.solvers.iter().next()?;
    let positive = "a positive time";
    if let Some(step) = spec.time_step.filter(|step| step.value() <= 0.0) {
        problems.add(format!("solvers.{name}.time_step"), step, positive, "");
    }
    if spec.steps_per_contact < 1.0 {
        problems.add(format!("solvers.{name}.steps_per_contact"), spec.steps_per_contact, "1 or more", "");
    }
    if spec.skin <= 0.0 {
        problems.add(format!("solvers.{name}.skin"), spec.skin, "above 0", "");
    }
    Some(*spec)
}

/// Whether anything asks for losses of energy.
fn needs_ledger(scene: &Scene) -> bool {
    let asks = |probes: &[String]| probes.iter().any(|p| p.starts_with("loss_") || p == "energy_residual");
    let in_tables = scene.outputs.iter().any(|output| match &output.write {
        Writer::Table { probes, .. } => asks(probes),
        _ => false,
    });
    in_tables || scene.figures.iter().any(|figure| matches!(figure, FigureSpec::Energies { .. }))
}

/// What each stage does at its start.
fn actions<D: Dim>(
    scene: &Scene,
    openings: &[(String, String, String)],
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Vec<Vec<Action>> {
    for (path, _, stage) in openings {
        if !scene.stages.is_empty() && !scene.stages.iter().any(|other| other.name == *stage) {
            let known: Vec<&str> = scene.stages.iter().map(|stage| stage.name.as_str()).collect();
            let hint = nearest(stage, known.iter().copied());
            problems.add(
                format!("{path}.opens"),
                format!("`{stage}`, which is no stage of this scene"),
                format!("a stage of this scene: {}", known.join(", ")),
                hint,
            );
        }
    }
    let mut stages = Vec::new();
    for (k, stage) in scene.stages.iter().enumerate() {
        let opened = openings.iter().filter(|(.., at)| *at == stage.name);
        let mut list: Vec<Action> = opened.map(|(_, wall, _)| Action::Wall(wall.clone(), true)).collect();
        for (c, change) in stage.changes.iter().enumerate() {
            let path = format!("stages.{k}.changes.{c}");
            list.extend(action::<D>(&path, change, materials, problems));
        }
        stages.push(list);
    }
    stages
}

fn action<D: Dim>(
    path: &str,
    change: &Change,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Option<Action> {
    Some(match change {
        Change::Friction { material, value } => {
            if !(*value >= 0.0 && value.is_finite()) {
                problems.add(format!("{path}.value"), value, "zero or more", "");
            }
            Action::Friction(materials.find(&format!("{path}.material"), material, problems)?, *value)
        }
        Change::Gravity(values) => {
            problems.vector::<D, _>(path, values)?;
            Action::Gravity(values.iter().map(|value: &Acceleration| value.value()).collect())
        }
        Change::StopMotion => Action::StopMotion,
        Change::Open(name) => Action::Wall(name.clone(), true),
        Change::Close(name) => Action::Wall(name.clone(), false),
    })
}

/// Makes a change. The solver is the one that [`build`] made.
pub fn apply(action: &Action, solver: &mut dyn Solver) {
    let solver: &mut dyn Any = solver;
    if let Some(dem) = solver.downcast_mut::<Dem<D2>>() {
        apply_to(action, dem);
    } else if let Some(dem) = solver.downcast_mut::<Dem<D3>>() {
        apply_to(action, dem);
    }
}

fn apply_to<D: Dim>(action: &Action, dem: &mut Dem<D>) {
    match action {
        Action::Friction(material, value) => dem.set_friction(*material, *value),
        Action::Gravity(values) => {
            dem.set_gravity(D::Vec::from_slice(values).expect("the number of axes was checked at build"));
        }
        Action::StopMotion => dem.stop_motion(),
        Action::Wall(name, open) => _ = dem.set_open(name, *open),
    }
}
