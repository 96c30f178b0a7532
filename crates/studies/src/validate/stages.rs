//! Scenes run in memory, stage by stage, without a run folder.

use granular_core::Scheduled;
use granular_driver::check;
use granular_driver::failure::Failure;
use granular_driver::model::Model;
use granular_driver::observers;
use granular_driver::records::PushRecord;
use granular_driver::scene::{End, Scene};
use granular_driver::scene_file::SceneText;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A template with changes, without outputs and figures.
pub(crate) fn template(name: &str, edits: &[String]) -> Result<SceneText, Failure> {
    let found = granular_driver::TEMPLATES.iter().find(|(known, _)| *known == name);
    let (name, text) = found.expect("the case names a template that there is");
    let mut text = SceneText::new(*name, *text);
    ["figures=[]", "outputs=[]"].iter().try_for_each(|edit| text.set(edit))?;
    edits.iter().try_for_each(|edit| text.set(edit))?;
    Ok(text)
}

/// The change of a scene whose only output asks for these numbers: it is never written, but the ledger of energy is
/// kept only for who asks.
pub(crate) fn asking_for(names: &[&str]) -> String {
    let probes: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let table = format!("Table(path: \"series.csv\", probes: [{}])", probes.join(", "));
    format!("outputs=[(every: Time(\"1 s\"), write: {table})]")
}

/// A scene, its model, and the step of each of its stages \[s\].
///
/// # Errors
/// When the scene is wrong or refused.
pub(crate) fn open(text: &SceneText) -> Result<(Scene, Model, Vec<f64>), Failure> {
    let (scene, model) = check::read(text)?;
    let (_, steps, problems) = check::limits_of(&scene, &model);
    if !problems.is_empty() {
        return Err(Failure::Refused(problems));
    }
    Ok((scene, model, steps))
}

/// Makes the changes at the start of a stage; returns what its pushes did, if there are any.
pub(crate) fn begin(model: &mut Model, index: usize) -> Option<PushRecord> {
    model.begin(index).into_iter().find_map(|(_, notes)| notes.push)
}

/// Runs all stages of a scene. Returns the model at its end, and whether each stage came to the end it waited for.
///
/// # Errors
/// When the scene is wrong or refused, or the solver gives up.
pub(crate) fn run(text: &SceneText) -> Result<(Model, Vec<bool>), Failure> {
    let (scene, mut model, steps) = open(text)?;
    let mut reached = Vec::new();
    for (index, dt) in steps.into_iter().enumerate() {
        begin(&mut model, index);
        reached.push(stage(&scene, &mut model, index, dt, Vec::new())?);
    }
    Ok((model, reached))
}

/// Runs a stage whose changes were made. Returns whether it came to the end it waited for.
///
/// # Errors
/// When the solver gives up.
pub(crate) fn stage(
    scene: &Scene,
    model: &mut Model,
    index: usize,
    dt: f64,
    more: Vec<Scheduled>,
) -> Result<bool, Failure> {
    let end = scene.stages[index].end;
    let reached = Arc::new(AtomicBool::new(false));
    let waits = !matches!(end, End::Steady { .. });
    let of_end = waits.then(|| observers::of_end(&scene.stages[index], model, &reached)).flatten();
    let mut observers: Vec<Scheduled> = of_end.into_iter().collect();
    let waits = !observers.is_empty();
    observers.extend(more);
    model.simulation.begin_segment(dt)?;
    model.simulation.run(end.longest(), &mut observers, &AtomicBool::new(false))?;
    Ok(!waits || reached.load(Ordering::Relaxed))
}
