//! What happens to grains at the start of stages.

use super::cell;
use super::materials::NamedMaterials;
use crate::methods::push::{self, Given, PushAction, Pushable, Target};
use crate::problems::Problems;
use crate::records::PushRecord;
use crate::scene::{Change, Scene, Stage};
use granular_core::units::Acceleration;
use granular_core::{Dim, Linear};
use granular_dem::{CellControl, Dem, MaterialId, Shaking};

/// A change of the grains or walls at the start of a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Action<D: Dim> {
    /// Friction of a material.
    Friction(MaterialId, f64),
    /// Gravity \[m/s^2\].
    Gravity(D::Vec),
    /// All velocities become zero.
    StopMotion,
    /// All grains get a velocity.
    Push(PushAction),
    /// A shaking begins, or ends.
    Shake(Option<Shaking<D>>),
    /// A wall opens or closes.
    Wall(String, bool),
    /// A moving wall or an inlet starts or halts.
    Moving(String, bool),
    /// What drives the periodic cell.
    Cell(CellControl),
}

/// What each stage does at its start.
pub(super) fn actions<D: Dim>(
    (scene, name): (&Scene, &str),
    openings: &[(String, String, String)],
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Vec<Vec<Action<D>>> {
    crate::walls::check_openings(scene, openings, problems);
    let mut stages = Vec::new();
    let weighty = |gravity: &[Acceleration]| gravity.iter().any(|value| value.value() != 0.0);
    let mut falls = weighty(&scene.gravity);
    for (k, stage) in scene.stages.iter().enumerate() {
        let opened = openings.iter().filter(|(.., at)| *at == stage.name);
        let mut list: Vec<Action<D>> = opened.map(|(_, wall, _)| Action::Wall(wall.clone(), true)).collect();
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
                Change::Push { of: Some(of), .. } if of != name => None,
                Change::Push { .. } => {
                    let pushable = Pushable { falls, in_cell: scene.cell.is_some(), knows_grains: true };
                    let push = push::action::<D>(&path, change, pushable, problems);
                    push.map(Action::Push)
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
                    let control = cell::control::<D>(&path, change, scene.cell.as_ref(), problems);
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
) -> Option<Action<D>> {
    Some(match change {
        Change::Friction { material, value } => {
            if !(*value >= 0.0 && value.is_finite()) {
                problems.add(format!("{path}.value"), value, "zero or more", "");
            }
            Action::Friction(materials.find(&format!("{path}.material"), material, problems)?, *value)
        }
        Change::Gravity(values) => Action::Gravity(problems.vector::<D, _>(path, values)?),
        Change::StopMotion => Action::StopMotion,
        Change::Shake { acceleration, from, to, pass } => {
            let frequency = [from.value(), to.value()];
            for (key, value) in [("from", frequency[0]), ("to", frequency[1]), ("pass", pass.value())] {
                if value <= 0.0 {
                    problems.add(format!("{path}.{key}"), value, "above 0", "");
                }
            }
            let acceleration = problems.vector::<D, _>(&format!("{path}.acceleration"), acceleration)?;
            let [from, to] = frequency;
            Action::Shake(Some(Shaking { acceleration, from, to, pass: pass.value() }))
        }
        Change::Open(name) => Action::Wall(name.clone(), true),
        Change::Close(name) => Action::Wall(name.clone(), false),
        Change::Start(name) => Action::Moving(name.clone(), true),
        Change::Halt(name) => Action::Moving(name.clone(), false),
        // Told apart before, or of another method.
        Change::Push { .. } | Change::Cell(_) | Change::FaceVelocity { .. } | Change::ObstacleSpin { .. } => {
            return None;
        }
    })
}

pub(super) fn apply<D: Dim>(action: &Action<D>, dem: &mut Dem<D>, pushed: &mut Option<PushRecord>) {
    match action {
        Action::Push(action) => {
            let before = target(dem);
            let given = dem.apply_push(&action.push(before, true)).expect("the values were checked at build");
            let given = Given { energy: given.energy, momentum: given.momentum, speed: given.speed };
            *pushed = Some(PushRecord::of(target(dem), given, *pushed));
        }
        Action::Friction(material, value) => dem.set_friction(*material, *value),
        Action::Gravity(gravity) => dem.set_gravity(*gravity),
        Action::StopMotion => dem.stop_motion(),
        Action::Shake(shaking) => dem.set_shaking(*shaking).expect("the values were checked at build"),
        Action::Wall(name, open) => _ = dem.set_open(name, *open),
        Action::Moving(name, runs) => {
            dem.set_moving(name, *runs);
            dem.set_inlet(name, *runs);
        }
        Action::Cell(control) => dem.control_cell(*control).expect("the control was checked at build"),
    }
}

/// The grains as pushes see them.
pub(super) fn target<D: Dim>(dem: &Dem<D>) -> Target {
    Target {
        mass: dem.mass(),
        gravity: dem.gravity().length(),
        diameter: dem.mean_diameter(),
        potential: dem.energies().potential,
    }
}
