//! Runs of a scene whose solvers nothing joins: one after the other, each in a folder of its own within one folder.

use super::{Interrupt, resume_one, run_one};
use crate::failure::Failure;
use crate::figures::Drawn;
use crate::folder::{PROGRAM, RESERVED, RunFolder, provenance};
use crate::parts::Part;
use crate::scene::Scene;
use crate::scene_file::{SceneProblem, SceneText};
use granular_io::hash_hex;
use serde_json::{Map, Value, json};
use std::path::Path;
use std::time::Instant;

/// Runs the parts of a scene in a new folder.
///
/// # Errors
/// As those of a run.
pub(super) fn run(
    text: &SceneText,
    (out, force): (&Path, bool),
    quiet: bool,
    interrupt: &Interrupt,
) -> Result<Value, Failure> {
    let mut text = text.clone();
    // All parts are tried before the first one runs.
    for part in crate::parts::of(&text)? {
        refuse_name(&part)?;
        crate::check::read_to_run(&part.text)?;
    }
    let files = Scene::of(&text)?.take_files(&mut text)?;
    let folder = RunFolder::create(out, text.text(), &files, force)?;
    go_on(&folder, quiet, interrupt)
}

/// Refuses names of solvers that no folder can have.
fn refuse_name(part: &Part) -> Result<(), Failure> {
    let is_plain = part.name.chars().all(|c| c.is_alphanumeric() || " +-_".contains(c));
    if is_plain && !part.name.trim().is_empty() && !RESERVED.contains(&part.name.as_str()) {
        return Ok(());
    }
    let allowed = format!("letters, digits, blanks, - and _, and none of {}", RESERVED.join(", "));
    let hint = "each solver runs in a folder that has its name";
    Err(SceneProblem::at_path("solvers", format!("`{}`", part.name), allowed, hint).into())
}

/// Takes the parts up again: those that are done stay, one that was interrupted goes on, others begin.
///
/// # Errors
/// As those of a run.
pub(super) fn go_on(folder: &RunFolder, quiet: bool, interrupt: &Interrupt) -> Result<Value, Failure> {
    let begun = Instant::now();
    let parts = crate::parts::of(&SceneText::read(folder.scene_path())?)?;
    write(folder, &parts, ("running", None), begun)?;
    let result = parts.iter().try_for_each(|part| one(part, folder, quiet, interrupt));
    match result {
        Ok(()) => write(folder, &parts, ("done", None), begun),
        Err(failure) => {
            let failure = match failure {
                Failure::Interrupted { signal, .. } => {
                    let hint = format!("go on with `granular resume {}`", folder.path().display());
                    Failure::Interrupted { signal, hint }
                }
                other => other,
            };
            let exit = if let Failure::Interrupted { .. } = failure { "interrupted" } else { "failed" };
            // The failure itself matters more than a folder that cannot be written.
            let _ = write(folder, &parts, (exit, Some(&failure)), begun);
            Err(failure)
        }
    }
}

/// Runs one part, as far as it is not done.
fn one(part: &Part, folder: &RunFolder, quiet: bool, interrupt: &Interrupt) -> Result<(), Failure> {
    let out = folder.path().join(&part.name);
    match RunFolder::open(&out).and_then(|folder| folder.facts()) {
        Ok(facts) if facts["exit"] == "done" => return Ok(()),
        Ok(_) => resume_one(&out, quiet, interrupt)?,
        // Nothing was begun there, or nothing that can be gone on with.
        Err(_) => run_one(&part.text, (&out, true), quiet, interrupt)?,
    };
    Ok(())
}

/// Draws the figures of all parts again.
///
/// # Errors
/// When a part is not there, or a figure cannot be written.
pub(super) fn plot(folder: &RunFolder, parts: &[Part]) -> Result<Drawn, Failure> {
    let mut all = Drawn::default();
    for part in parts {
        let drawn = super::plot(&folder.path().join(&part.name))?;
        all.paths.extend(drawn.paths);
        all.failed.extend(drawn.failed);
        all.left_out.extend(drawn.left_out);
    }
    Ok(all)
}

/// Writes `run.json` of the whole: what its parts measured, with their names in front.
fn write(
    folder: &RunFolder,
    parts: &[Part],
    (exit, failure): (&str, Option<&Failure>),
    begun: Instant,
) -> Result<Value, Failure> {
    let facts_of = |part: &Part| -> Value {
        let open = RunFolder::open(&folder.path().join(&part.name));
        open.and_then(|folder| folder.facts()).unwrap_or(Value::Null)
    };
    let (mut metrics, mut units, mut runs, mut hashes) = (Map::new(), Map::new(), Map::new(), String::new());
    for part in parts {
        let facts = facts_of(part);
        for (from, to) in [("metrics", &mut metrics), ("units", &mut units)] {
            for (name, value) in facts[from].as_object().into_iter().flatten() {
                to.insert(format!("{}.{name}", part.name), value.clone());
            }
        }
        hashes += facts["state_hash"].as_str().unwrap_or("none");
        let keys = ["exit", "solver", "simulated_seconds", "steps", "wall_seconds", "state_hash"];
        let kept = keys.iter().map(|&key| (key.to_owned(), facts[key].clone()));
        runs.insert(part.name.clone(), Value::Object(kept.collect()));
    }
    let sum = |key: &str| runs.values().filter_map(|run| run[key].as_f64()).sum::<f64>();
    let facts = json!({
        "program": PROGRAM,
        "scene": folder.scene_path().display().to_string(),
        "solver": "several",
        "exit": exit,
        "code": failure.map(Failure::code),
        "reason": failure.map(Failure::to_string),
        "simulated_seconds": sum("simulated_seconds"),
        "steps": sum("steps") as u64,
        "wall_seconds": begun.elapsed().as_secs_f64(),
        "runs": runs,
        "state_hash": hash_hex(xxhash_rust::xxh3::xxh3_128(hashes.as_bytes())),
        "metrics": metrics,
        "units": units,
        "built": provenance(),
        "checksums": if exit == "done" { folder.checksums()? } else { Value::Null },
    });
    folder.set_facts(&facts)?;
    Ok(facts)
}
