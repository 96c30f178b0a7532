//! From a scene to grains and walls.

use super::boundaries;
use super::materials::{NamedMaterials, inlet_materials};
use super::member::Grains;
use super::{cell, sample, stages, stiffness, whole};
use crate::methods::contract::Building;
use crate::methods::member::Member;
use crate::problems::{Problems, nearest};
use crate::scene::{Change, FigureSpec, Sample, Scene, Writer};
use crate::walls::{self, Beside, BuiltWall, Surroundings};
use granular_core::{Dim, Vector};
use granular_dem::spec::DemSpec;
use granular_dem::{Dem, Setup, SetupError, Wall};
use std::sync::Arc;

/// Adds the grains of a scene to the simulation.
pub(super) fn build<D: Dim>(
    scene: &Scene,
    name: &str,
    spec: &DemSpec,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<Arc<dyn Member>> {
    let before = problems.0.len();
    let gravity = if scene.gravity.is_empty() {
        Some(D::Vec::default())
    } else {
        problems.vector::<D, _>("gravity", &scene.gravity)
    };
    let mut materials = NamedMaterials::of(scene, spec, D::N == 2, problems);
    let sample = match &scene.sample {
        Some(sample) => sample::grains::<D>(sample, &scene.folder, &materials, problems),
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
        stiffness::derive::<D>(scene, &mut materials, radius, problems);
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
    let around = Surroundings {
        scene,
        knows: &|path, name, problems| materials.find(path, name, problems).is_some(),
        stiffness: &|name| materials.stiffness(name),
        mass: grains_mass,
        top,
    };
    let built = walls::walls::<D>(&scene.walls, beside, &around, problems);
    let openings = built.openings;
    let walls: Vec<Wall<D>> = built.list.into_iter().filter_map(|wall| of_grains(wall, &materials)).collect();
    let of_inlets = inlet_materials(scene, &materials, problems);
    refuse_traffic_in_a_cell(scene, problems);
    let cell = cell::cell::<D>(scene, sample.as_ref(), problems);
    let stages = stages::actions::<D>((scene, name), &openings, &materials, problems);
    check_wall_names(scene, &walls, problems);
    check_spec(name, spec, problems);
    let (Some(gravity), Some(sample), true) = (gravity, sample, problems.0.len() == before) else {
        return None;
    };
    let setup = Setup {
        materials: materials.list,
        grains: sample.grains,
        walls,
        gravity,
        options: spec.options(needs_ledger(scene)),
    };
    let mut dem = match Dem::<D>::new(setup) {
        Ok(dem) => dem,
        Err(error) => {
            refuse(name, &error, problems);
            return None;
        }
    };
    boundaries::traffic(scene, &mut dem, &of_inlets, problems);
    if let Some(Err(error)) = cell.map(|cell| dem.set_cell(cell)) {
        problems.add("cell", error.to_string(), error.allowed, "");
    }
    if problems.0.len() > before {
        return None;
    }
    Grains::add(name, dem, (stages, column, spec.time_step), simulation, problems)
}

/// A wall that grains touch.
fn of_grains<D: Dim>(wall: BuiltWall<D>, materials: &NamedMaterials) -> Option<Wall<D>> {
    let material = materials.id(&wall.material)?;
    let BuiltWall { name, shape, motion, waits, .. } = wall;
    Some(Wall { name, shape, material, open: false, motion, held: waits })
}

/// Says that a solver refuses its set-up. What is wrong with grains is not the solver's.
fn refuse(name: &str, error: &SetupError, problems: &mut Problems) {
    let place = if error.what.contains("grain") { "sample".to_owned() } else { format!("solvers.{name}") };
    problems.add(place, format!("refused: {error}"), error.allowed, "");
}

/// A periodic cell holds the grains that it began with.
fn refuse_traffic_in_a_cell(scene: &Scene, problems: &mut Problems) {
    let lists = [("inlets", scene.inlets.len()), ("outlets", scene.outlets.len())];
    for (path, count) in lists.into_iter().filter(|(_, count)| scene.cell.is_some() && *count > 0) {
        let hint = "what leaves a cell through one face comes back through the other: fill it by its `sample`, or leave out `cell`";
        problems.add(path, format!("{count} in a scene with a periodic cell"), "none beside `cell`", hint);
    }
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
