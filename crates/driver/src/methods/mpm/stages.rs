//! What happens to a continuum at the start of stages.

use crate::methods::push::{self, Given, PushAction, Pushable, Target};
use crate::problems::{Problems, nearest};
use crate::records::PushRecord;
use crate::scene::{Change, Scene};
use granular_core::units::Acceleration;
use granular_core::{Dim, Linear};
use granular_mpm::Mpm;

/// A change at the start of a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Action<D: Dim> {
    /// Gravity \[m/s^2\].
    Gravity(D::Vec),
    /// All velocities become zero.
    StopMotion,
    /// All particles get a velocity.
    Push(PushAction),
    /// A wall opens or closes.
    Wall(String, bool),
    /// A moving wall starts or halts.
    Moving(String, bool),
}

/// What each stage does at its start.
pub(super) fn actions<D: Dim>(
    (scene, name): (&Scene, &str),
    openings: &[(String, String, String)],
    walls: &[&str],
    (knows_grains, problems): (bool, &mut Problems),
) -> Vec<Vec<Action<D>>> {
    crate::walls::check_openings(scene, openings, problems);
    let mut stages = Vec::new();
    let weighty = |gravity: &[Acceleration]| gravity.iter().any(|value| value.value() != 0.0);
    let mut falls = weighty(&scene.gravity);
    for (k, stage) in scene.stages.iter().enumerate() {
        let opened = openings.iter().filter(|(.., at)| *at == stage.name);
        let mut list: Vec<Action<D>> = opened.map(|(_, wall, _)| Action::Wall(wall.clone(), true)).collect();
        for (c, change) in stage.changes.iter().enumerate() {
            let path = format!("stages.{k}.changes.{c}");
            if let Change::Gravity(values) = change {
                falls = weighty(values);
            }
            list.extend(match change {
                Change::Push { of: Some(of), .. } if of != name => None,
                Change::Push { .. } => {
                    let pushable = Pushable { falls, in_cell: false, knows_grains };
                    let push = push::action::<D>(&path, change, pushable, problems);
                    push.map(Action::Push)
                }
                change => action::<D>(&path, change, walls, problems),
            });
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

pub(super) fn apply<D: Dim>(
    action: &Action<D>,
    mpm: &mut Mpm<D>,
    diameter: f64,
    pushed: &mut Option<PushRecord>,
) {
    let place = |mpm: &Mpm<D>, name: &str| mpm.walls().iter().position(|wall| wall.name == name);
    match action {
        Action::Gravity(gravity) => mpm.set_gravity(*gravity).expect("a scene has finite numbers"),
        Action::StopMotion => mpm.stop_motion(),
        Action::Push(action) => {
            let push = action.push::<D>(target(mpm, diameter), false);
            let given = mpm.apply_push(&push, |_, _| true).expect("the values were checked at build");
            let along = given.momentum.dot(push.direction) / push.direction.length();
            let given = Given { energy: given.energy, momentum: along, speed: given.speed };
            *pushed = Some(PushRecord::of(target(mpm, diameter), given, *pushed));
        }
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

/// A continuum of grains of a mean diameter as pushes see it.
pub(super) fn target<D: Dim>(mpm: &Mpm<D>, diameter: f64) -> Target {
    Target {
        mass: mpm.mass(),
        gravity: mpm.gravity().length(),
        diameter,
        potential: mpm.energies().potential,
    }
}
