//! From a scene to a fluid.

use super::carried::Carried;
use super::member::{Action, Stages, Water};
use super::read::{Fluid, Reader, components};
use super::resolved;
use crate::methods::contract::Building;
use crate::methods::member::Member;
use crate::problems::{Problems, quoted};
use crate::scene::{Change, Scene};
use granular_core::{Dim, Limits, NodeKey, Solver};
use granular_coupling::{CarriedObstacles, PrescribedMotion};
use granular_lbm::spec::{LbmSpec, PrecisionSpec};
use granular_lbm::{Lattice, Lbm, Real, SetupError};
use std::sync::Arc;

/// Adds the fluid of a scene to the simulation.
pub(super) fn build<L: Lattice<Q>, const Q: usize>(
    scene: &Scene,
    name: &str,
    spec: &LbmSpec,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<Arc<dyn Member>> {
    let before = problems.0.len();
    let stages = actions::<L::Dim>(scene, problems);
    let fluid = match &scene.fluid {
        Some(fluid) => Reader { scene, fluid, spec, name, problems }.read::<L::Dim>(),
        None => {
            let hint = "add fluid: (size: [\"1 m\", \"1 m\"], viscosity: \"1e-6 m^2/s\")";
            problems.add("fluid", "missing", "the fluid that the method solves", hint);
            None
        }
    };
    let mut fluid = fluid.filter(|_| problems.0.len() == before)?;
    let carried = Carried::of(scene, name, &mut fluid.setup, simulation, problems)?;
    let water = (name, fluid, stages);
    match spec.precision {
        PrecisionSpec::Double => add::<L, f64, Q>(scene, water, carried, simulation, problems),
        PrecisionSpec::Single => add::<L, f32, Q>(scene, water, carried, simulation, problems),
    }
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

/// What each stage does at its start.
fn actions<D: Dim>(scene: &Scene, problems: &mut Problems) -> Stages<D> {
    let mut stages = Vec::new();
    for (k, stage) in scene.stages.iter().enumerate() {
        let mut list = Vec::new();
        for (c, change) in stage.changes.iter().enumerate() {
            let path = format!("stages.{k}.changes.{c}");
            match change {
                Change::Gravity(values) => {
                    list.extend(problems.vector::<D, _>(&path, values).map(Action::Gravity));
                }
                Change::FaceVelocity { face, velocity } => {
                    let velocity = velocity.iter().map(|value| value.value()).collect();
                    list.push(Action::FaceVelocity(face.clone(), velocity));
                }
                Change::ObstacleSpin { obstacle, spin } => {
                    let spin: Vec<f64> = spin.iter().map(|value| value.value()).collect();
                    list.push(Action::ObstacleSpin(obstacle.clone(), components(&spin)));
                }
                // Of another method, or refused.
                _ => {}
            }
        }
        stages.push(list);
    }
    stages
}

/// Adds the lattice, with the paths of obstacles that move coupled to it.
fn add<L: Lattice<Q>, T: Real, const Q: usize>(
    scene: &Scene,
    (name, fluid, stages): (&str, Fluid<L::Dim>, Stages<L::Dim>),
    carried: Vec<Carried<L::Dim>>,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<Arc<dyn Member>> {
    let mut lbm = match Lbm::<L, Q, T>::new(fluid.setup) {
        Ok(lbm) => lbm,
        Err(error) => {
            let (path, value) = place_of(name, &error);
            problems.add(path, value, error.allowed, "");
            return None;
        }
    };
    let before = problems.0.len();
    let all_rest = fluid.bodies.is_empty() && carried.is_empty();
    check_places(&lbm, all_rest, problems);
    if problems.0.len() > before {
        return None;
    }
    let start = fluid.start;
    lbm.set_flow(move |point| granular_lbm::Flow { pressure: 0.0, velocity: start(point) });
    let added = simulation.add(name, lbm);
    let key = added.map_err(|error| problems.add("solvers", error.place, error.reason, "")).ok()?;
    if !fluid.bodies.is_empty() {
        move_bodies(key, fluid.bodies, simulation, problems)?;
    }
    for grains in carried {
        grains.couple(key, simulation, problems)?;
    }
    resolved::couple(scene, name, key, simulation, problems)?;
    Some(Arc::new(Water { name: name.to_owned(), key, stages }))
}

/// Whether obstacles cover cells, and gauges have cells around them.
fn check_places<L: Lattice<Q>, T: Real, const Q: usize>(
    lbm: &Lbm<L, Q, T>,
    all_rest: bool,
    problems: &mut Problems,
) {
    for (k, obstacle) in lbm.setup().obstacles.iter().enumerate() {
        if lbm.cells_in(k) == 0 {
            let value = format!("`{}`, which covers the centre of no cell", obstacle.name);
            let allowed = "an obstacle in the box, of several cells";
            problems.add(format!("fluid.obstacles.{k}.shape"), value, allowed, "");
        }
    }
    // A moving obstacle may leave a gauge free later.
    for gauge in lbm.setup().gauges.iter().filter(|_| all_rest) {
        if lbm.flow_at(gauge.place).is_none() {
            let place = format!("fluid.gauges.{}", quoted(&gauge.name));
            let value = format!("`{}`, which has too few cells of the fluid around it", gauge.name);
            problems.add(place, value, "a place in the fluid, outside of obstacles", "");
        }
    }
}

/// Lets obstacles follow their paths.
fn move_bodies<L: Lattice<Q>, T: Real, const Q: usize>(
    water: NodeKey<Lbm<L, Q, T>>,
    bodies: Vec<(usize, granular_coupling::Body<L::Dim>)>,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<()> {
    let (numbers, bodies) = bodies.into_iter().unzip();
    let motion = PrescribedMotion::new(bodies);
    let motion =
        motion.map_err(|error| problems.add("fluid.obstacles", error.to_string(), error.allowed, "")).ok()?;
    let coupled = simulation.add("paths of obstacles", motion).and_then(|motion| {
        simulation.simulation().couple(water, motion, CarriedObstacles::<L::Dim>::numbered(numbers))
    });
    let refused = |error: granular_core::CouplingError| {
        problems.add("fluid.obstacles", error.to_string(), "paths that fit the fluid", "");
    };
    coupled.map_err(refused).ok()
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
