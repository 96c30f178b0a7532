//! From a scene to a simulation: all checks that need no step, then the build by the methods of the scene.

mod outputs;

use crate::column::ColumnSize;
use crate::failure::Failure;
use crate::methods::contract::Building;
use crate::methods::member::{Member, Notes};
use crate::methods::parts::Part;
use crate::methods::{self, couplings};
use crate::parts;
use crate::problems::{Problems, nearest};
use crate::scene::{Change, Dimension, End, Scene};
use crate::scene_file::SceneProblem;
use granular_core::{D2, D3, Dim, Limits, Simulation};
use std::path::Path;
use std::sync::Arc;

/// A scene that was checked and built.
#[derive(Debug)]
pub struct Model {
    /// The solvers with their clock, before the first step.
    pub simulation: Simulation,
    /// The solvers that the scene names, in the order of their names.
    pub members: Vec<Arc<dyn Member>>,
    /// Axis that points up.
    pub up: usize,
}

impl Model {
    /// The solver of this name; the first one without a name.
    ///
    /// # Panics
    /// When there is none of this name: a check has refused such scenes.
    pub fn member(&self, name: Option<&str>) -> &Arc<dyn Member> {
        let mut members = self.members.iter();
        match name {
            None => &self.members[0],
            Some(name) => {
                members.find(|member| member.name() == name).expect("the name was checked at build")
            }
        }
    }

    /// A number that the first solver shows which has it.
    pub fn number(&self, name: &str) -> Option<f64> {
        let mut members = self.members.iter();
        members.find_map(|member| member.number(&self.simulation, name))
    }

    /// Size of the column that the sample is \[m\], if it is one.
    pub fn column(&self) -> Option<ColumnSize> {
        self.members.iter().find_map(|member| member.column())
    }

    /// Makes all changes at the start of a stage. Returns what happened, by solver.
    pub fn begin(&mut self, stage: usize) -> Vec<(String, Notes)> {
        let Self { simulation, members, .. } = self;
        members.iter().map(|member| (member.name().to_owned(), member.begin(simulation, stage))).collect()
    }

    /// Step that the solver takes unless a stage chooses its own \[s\]; `None` for the recommended one. Among several, each takes
    /// its own within a long one.
    pub(crate) fn time_step(&self) -> Option<f64> {
        match self.members.as_slice() {
            [alone] => alone.time_step(),
            _ => None,
        }
    }
}

/// Builds the simulation of a scene.
///
/// # Errors
/// With all problems of the scene.
pub fn build(scene: &Scene) -> Result<Model, Vec<SceneProblem>> {
    let mut problems = Problems::default();
    check_frame(scene, &mut problems);
    #[cfg(any(feature = "dem", feature = "mpm"))]
    crate::methods::push::check_figures(scene, &mut problems);
    outputs::check_files(scene, &mut problems);
    if scene.solvers.is_empty() {
        let allowed =
            "one or more, such as { \"grains\": Dem(()) } or { \"water\": Lbm((spacing: \"1 mm\")) }";
        problems.add("solvers", "an empty map", allowed, "");
        return Err(problems.0);
    }
    methods::unused::refuse_unused(scene, &mut problems);
    let before = problems.0.len();
    if parts::groups(scene).len() > 1 {
        let names: Vec<&str> = scene.solvers.keys().map(String::as_str).collect();
        let hint = "a run takes solvers that nothing joins apart, each into a folder of its own";
        problems.add("solvers", names.join(", "), "solvers that are joined by `couplings`", hint);
    }
    couplings::check(scene, &mut problems);
    if problems.0.len() > before {
        return Err(problems.0);
    }
    let (mut building, mut members) = (Building::default(), Vec::new());
    for name in couplings::order(scene) {
        members.extend(scene.solvers[name].method().build(scene, name, &mut building, &mut problems));
    }
    let simulation = building.done().filter(|_| problems.0.is_empty());
    let Some(mut simulation) = simulation else { return Err(problems.0) };
    members.sort_by(|a, b| a.name().cmp(b.name()));
    if members.len() > 1 {
        members.iter().for_each(|member| member.choose_step(&mut simulation));
    }
    let up = if scene.dimension == Dimension::Plane { D2::UP } else { D3::UP };
    let model = Model { simulation, members, up };
    outputs::check_names(scene, &model, &mut problems);
    if problems.0.is_empty() { Ok(model) } else { Err(problems.0) }
}

/// Limits that can be told of a scene that takes long to build; nothing for other scenes, and for those that are wrong.
pub(crate) fn early_limits(scene: &Scene) -> Option<Limits> {
    scene.solvers.iter().find_map(|(name, solver)| solver.method().early_limits(scene, name))
}

/// Saves the state as it is now as a sample for other scenes.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn save_sample(scene: &Scene, model: &Model, path: &Path) -> Result<(), Failure> {
    let saves = model.members.iter().find(|member| member.offers(Part::Saving));
    saves.unwrap_or(&model.members[0]).save_sample(scene, &model.simulation, path)
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
        let of_pushes = stage.changes.iter().enumerate().filter_map(|(c, change)| match change {
            Change::Push { of: Some(of), .. } => Some((format!("stages.{k}.changes.{c}.of"), of)),
            _ => None,
        });
        let named = stage.of.iter().map(|of| (format!("stages.{k}.of"), of)).chain(of_pushes);
        for (path, of) in named.filter(|(_, of)| !scene.solvers.contains_key(*of)) {
            let known: Vec<&str> = scene.solvers.keys().map(String::as_str).collect();
            let hint = nearest(of, known.iter().copied());
            let value = format!("`{of}`, which is no solver of this scene");
            problems.add(path, value, known.join(", "), hint);
        }
        if let Some(step) = stage.time_step.filter(|step| step.value() <= 0.0) {
            problems.add(format!("stages.{k}.time_step"), step, "a positive time", "");
        }
    }
    if scene.snapshot_every.value() <= 0.0 {
        problems.add("snapshot_every", scene.snapshot_every, "a positive time", "");
    }
}
