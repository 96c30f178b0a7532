//! How walls of a scene move, and walls made of grains that are held.

use super::{BuiltWall, Surroundings};
use crate::machine::room_for;
use crate::problems::Problems;
use crate::scene::boundaries::MotionSpec;
use crate::scene::{Change, Scene};
use granular_core::units::Length;
use granular_core::walls::{PressureBetween, Servo};
use granular_core::{Dim, Linear, Shape, Spin, Vector, WallMotion};

/// More held grains than this are a slip of the pen.
const MOST_HELD: f64 = 1e7;
/// Memory that a held grain takes \[bytes\].
const BYTES_PER_HELD: f64 = 500.0;

/// Whether some stage starts the wall or inlet of this name: it waits until then.
pub(crate) fn waits(scene: &Scene, name: &str) -> bool {
    let mut changes = scene.stages.iter().flat_map(|stage| &stage.changes);
    changes.any(|change| matches!(change, Change::Start(started) if started == name))
}

/// Gives a wall its motion, if that can be.
pub(super) fn set_moving<D: Dim>(
    path: &str,
    (walls, index): (&mut [BuiltWall<D>], usize),
    spec: &MotionSpec,
    around: &Surroundings<'_>,
    problems: &mut Problems,
) {
    let Some(motion) = motion::<D>(path, (walls, index), spec, around, problems) else { return };
    let wall = &mut walls[index];
    if let Err(error) = motion.check(&wall.name) {
        let value = format!("a motion that cannot be: {} is {}", error.what, error.value);
        problems.add(format!("{path}.moves"), value, error.allowed, "");
        return;
    }
    wall.motion = Some(motion);
    wall.waits = waits(around.scene, &wall.name);
}

fn motion<D: Dim>(
    path: &str,
    (walls, index): (&[BuiltWall<D>], usize),
    spec: &MotionSpec,
    around: &Surroundings<'_>,
    problems: &mut Problems,
) -> Option<WallMotion<D>> {
    let path = format!("{path}.moves");
    Some(match spec {
        MotionSpec::Steady(velocity) => {
            WallMotion::Steady { velocity: problems.vector::<D, _>(&format!("{path}.Steady"), velocity)? }
        }
        MotionSpec::Oscillate { amplitude, frequency, phase } => WallMotion::Oscillating {
            amplitude: problems.vector::<D, _>(&format!("{path}.amplitude"), amplitude)?,
            frequency: frequency.value(),
            phase: phase.value(),
        },
        MotionSpec::Rotate { about, spin } => {
            let about = problems.vector::<D, _>(&format!("{path}.about"), about)?;
            let rates: Vec<f64> = spin.iter().map(|rate| rate.value()).collect();
            let Some(spin) = spin_of::<D>(&rates) else {
                let allowed = if D::N == 2 { "one value, about z" } else { "three values" };
                problems.add(format!("{path}.spin"), format!("a list of {}", rates.len()), allowed, "");
                return None;
            };
            WallMotion::Turning { about, spin }
        }
        MotionSpec::Servo { .. } => {
            WallMotion::Servo(servo::<D>(&path, (walls, index), spec, around, problems)?)
        }
    })
}

/// One value in the plane, three in space.
fn spin_of<D: Dim>(rates: &[f64]) -> Option<D::Spin> {
    match (D::N, rates) {
        (2, [z]) => Some(D::Spin::about_z(*z)),
        (3, [x, y, z]) => Some(D::Spin::of_components([*x, *y, *z])),
        _ => None,
    }
}

fn servo<D: Dim>(
    path: &str,
    (walls, index): (&[BuiltWall<D>], usize),
    spec: &MotionSpec,
    around: &Surroundings<'_>,
    problems: &mut Problems,
) -> Option<Servo<D>> {
    let MotionSpec::Servo { direction, force, pressure, area, between, mass, damping, max_speed } = spec
    else {
        return None;
    };
    let wall = &walls[index];
    let direction = match (direction.as_slice(), &wall.shape) {
        ([], Shape::Plane { normal, .. }) => *normal,
        ([], _) => {
            problems.add(
                format!("{path}.direction"),
                "missing",
                "one number per axis",
                "only a plane has a normal",
            );
            return None;
        }
        (numbers, _) => {
            let numbers: Vec<Length> = numbers.iter().map(|&number| number.into()).collect();
            problems.vector::<D, _>(&format!("{path}.direction"), &numbers)?
        }
    };
    let (force, pressure) = match (force, pressure, area, between.as_slice()) {
        (Some(force), None, None, []) => (force.value(), None),
        (None, Some(pressure), Some(area), []) => (pressure.value() * area, None),
        (None, Some(pressure), None, [_, ..]) => {
            let given = (pressure.value(), between.as_slice());
            (0.0, Some(between_planes::<D>(path, (walls, index), given, problems)?))
        }
        _ => {
            let hint = "a force, or a pressure with the area or the walls between which it acts";
            problems.add(path, "a servo", "force: .., or pressure: .. with area: .. or between: ..", hint);
            return None;
        }
    };
    let mass = mass.map_or(around.mass, |mass| mass.value());
    let stiffness = (around.stiffness)(&wall.material);
    Some(Servo {
        direction: direction * (1.0 / direction.length()),
        force,
        pressure,
        mass,
        damping: damping.unwrap_or((mass * stiffness).sqrt()),
        max_speed: max_speed.map_or(f64::INFINITY, |speed| speed.value()),
    })
}

/// A pressure between planes that face one another, from pairs of names.
fn between_planes<D: Dim>(
    path: &str,
    (walls, index): (&[BuiltWall<D>], usize),
    (pressure, pairs): (f64, &[Vec<String>]),
    problems: &mut Problems,
) -> Option<PressureBetween> {
    let path = format!("{path}.between");
    if pairs.len() != D::N - 1 {
        let allowed = if D::N == 2 { "one pair of planes" } else { "two pairs of planes" };
        problems.add(path, format!("a list of {}", pairs.len()), allowed, "such as [[\"left\", \"right\"]]");
        return None;
    }
    let place = |name: &String| walls.iter().position(|wall| wall.name == *name);
    let mut found = PressureBetween { pressure, walls: [[0; 2]; 2] };
    let mut known = true;
    for (indices, pair) in found.walls.iter_mut().zip(pairs) {
        match pair.iter().map(place).collect::<Option<Vec<_>>>().map(<[usize; 2]>::try_from) {
            Some(Ok(pair)) => *indices = pair,
            _ => known = false,
        }
    }
    if known && found.check(&walls[index].name, walls).is_ok() {
        return Some(found);
    }
    let planes = walls.iter().filter(|wall| matches!(wall.shape, Shape::Plane { .. }));
    let planes: Vec<&str> = planes.map(|wall| wall.name.as_str()).collect();
    let named: Vec<String> = pairs.iter().map(|pair| format!("[{}]", pair.join(", "))).collect();
    let allowed = format!("two planes that face one another, of: {}", planes.join(", "));
    problems.add(path, named.join(", "), allowed, "");
    None
}

/// A lattice of held grains in a box, out of place by up to `scatter` along each axis.
pub(super) fn held_grains<D: Dim>(
    path: &str,
    (low, high): (D::Vec, D::Vec),
    (diameter, spacing, scatter): (f64, f64, f64),
    seed: u64,
    problems: &mut Problems,
) -> Option<Vec<(D::Vec, f64)>> {
    if !(spacing > 0.0 && diameter > 0.0 && scatter >= 0.0 && low.max(high) == high) {
        let value = format!("diameter {diameter} m, spacing {spacing} m, scatter {scatter} m");
        problems.add(path, value, "positive diameter and spacing, scatter of 0 or more, low below high", "");
        return None;
    }
    let along = |axis: usize| ((high - low).component(axis) / spacing + 1e-9).floor() + 1.0;
    let count = (0..D::N).map(along).product::<f64>();
    let allowed =
        if count > MOST_HELD { Err("at most 1e7".to_owned()) } else { room_for(count, BYTES_PER_HELD) };
    if let Err(allowed) = allowed {
        problems.add(path, format!("{count:.0} held grains"), allowed, "a larger spacing makes fewer");
        return None;
    }
    let mut chance = granular_core::random::Chance::new(seed);
    let mut held = Vec::new();
    for index in 0..count as usize {
        let (mut rest, mut at) = (index, low);
        for axis in 0..D::N {
            let sites = along(axis) as usize;
            let offset = if scatter > 0.0 { chance.between(-scatter, scatter) } else { 0.0 };
            at += D::Vec::along(axis, (rest % sites) as f64 * spacing + offset);
            rest /= sites;
        }
        held.push((at, 0.5 * diameter));
    }
    Some(held)
}
