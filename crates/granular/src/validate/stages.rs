//! Scenes run in memory, stage by stage, without a run folder.

use crate::check;
use crate::failure::Failure;
use crate::model::{self, Model};
use crate::observers::{Packed, Rest};
use crate::scene::{End, Scene};
use crate::scene_file::SceneText;
use granular_core::Scheduled;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A template with changes, without outputs and figures.
pub(crate) fn template(name: &str, edits: &[String]) -> Result<SceneText, Failure> {
    let found = crate::TEMPLATES.iter().find(|(known, _)| *known == name);
    let (name, text) = found.expect("the case names a template that there is");
    let mut text = SceneText::new(*name, *text);
    ["figures=[]", "outputs=[]"].iter().try_for_each(|edit| text.set(edit))?;
    edits.iter().try_for_each(|edit| text.set(edit))?;
    Ok(text)
}

/// Runs all stages of a scene. Returns the model at its end, and whether each stage came to the end it waited for.
///
/// # Errors
/// When the scene is wrong or refused, or the solver gives up.
pub(crate) fn run(text: &SceneText) -> Result<(Model, Vec<bool>), Failure> {
    let (scene, mut model) = check::read(text)?;
    let (_, steps, problems) = check::limits_of(&scene, &model);
    if !problems.is_empty() {
        return Err(Failure::Refused(problems));
    }
    let mut reached = Vec::new();
    for (index, dt) in steps.into_iter().enumerate() {
        for action in &model.stages[index] {
            model::apply(action, model.simulation.solver_mut());
        }
        reached.push(stage(&scene, &mut model, index, dt, Vec::new())?);
    }
    Ok((model, reached))
}

/// Runs a stage whose changes were made. Returns whether it came to the end it waited for.
///
/// # Errors
/// When the solver gives up.
pub(super) fn stage(
    scene: &Scene,
    model: &mut Model,
    index: usize,
    dt: f64,
    more: Vec<Scheduled>,
) -> Result<bool, Failure> {
    let end = scene.stages[index].end;
    let reached = Arc::new(AtomicBool::new(false));
    let mut observers: Vec<Scheduled> = match end {
        End::Quiet { kinetic_over_potential, within } => {
            vec![Rest::scheduled(kinetic_over_potential, within.value(), reached.clone())]
        }
        End::Packed { solid_fraction, within } => {
            vec![Packed::scheduled(solid_fraction, within.value(), reached.clone())]
        }
        End::For(_) | End::Steady { .. } => vec![],
    };
    let waits = !observers.is_empty();
    observers.extend(more);
    model.simulation.begin_segment(dt)?;
    model.simulation.run(end.longest(), &mut observers, &AtomicBool::new(false))?;
    Ok(!waits || reached.load(Ordering::Relaxed))
}
