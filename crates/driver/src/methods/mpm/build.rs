//! From a scene to bodies and walls.

use super::member::{Continuum, Made};
use super::sample::{self, BuiltSample};
use super::{materials, stages};
use crate::methods::contract::Building;
use crate::methods::member::Member;
use crate::problems::{Problems, nearest};
use crate::scene::{FigureSpec, Sample, Scene, Writer};
use crate::walls::{self, Beside, BuiltWall, Surroundings};
use granular_core::{Dim, Linear, Vector, WallMotion};
use granular_mpm::spec::{BodyContactSpec, ConditionSpec, MpmSpec};
use granular_mpm::{Condition, Contact, Mpm, Setup, Wall};
use std::sync::Arc;

/// Adds the continuum of a scene to the simulation.
pub(super) fn build<D: Dim>(
    scene: &Scene,
    name: &str,
    spec: &MpmSpec,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<Arc<dyn Member>> {
    let before = problems.0.len();
    let gravity = if scene.gravity.is_empty() {
        Some(D::Vec::ZERO)
    } else {
        problems.vector::<D, _>("gravity", &scene.gravity)
    };
    let sample = sample::bodies::<D>(scene, name, spec, problems);
    if let Some(sample) = &sample {
        check_contacts(name, spec, sample, problems);
    }
    let (walls, openings) = boundaries::<D>(scene, name, spec, sample.as_ref(), problems);
    let names: Vec<&str> = walls.iter().map(|wall| wall.name.as_str()).collect();
    let grains =
        sample.as_ref().and_then(|sample| materials::grains::<D>(scene, &sample.bodies.first()?.said));
    // Of a sample that is blamed already nothing is known.
    let knows_grains = sample.is_none() || grains.is_some();
    let stages = stages::actions::<D>((scene, name), &openings, &names, (knows_grains, problems));
    if let Some(step) = spec.time_step.filter(|step| step.value() <= 0.0) {
        problems.add(format!("solvers.{name}.time_step"), step, "a positive time", "");
    }
    let (Some(gravity), Some(mut sample), true) = (gravity, sample, problems.0.len() == before) else {
        return None;
    };
    if let Some(ratio) = spec.earth_pressure_at_rest {
        let weight = -gravity.component(D::UP);
        let edge = spec.cell.value() / spec.particles_along_edge(D::N)? as f64;
        sample.bodies.iter_mut().for_each(|body| sample::put_at_rest(body, weight, ratio, edge));
    }
    let setup =
        Setup { gravity, walls, options: spec.options(needs_ledger(scene)), ..Setup::new(spec.cell.value()) };
    let mut refused = |error: granular_core::SetupError| {
        problems.add(format!("solvers.{name}"), format!("refused: {error}"), error.allowed, "");
    };
    let mut mpm = Mpm::<D>::new(setup).map_err(&mut refused).ok()?;
    let mut bodies = Vec::new();
    for body in &sample.bodies {
        bodies.push(mpm.body(body.law, body.density, &body.particles).map_err(&mut refused).ok()?);
    }
    for (one, other, contact) in in_contact(spec, &sample) {
        mpm.contact(bodies[one], bodies[other], contact).map_err(&mut refused).ok()?;
    }
    let made = Made { stages, column: sample.column, time_step: spec.time_step, grains };
    Continuum::add(name, mpm, made, simulation, problems)
}

/// Blames contacts of continua that no body is of, and such as are between nothing.
fn check_contacts<D: Dim>(name: &str, spec: &MpmSpec, sample: &BuiltSample<D>, problems: &mut Problems) {
    let known: Vec<&str> = sample.bodies.iter().map(|body| body.material.as_str()).collect();
    for (k, BodyContactSpec { between: (one, other), .. }) in spec.contacts.iter().enumerate() {
        let path = format!("solvers.{name}.contacts.{k}.between");
        for unknown in [one, other].into_iter().filter(|named| !known.contains(&named.as_str())) {
            let hint = nearest(unknown, known.iter().copied());
            problems.add(&path, format!("`{unknown}`, of which there is no body"), known.join(", "), hint);
        }
        if one == other && known.iter().filter(|named| *named == one).count() == 1 {
            let hint = "a body is in contact with others only";
            problems.add(&path, format!("`{one}` twice"), "two bodies or more of it, or two continua", hint);
        }
    }
}

/// Pairs of bodies that are in contact, by their numbers; of contacts that fit one pair the last one counts.
fn in_contact<D: Dim>(spec: &MpmSpec, sample: &BuiltSample<D>) -> Vec<(usize, usize, Contact)> {
    let count = sample.bodies.len();
    let pairs = (0..count).flat_map(|one| (one + 1..count).map(move |other| (one, other)));
    let contact = |(one, other): (usize, usize)| {
        let [first, second] = [one, other].map(|body| &sample.bodies[body].material);
        let fits = |contact: &&BodyContactSpec| {
            let (a, b) = &contact.between;
            (a, b) == (first, second) || (a, b) == (second, first)
        };
        let found = spec.contacts.iter().rev().find(fits)?;
        Some((one, other, Contact { friction: found.friction }))
    };
    pairs.filter_map(contact).collect()
}

/// Walls of a continuum, and which opens at which stage.
type Boundaries<D> = (Vec<Wall<D>>, Vec<(String, String, String)>);

fn boundaries<D: Dim>(
    scene: &Scene,
    name: &str,
    spec: &MpmSpec,
    sample: Option<&BuiltSample<D>>,
    problems: &mut Problems,
) -> Boundaries<D> {
    let beside = match (sample.map(|sample| sample.column), &scene.sample) {
        (Some(Some(column)), _) => Beside::Column(column),
        // Blamed already.
        (None, Some(Sample::Column { .. } | Sample::Cylinder { .. }) | None) => Beside::Unknown,
        _ => Beside::Nothing,
    };
    let around = Surroundings {
        scene,
        knows: &|path, material, problems| materials::knows(scene, path, material, problems),
        stiffness: &|_| 0.0,
        mass: sample.map_or(0.0, BuiltSample::mass),
        top: sample.map_or(0.0, BuiltSample::top),
    };
    let built = walls::walls::<D>(&scene.walls, beside, &around, problems);
    for known in spec.walls.keys().filter(|known| !built.list.iter().any(|wall| wall.name == **known)) {
        let names: Vec<&str> = built.list.iter().map(|wall| wall.name.as_str()).collect();
        let hint = nearest(known, names.iter().copied());
        problems.add(format!("solvers.{name}.walls"), format!("`{known}`"), names.join(", "), hint);
    }
    let walls = built.list.into_iter().map(|wall| of_continuum(scene, spec, wall, problems)).collect();
    (walls, built.openings)
}

/// A wall that a continuum meets.
fn of_continuum<D: Dim>(
    scene: &Scene,
    spec: &MpmSpec,
    wall: BuiltWall<D>,
    problems: &mut Problems,
) -> Wall<D> {
    let BuiltWall { name, shape, material, motion, waits } = wall;
    if matches!(motion, Some(WallMotion::Servo(_))) {
        let hint = "a wall under a force is for grains; let it move at a velocity";
        problems.add("walls", format!("a servo at wall `{name}`"), "Steady, Oscillate or Rotate", hint);
    }
    let condition = match spec.walls.get(&name) {
        None => Condition::frictional(materials::friction(scene, &material)),
        Some(ConditionSpec::Fixed) => Condition::Fixed,
        Some(ConditionSpec::Slip) => Condition::Slip,
        Some(ConditionSpec::Absorbing { compression_speed, shear_speed }) => Condition::Absorbing {
            compression_speed: compression_speed.value(),
            shear_speed: shear_speed.value(),
        },
        Some(ConditionSpec::Frictional { friction, static_friction }) => Condition::Frictional {
            friction: *friction,
            static_friction: static_friction.unwrap_or(*friction),
        },
    };
    Wall { name, shape, condition, open: false, motion, held: waits }
}

/// Whether anything asks for losses of energy.
fn needs_ledger(scene: &Scene) -> bool {
    let asks = |name: &String| name.starts_with("loss_") || name == "energy_residual";
    let in_tables = scene.outputs.iter().any(|output| match &output.write {
        Writer::Table { probes, .. } => probes.iter().any(asks),
        _ => false,
    });
    in_tables || scene.figures.iter().any(|figure| matches!(figure, FigureSpec::Energies { .. }))
}
