//! What happens to a continuum at the start of stages.

use crate::problems::{Problems, nearest};
use crate::scene::{Change, Scene};
use granular_core::Dim;
use granular_mpm::Mpm;

/// A change at the start of a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Action<D: Dim> {
    /// Gravity \[m/s^2\].
    Gravity(D::Vec),
    /// All velocities become zero.
    StopMotion,
    /// A wall opens or closes.
    Wall(String, bool),
    /// A moving wall starts or halts.
    Moving(String, bool),
}

/// What each stage does at its start.
pub(super) fn actions<D: Dim>(
    scene: &Scene,
    openings: &[(String, String, String)],
    walls: &[&str],
    problems: &mut Problems,
) -> Vec<Vec<Action<D>>> {
    crate::walls::check_openings(scene, openings, problems);
    let mut stages = Vec::new();
    for (k, stage) in scene.stages.iter().enumerate() {
        let opened = openings.iter().filter(|(.., at)| *at == stage.name);
        let mut list: Vec<Action<D>> = opened.map(|(_, wall, _)| Action::Wall(wall.clone(), true)).collect();
        for (c, change) in stage.changes.iter().enumerate() {
            let path = format!("stages.{k}.changes.{c}");
            list.extend(action::<D>(&path, change, walls, problems));
        }
        stages.push(list);
    }
    stages
}

fn action<D: Dim>(path: &str, change: &Change, walls: &[&str], problems: &mut Problems) -> Option<Action<D>> {
    let mut known = |name: &String| {
        if !walls.contains(&name.as_str()) {
            let hint = nearest(name, walls.iter().copied());
            problems.add(path, format!("`{name}`"), walls.join(", "), hint);
        }
        name.clone()
    };
    Some(match change {
        Change::Gravity(values) => Action::Gravity(problems.vector::<D, _>(path, values)?),
        Change::StopMotion => Action::StopMotion,
        Change::Open(name) => Action::Wall(known(name), true),
        Change::Close(name) => Action::Wall(known(name), false),
        Change::Start(name) => Action::Moving(known(name), true),
        Change::Halt(name) => Action::Moving(known(name), false),
        // Of other methods: refused where no method of the scene uses them.
        _ => return None,
    })
}

pub(super) fn apply<D: Dim>(action: &Action<D>, mpm: &mut Mpm<D>) {
    let place = |mpm: &Mpm<D>, name: &str| mpm.walls().iter().position(|wall| wall.name == name);
    match action {
        Action::Gravity(gravity) => mpm.set_gravity(*gravity).expect("a scene has finite numbers"),
        Action::StopMotion => mpm.stop_motion(),
        Action::Wall(name, open) => {
            if let Some(wall) = place(mpm, name) {
                mpm.set_open(wall, *open);
            }
        }
        Action::Moving(name, runs) => {
            if let Some(wall) = place(mpm, name) {
                mpm.set_moving(wall, *runs);
            }
        }
    }
}
