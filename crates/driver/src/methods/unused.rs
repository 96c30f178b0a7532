//! What is said of parts of a scene that none of its methods uses.

use super::parts::Part;
use crate::problems::Problems;
use crate::scene::{Change, End, Scene};

/// Refuses what no method of the scene uses.
pub(crate) fn refuse_unused(scene: &Scene, problems: &mut Problems) {
    let uses = |part: Part| scene.solvers.values().any(|solver| solver.parts().contains(&part));
    let named: Vec<String> =
        scene.solvers.iter().map(|(name, solver)| format!("`{name}` is {}", solver.name())).collect();
    let named = named.join(", ");
    for Given { path, part, value } in given(scene).into_iter().filter(|given| !uses(given.part)) {
        let would = super::all().into_iter().filter(|(_, parts)| parts.contains(&part)).map(|(name, _)| name);
        let would: Vec<&str> = would.collect();
        let verb = if scene.solvers.len() == 1 { "which does not use" } else { "none of which uses" };
        let hint = match (part, scene.solvers.iter().next()) {
            (Part::StageStep, Some((name, solver))) => format!("set solvers.{name}.{}", solver.step_key()),
            _ if would.is_empty() => format!("{named}, {verb} it"),
            _ => format!("{named}, {verb} it; {} does", would.join(" or ")),
        };
        problems.add(path, value, instead(part, &uses), hint);
    }
}

/// What may stand in the place of a part, when its methods use some parts.
fn instead(part: Part, uses: &dyn Fn(Part) -> bool) -> &'static str {
    match part {
        Part::Quiet | Part::Packed => "For or Steady",
        Part::GrainChanges if uses(Part::FluidChanges) => "FaceVelocity, ObstacleSpin or Gravity",
        Part::FluidChanges if uses(Part::GrainChanges) => "a change of grains, walls or the cell",
        Part::BodyChanges | Part::Pushes if uses(Part::FluidChanges) => {
            "FaceVelocity, ObstacleSpin or Gravity"
        }
        Part::GrainChanges if uses(Part::BodyChanges) => {
            "Gravity, StopMotion, Push, Open, Close, Start or Halt"
        }
        Part::BodyChanges | Part::Pushes | Part::GrainChanges | Part::FluidChanges => "no change",
        _ => "nothing here",
    }
}

/// A part that a scene gives.
pub(crate) struct Given {
    /// Path of the scene.
    pub(crate) path: String,
    pub(crate) part: Part,
    value: String,
}

/// All parts that a scene gives of which not every method has a use.
pub(crate) fn given(scene: &Scene) -> Vec<Given> {
    let keys = [
        ("sample", Part::Sample, scene.sample.is_some()),
        ("materials", Part::Materials, !scene.materials.is_empty()),
        ("continua", Part::Continua, !scene.continua.is_empty()),
        ("pairs", Part::Pairs, !scene.pairs.is_empty()),
        ("walls", Part::Walls, !scene.walls.is_empty()),
        ("inlets", Part::Inlets, !scene.inlets.is_empty()),
        ("outlets", Part::Outlets, !scene.outlets.is_empty()),
        ("cell", Part::Cell, scene.cell.is_some()),
        ("fluid", Part::Fluid, scene.fluid.is_some()),
    ];
    let add = |path: String, part, value: &str| Given { path, part, value: value.to_owned() };
    let keys = keys.into_iter().filter(|(.., is_given)| *is_given);
    let mut list: Vec<Given> = keys.map(|(key, part, _)| add(key.to_owned(), part, "given")).collect();
    for (k, stage) in scene.stages.iter().enumerate() {
        match stage.end {
            End::Quiet { .. } => list.push(add(format!("stages.{k}.end"), Part::Quiet, "Quiet")),
            End::Packed { .. } => list.push(add(format!("stages.{k}.end"), Part::Packed, "Packed")),
            End::For(_) | End::Steady { .. } => {}
        }
        if stage.time_step.is_some() {
            list.push(add(format!("stages.{k}.time_step"), Part::StageStep, "given"));
        }
        if stage.save.is_some() {
            list.push(add(format!("stages.{k}.save"), Part::Saving, "given"));
        }
        for (c, change) in stage.changes.iter().enumerate() {
            let (part, value) = match change {
                Change::Gravity(_) => continue,
                Change::Friction { .. } => (Part::GrainChanges, "Friction"),
                Change::StopMotion => (Part::BodyChanges, "StopMotion"),
                Change::Push { .. } => (Part::Pushes, "Push"),
                Change::Shake { .. } => (Part::GrainChanges, "Shake"),
                Change::Open(_) => (Part::BodyChanges, "Open"),
                Change::Close(_) => (Part::BodyChanges, "Close"),
                Change::Start(_) => (Part::BodyChanges, "Start"),
                Change::Halt(_) => (Part::BodyChanges, "Halt"),
                Change::Cell(_) => (Part::GrainChanges, "Cell"),
                Change::FaceVelocity { .. } => (Part::FluidChanges, "FaceVelocity"),
                Change::ObstacleSpin { .. } => (Part::FluidChanges, "ObstacleSpin"),
            };
            list.push(add(format!("stages.{k}.changes.{c}"), part, value));
        }
    }
    list
}
