//! Grains and walls for the discrete element method.

pub(super) mod falling;
mod pairs;
mod stiffness;
mod whole;

use super::boundaries::{self, Surroundings};
use super::walls::{self, Beside};
use super::{Action, Model, Problems, PushRecord, Shake, nearest, outputs, push, sample};
use crate::failure::Failure;
use crate::sample_file::SavedSample;
use crate::scene::{Change, FigureSpec, Sample, Scene, Stage, Writer};
use crate::scene_file::SceneProblem;
pub(crate) use falling::Whereabouts;
use granular_core::units::Acceleration;
use granular_core::{D2, D3, Dim, Simulation, Vector};
use granular_dem::spec::DemSpec;
use granular_dem::{Dem, MaterialId, Materials, Setup, Shaking, Wall};
use std::any::Any;
use std::collections::BTreeMap;
use std::path::Path;

/// Materials of a scene, by name.
#[derive(Debug, Default)]
pub(crate) struct NamedMaterials {
    pub(crate) list: Materials,
    /// None for a material that was refused, so that its users are not blamed too.
    pub(super) ids: BTreeMap<String, Option<MaterialId>>,
}

impl NamedMaterials {
    fn of(scene: &Scene, spec: &DemSpec, plane: bool, problems: &mut Problems) -> Self {
        let mut named = Self::default();
        let contact = spec.contact;
        for (name, &spec) in &scene.materials {
            if !stiffness::is_stated(&format!("materials.{}", quoted(name)), &spec, contact, plane, problems)
            {
                named.ids.insert(name.clone(), None);
                continue;
            }
            let added = named.list.add(spec.into()).map_err(|error| {
                let key = error.what.replace(' ', "_");
                problems.add(format!("materials.{}.{key}", quoted(name)), error.value, error.allowed, "");
            });
            named.ids.insert(name.clone(), added.ok());
        }
        pairs::state(&scene.pairs, contact, &mut named, problems);
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
pub(super) fn quoted(key: &str) -> String {
    if key.contains(['.', '=', '[']) { format!("\"{key}\"") } else { key.to_owned() }
}

/// Builds the simulation of a scene of grains.
pub(super) fn build<D: Dim>(
    scene: &Scene,
    name: &str,
    spec: &DemSpec,
    mut problems: Problems,
) -> Result<Model, Vec<SceneProblem>> {
    if scene.fluid.is_some() {
        problems.add("fluid", "given", "no fluid", format!("`{name}` is Dem, which solves grains only"));
    }
    let gravity = if scene.gravity.is_empty() {
        Some(D::Vec::default())
    } else {
        problems.vector::<D, _>("gravity", &scene.gravity)
    };
    let mut materials = NamedMaterials::of(scene, spec, D::N == 2, &mut problems);
    let sample = match &scene.sample {
        Some(sample) => sample::grains::<D>(sample, &scene.folder, &materials, &mut problems),
        // Grains may all come in through inlets.
        None if !scene.inlets.is_empty() => {
            Some(sample::BuiltSample { grains: Vec::new(), column: None, cell: None })
        }
        None => {
            problems.add("sample", "missing", "the grains, such as a Column", "");
            None
        }
    };
    let here = || sample.iter().flat_map(|sample| &sample.grains);
    let whole = whole::Whole::of::<D>(scene, here());
    if sample.is_some()
        && let Some(radius) = whole.mean_radius()
    {
        stiffness::derive::<D>(scene, &mut materials, radius, &mut problems);
    }
    let column = sample.as_ref().and_then(|sample| sample.column);
    // A column that cannot be built has been blamed already; the walls beside it are not.
    let beside = match (&sample, &scene.sample) {
        (None, Some(Sample::Column { .. } | Sample::Cylinder { .. } | Sample::File { .. }) | None) => {
            Beside::Unknown
        }
        _ => column.map_or(Beside::Nothing, Beside::Column),
    };
    let top = here().map(|grain| grain.position.component(D::UP) + grain.radius).fold(0.0, f64::max);
    let grains_mass = whole.mass::<D>(here(), &materials);
    let around = Surroundings { scene, materials: &materials, grains_mass, top };
    let walls = walls::walls::<D>(&scene.walls, beside, &around, &mut problems);
    let of_inlets = inlet_materials(scene, &materials, &mut problems);
    refuse_traffic_in_a_cell(scene, &mut problems);
    let cell = super::cell::cell::<D>(scene, sample.as_ref(), &mut problems);
    let stages = actions::<D>(scene, &walls.openings, &materials, &mut problems);
    check_wall_names(scene, &walls.list, &mut problems);
    check_spec(name, spec, &mut problems);
    push::check_figures(scene, &mut problems);
    let (Some(gravity), Some(sample), true) = (gravity, sample, problems.0.is_empty()) else {
        return Err(problems.0);
    };
    let setup = Setup {
        materials: materials.list,
        grains: sample.grains,
        walls: walls.list,
        gravity,
        options: spec.options(needs_ledger(scene)),
    };
    let mut dem = Dem::<D>::new(setup).map_err(|error| {
        // What is wrong with grains is not the solver's.
        let place =
            if error.what.contains("grain") { "sample".to_owned() } else { format!("solvers.{name}") };
        vec![SceneProblem::at_path(place, format!("refused: {error}"), error.allowed, "")]
    })?;
    boundaries::traffic(scene, &mut dem, &of_inlets, &mut problems);
    if let Some(cell) = cell {
        dem.set_cell(cell)
            .map_err(|error| vec![SceneProblem::at_path("cell", error.to_string(), error.allowed, "")])?;
    }
    outputs::check_names(scene, &dem, column.map_or("front", |column| column.front()), &mut problems);
    if !problems.0.is_empty() {
        return Err(problems.0);
    }
    Ok(Model {
        simulation: Simulation::named(name, Box::new(dem)),
        stages,
        time_step: spec.time_step.map(|step| step.value()),
        column,
        up: D::UP,
    })
}

/// A periodic cell holds the grains that it began with.
fn refuse_traffic_in_a_cell(scene: &Scene, problems: &mut Problems) {
    let lists = [("inlets", scene.inlets.len()), ("outlets", scene.outlets.len())];
    for (path, count) in lists.into_iter().filter(|(_, count)| scene.cell.is_some() && *count > 0) {
        let hint = "what leaves a cell through one face comes back through the other: fill it by its `sample`, or leave out `cell`";
        problems.add(path, format!("{count} in a scene with a periodic cell"), "none beside `cell`", hint);
    }
}

/// Materials of inlets by name, or what is wrong with them.
fn inlet_materials(
    scene: &Scene,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Vec<(String, MaterialId)> {
    let mut found = Vec::new();
    for (k, inlet) in scene.inlets.iter().enumerate() {
        let id = materials.find(&format!("inlets.{k}.material"), &inlet.material, problems);
        found.extend(id.map(|id| (inlet.material.clone(), id)));
    }
    found
}

fn check_wall_names<D: Dim>(scene: &Scene, walls: &[Wall<D>], problems: &mut Problems) {
    let names: Vec<&str> = walls.iter().map(|wall| wall.name.as_str()).collect();
    let moving = walls.iter().filter(|wall| wall.motion.is_some()).map(|wall| wall.name.as_str());
    let started: Vec<&str> = moving.chain(scene.inlets.iter().map(|inlet| inlet.name.as_str())).collect();
    for (k, name) in names.iter().enumerate() {
        if names[..k].contains(name) {
            problems.add("walls", format!("two walls called `{name}`"), "walls with names of their own", "");
        }
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        for (c, change) in stage.changes.iter().enumerate() {
            let (name, names) = match change {
                Change::Open(name) | Change::Close(name) => (name, &names),
                Change::Start(name) | Change::Halt(name) => (name, &started),
                _ => continue,
            };
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

fn check_spec(name: &str, spec: &DemSpec, problems: &mut Problems) {
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
}

/// Whether anything asks for losses of energy.
fn needs_ledger(scene: &Scene) -> bool {
    let asks = |probes: &[String]| {
        probes.iter().any(|probe| {
            let sums = ["energy_residual", "wall_work", "energy_exchanged", "cell_work"];
            probe.starts_with("loss_") || sums.contains(&probe.as_str())
        })
    };
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
    let weighty = |gravity: &[Acceleration]| gravity.iter().any(|value| value.value() != 0.0);
    let mut falls = weighty(&scene.gravity);
    for (k, stage) in scene.stages.iter().enumerate() {
        let opened = openings.iter().filter(|(.., at)| *at == stage.name);
        let mut list: Vec<Action> = opened.map(|(_, wall, _)| Action::Wall(wall.clone(), true)).collect();
        // A shaking is over with its stage.
        let shakes =
            |stage: &Stage| stage.changes.iter().any(|change| matches!(change, Change::Shake { .. }));
        if k > 0 && shakes(&scene.stages[k - 1]) {
            list.push(Action::Shake(None));
        }
        for (c, change) in stage.changes.iter().enumerate() {
            let path = format!("stages.{k}.changes.{c}");
            if let Change::Gravity(values) = change {
                falls = weighty(values);
            }
            list.extend(match change {
                Change::Push { .. } => {
                    push::action::<D>(&path, change, (falls, scene.cell.is_some()), problems)
                }
                Change::Shake { .. } if scene.cell.is_some() => {
                    problems.add(
                        path,
                        "Shake",
                        "a scene without a cell",
                        "gravity and walls shake a box, not a cell",
                    );
                    None
                }
                Change::Cell(change) => {
                    let control = super::cell::control::<D>(&path, change, scene.cell.as_ref(), problems);
                    control.map(Action::Cell)
                }
                change => action::<D>(&path, change, materials, problems),
            });
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
        Change::Shake { acceleration, from, to, pass } => {
            let frequency = [from.value(), to.value()];
            for (key, value) in [("from", frequency[0]), ("to", frequency[1]), ("pass", pass.value())] {
                if value <= 0.0 {
                    problems.add(format!("{path}.{key}"), value, "above 0", "");
                }
            }
            problems.vector::<D, _>(&format!("{path}.acceleration"), acceleration)?;
            let acceleration = acceleration.iter().map(|value| value.value()).collect();
            Action::Shake(Some(Shake { acceleration, frequency, pass: pass.value() }))
        }
        Change::Open(name) => Action::Wall(name.clone(), true),
        Change::Close(name) => Action::Wall(name.clone(), false),
        Change::Start(name) => Action::Moving(name.clone(), true),
        Change::Halt(name) => Action::Moving(name.clone(), false),
        Change::FaceVelocity { .. } | Change::ObstacleSpin { .. } => {
            problems.add(path, "a change of a fluid", "a change of grains or walls", "");
            return None;
        }
        Change::Push { .. } | Change::Cell(_) => return None,
    })
}

/// Makes a change, if the solver is of this method.
pub(super) fn apply(action: &Action, solver: &mut dyn Any, pushed: &mut Option<PushRecord>) {
    if let Some(dem) = solver.downcast_mut::<Dem<D2>>() {
        apply_to(action, dem, pushed);
    } else if let Some(dem) = solver.downcast_mut::<Dem<D3>>() {
        apply_to(action, dem, pushed);
    }
}

fn apply_to<D: Dim>(action: &Action, dem: &mut Dem<D>, pushed: &mut Option<PushRecord>) {
    match action {
        Action::Push(action) => *pushed = Some(push::apply(action, dem, *pushed)),
        Action::Friction(material, value) => dem.set_friction(*material, *value),
        Action::Gravity(values) => {
            dem.set_gravity(D::Vec::from_slice(values).expect("the number of axes was checked at build"));
        }
        Action::StopMotion => dem.stop_motion(),
        Action::Shake(shake) => {
            let shaking = shake.as_ref().map(|shake| Shaking {
                acceleration: D::Vec::from_slice(&shake.acceleration).expect("axes were counted at build"),
                from: shake.frequency[0],
                to: shake.frequency[1],
                pass: shake.pass,
            });
            dem.set_shaking(shaking).expect("the values were checked at build");
        }
        Action::Wall(name, open) => _ = dem.set_open(name, *open),
        Action::Moving(name, runs) => {
            dem.set_moving(name, *runs);
            dem.set_inlet(name, *runs);
        }
        Action::Cell(control) => dem.control_cell(*control).expect("the control was checked at build"),
        // Of a fluid, and refused beside grains.
        Action::FaceVelocity(..) | Action::ObstacleSpin(..) => {}
    }
}

/// Saves the grains of a solver of this method.
pub(super) fn save_sample(scene: &Scene, model: &Model, path: &Path) -> Result<(), Failure> {
    // The order in which `NamedMaterials` counts them.
    let names: Vec<String> = scene.materials.keys().cloned().collect();
    let solver: &dyn Any = model.simulation.solver();
    if let Some(dem) = solver.downcast_ref::<Dem<D2>>() {
        SavedSample::of(dem, names, model.column).write(path)
    } else if let Some(dem) = solver.downcast_ref::<Dem<D3>>() {
        SavedSample::of(dem, names, model.column).write(path)
    } else {
        Ok(())
    }
}
