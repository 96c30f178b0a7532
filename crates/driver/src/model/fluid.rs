//! A fluid for the lattice Boltzmann method.

mod read;

use super::{Action, Model, Problems, outputs};
use crate::scene::{Change, End, Scene};
use crate::scene_file::SceneProblem;
use granular_core::{Dim, Limits, Simulation, Solver, Vector};
use granular_coupling::{CarriedObstacles, PrescribedMotion};
use granular_lbm::spec::{LbmSpec, PrecisionSpec};
use granular_lbm::{D2Q9, D3Q19, Lattice, Lbm, Real, SetupError};
use read::{Fluid, Reader, components};
use std::any::Any;

/// Builds the simulation of a scene of a fluid.
pub(super) fn build<L: Lattice<Q>, const Q: usize>(
    scene: &Scene,
    name: &str,
    spec: &LbmSpec,
    mut problems: Problems,
) -> Result<Model, Vec<SceneProblem>> {
    refuse_grains(scene, name, &mut problems);
    let stages = actions::<L::Dim>(scene, &mut problems);
    let fluid = match &scene.fluid {
        Some(fluid) => Reader { scene, fluid, spec, name, problems: &mut problems }.read::<L::Dim>(),
        None => {
            let hint = "add fluid: (size: [\"1 m\", \"1 m\"], viscosity: \"1e-6 m^2/s\")";
            problems.add("fluid", "missing", "the fluid that the method solves", hint);
            None
        }
    };
    let Some(fluid) = fluid.filter(|_| problems.0.is_empty()) else { return Err(problems.0) };
    let simulation = match spec.precision {
        PrecisionSpec::Double => simulation::<L, f64, Q>(name, fluid),
        PrecisionSpec::Single => simulation::<L, f32, Q>(name, fluid),
    };
    let simulation = simulation.map_err(|problem| vec![*problem])?;
    outputs::check_names(scene, simulation.solver(), "front", &mut problems);
    if !problems.0.is_empty() {
        return Err(problems.0);
    }
    Ok(Model { simulation, stages, time_step: None, column: None, up: L::Dim::UP })
}

/// Cells from which on a lattice takes long to build.
const MANY_CELLS: usize = 1_000_000;

/// Limits of a lattice of many cells, from one of the same cells, faces and speeds that is small: none depends on the
/// number of cells.
pub(super) fn early_limits<L: Lattice<Q>, const Q: usize>(
    scene: &Scene,
    name: &str,
    spec: &LbmSpec,
) -> Option<Limits> {
    let mut problems = Problems::default();
    let fluid = scene.fluid.as_ref()?;
    let Fluid { mut setup, .. } =
        Reader { scene, fluid, spec, name, problems: &mut problems }.read::<L::Dim>()?;
    if !problems.0.is_empty() || setup.cells.iter().product::<usize>() < MANY_CELLS {
        return None;
    }
    setup.cells = setup.cells.map(|along| along.min(8));
    (setup.obstacles, setup.gauges) = (Vec::new(), Vec::new());
    let mut limits = Limits::default();
    Lbm::<L, Q, f64>::new(setup).ok()?.limits(&mut limits);
    Some(limits)
}

/// What belongs to grains only.
fn refuse_grains(scene: &Scene, name: &str, problems: &mut Problems) {
    let hint = format!("`{name}` is Lbm, which solves a fluid only");
    let given = [
        ("sample", scene.sample.is_some()),
        ("materials", !scene.materials.is_empty()),
        ("pairs", !scene.pairs.is_empty()),
        ("walls", !scene.walls.is_empty()),
    ];
    for (key, _) in given.into_iter().filter(|(_, is_given)| *is_given) {
        problems.add(key, "given", format!("no {key}"), hint.clone());
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        if let End::Quiet { .. } = stage.end {
            problems.add(format!("stages.{k}.end"), "Quiet, which is for grains", "For or Steady", "");
        }
        if stage.time_step.is_some() {
            let hint = format!("set solvers.{name}.step");
            let allowed = "no step of its own: that of the lattice is tied to its cells";
            problems.add(format!("stages.{k}.time_step"), "given", allowed, hint);
        }
    }
}

fn actions<D: Dim>(scene: &Scene, problems: &mut Problems) -> Vec<Vec<Action>> {
    let mut stages = Vec::new();
    for (k, stage) in scene.stages.iter().enumerate() {
        let mut list = Vec::new();
        for (c, change) in stage.changes.iter().enumerate() {
            let path = format!("stages.{k}.changes.{c}");
            match change {
                Change::Gravity(values) => {
                    problems.vector::<D, _>(&path, values);
                    list.push(Action::Gravity(values.iter().map(|value| value.value()).collect()));
                }
                Change::FaceVelocity { face, velocity } => {
                    let velocity = velocity.iter().map(|value| value.value()).collect();
                    list.push(Action::FaceVelocity(face.clone(), velocity));
                }
                Change::ObstacleSpin { obstacle, spin } => {
                    let spin: Vec<f64> = spin.iter().map(|value| value.value()).collect();
                    list.push(Action::ObstacleSpin(obstacle.clone(), components(&spin)));
                }
                _ => {
                    let allowed = "FaceVelocity, ObstacleSpin or Gravity, for a fluid";
                    problems.add(path, "a change of grains or walls", allowed, "");
                }
            }
        }
        stages.push(list);
    }
    stages
}

/// The lattice, with the paths of obstacles that move coupled to it.
fn simulation<L: Lattice<Q>, T: Real, const Q: usize>(
    name: &str,
    fluid: Fluid<L::Dim>,
) -> Result<Simulation, Box<SceneProblem>> {
    let refuse = |path: &str, value: String, allowed: String| {
        Box::new(SceneProblem::at_path(path.to_owned(), value, allowed, ""))
    };
    let mut lbm = Lbm::<L, Q, T>::new(fluid.setup).map_err(|error| {
        let (path, value) = place_of(name, &error);
        refuse(&path, value, error.allowed)
    })?;
    for (k, obstacle) in lbm.setup().obstacles.iter().enumerate() {
        if lbm.cells_in(k) == 0 {
            let value = format!("`{}`, which covers the centre of no cell", obstacle.name);
            let allowed = "an obstacle in the box, of several cells".to_owned();
            return Err(refuse(&format!("fluid.obstacles.{k}.shape"), value, allowed));
        }
    }
    // A moving obstacle may leave a gauge free later.
    for gauge in lbm.setup().gauges.iter().filter(|_| fluid.bodies.is_empty()) {
        if lbm.flow_at(gauge.place).is_none() {
            let place = format!("fluid.gauges.{}", super::grains::quoted(&gauge.name));
            let value = format!("`{}`, which has too few cells of the fluid around it", gauge.name);
            let allowed = "a place in the fluid, outside of obstacles".to_owned();
            return Err(refuse(&place, value, allowed));
        }
    }
    let start = fluid.start;
    lbm.set_flow(move |point| granular_lbm::Flow { pressure: 0.0, velocity: start(point) });
    let mut simulation = Simulation::named(name, Box::new(lbm));
    if fluid.bodies.is_empty() {
        return Ok(simulation);
    }
    let (numbers, bodies) = fluid.bodies.into_iter().unzip();
    let motion = PrescribedMotion::new(bodies)
        .map_err(|error| refuse("fluid.obstacles", error.to_string(), error.allowed.to_owned()))?;
    let coupled = (|| {
        let water = simulation.find::<Lbm<L, Q, T>>(name).expect("the lattice was just put there");
        let motion = simulation.add("paths of obstacles", motion)?;
        simulation.couple(water, motion, CarriedObstacles::<L::Dim>::numbered(numbers))
    })();
    coupled.map_err(|error: granular_core::CouplingError| {
        refuse("fluid.obstacles", error.to_string(), "paths that fit the fluid".to_owned())
    })?;
    Ok(simulation)
}

/// Where in the scene a refusal of the lattice belongs, and what is there.
fn place_of(name: &str, error: &SetupError) -> (String, String) {
    let SetupError { what, value, .. } = error;
    match what.as_str() {
        "Lambda" | "relaxation rate" => (format!("solvers.{name}.operator"), format!("of {what} {value}")),
        "cells" => (format!("solvers.{name}.spacing"), format!("such that cells are {value}")),
        "faces" => ("fluid.faces".to_owned(), value.clone()),
        "body force" => ("fluid.forces".to_owned(), value.clone()),
        "velocity of a wall" => ("fluid.faces".to_owned(), format!("with a {what} {value}")),
        _ => ("fluid".to_owned(), format!("with {what} {value}")),
    }
}

/// Makes a change, if the solver is of this method.
pub(super) fn apply(action: &Action, solver: &mut dyn Any) {
    if let Some(lbm) = solver.downcast_mut::<Lbm<D2Q9, 9, f64>>() {
        apply_to(lbm, action);
    } else if let Some(lbm) = solver.downcast_mut::<Lbm<D2Q9, 9, f32>>() {
        apply_to(lbm, action);
    } else if let Some(lbm) = solver.downcast_mut::<Lbm<D3Q19, 19, f64>>() {
        apply_to(lbm, action);
    } else if let Some(lbm) = solver.downcast_mut::<Lbm<D3Q19, 19, f32>>() {
        apply_to(lbm, action);
    }
}

fn apply_to<L: Lattice<Q>, T: Real, const Q: usize>(lbm: &mut Lbm<L, Q, T>, action: &Action) {
    let vector =
        |values: &[f64]| Vector::from_slice(values).expect("the number of axes was checked at build");
    match action {
        Action::Gravity(values) => {
            lbm.set_acceleration(vector(values)).expect("numbers of a scene are finite");
        }
        Action::FaceVelocity(face, velocity) => {
            lbm.set_face_velocity(face, vector(velocity)).expect("the face was checked at build");
        }
        Action::ObstacleSpin(name, spin) => {
            let mut motion = lbm.obstacle_motion(name).expect("the name was checked at build");
            motion.spin = granular_core::Spin::of_components(*spin);
            // A surface as fast as sound is refused by the Mach number, before the start.
            lbm.set_obstacle_motion(name, motion).expect("the speed was checked at build");
        }
        _ => {}
    }
}
