//! Run folders: which there are, and the files in them.

use crate::error::ReportError;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const RUN_FILE: &str = "run.json";
const SCENE_FILE: &str = "scene.ron";
/// What `granular check --json` printed, if somebody kept it.
const CHECK_FILE: &str = "check.json";
/// What a run reads or goes on from, which is no result.
const INPUTS: [&str; 4] = ["snapshots", "meshes", "continua", "initial-sample.csv"];
/// Folders within one another that are looked into.
const DEEPEST: usize = 4;

/// A run folder, with what is small of it.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// What tells it from the other runs of the page.
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    /// `run.json`.
    pub(crate) facts: Value,
    /// The scene as it was run.
    pub(crate) scene: Option<String>,
    /// Limits and bounds with which the run began.
    pub(crate) limits: Option<Value>,
    /// Names of its files, sorted, with `/` between folders.
    pub(crate) files: Vec<String>,
    /// What the folder lacks, as sentences.
    pub(crate) lacks: Vec<String>,
}

impl Run {
    /// Names of the files that end so.
    pub(crate) fn files_with(&self, ending: &str) -> impl Iterator<Item = &str> {
        self.files.iter().map(String::as_str).filter(move |name| name.ends_with(ending))
    }
}

/// Opens run folders, or the runs within folders that hold several.
pub(crate) fn open_all(folders: &[PathBuf]) -> Result<Vec<Run>, ReportError> {
    if folders.is_empty() {
        let fix = "name one, such as runs/column";
        return Err(ReportError::new(Path::new(""), "no folder was given", "one run folder or more", fix));
    }
    let mut paths = Vec::new();
    for folder in folders {
        for path in runs_in(folder)? {
            if !paths.contains(&path) {
                paths.push(path);
            }
        }
    }
    let names = names(&paths);
    paths.iter().zip(names).map(|(path, name)| open(path, name)).collect()
}

/// Runs that a folder stands for: those within it, or itself.
fn runs_in(folder: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let (allowed, fix) = (
        "a folder that `granular run` made, or one with such folders in it",
        "check the name, or make it with `granular run`",
    );
    if !folder.is_dir() {
        let reason = if folder.exists() { "is a file" } else { "there is no such folder" };
        return Err(ReportError::new(folder, reason, allowed, fix));
    }
    let found = found_in(folder, DEEPEST);
    if found.is_empty() {
        let reason = format!("holds no run: neither it nor a folder in it has a {RUN_FILE}");
        return Err(ReportError::new(folder, reason, allowed, fix));
    }
    Ok(found)
}

fn found_in(folder: &Path, depth: usize) -> Vec<PathBuf> {
    if depth == 0 {
        return Vec::new();
    }
    let is_run = folder.join(RUN_FILE).is_file();
    let mut within: Vec<PathBuf> =
        entries(folder).filter(|path| path.is_dir() && !path.is_symlink()).collect();
    // What lies in a run is another run only if it says so itself.
    within.retain(|path| !is_run || path.join(RUN_FILE).is_file());
    within.sort();
    let found: Vec<PathBuf> = within.iter().flat_map(|path| found_in(path, depth - 1)).collect();
    if found.is_empty() && is_run { vec![folder.to_path_buf()] } else { found }
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
}

/// The shortest ends of paths that tell them apart.
fn names(paths: &[PathBuf]) -> Vec<String> {
    let parts = |path: &PathBuf| -> Vec<String> {
        let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
        whole.iter().map(|part| part.to_string_lossy().into_owned()).collect()
    };
    let parts: Vec<Vec<String>> = paths.iter().map(parts).collect();
    let end = |parts: &[String], count: usize| parts[parts.len().saturating_sub(count)..].join("/");
    let name = |k: usize| {
        let is_alone = |count: &usize| {
            let mut others = parts.iter().enumerate().filter(|(other, _)| *other != k);
            others.all(|(_, other)| end(other, *count) != end(&parts[k], *count))
        };
        let count = (1..parts[k].len()).find(is_alone).unwrap_or(parts[k].len());
        end(&parts[k], count)
    };
    (0..parts.len()).map(name).collect()
}

fn open(path: &Path, name: String) -> Result<Run, ReportError> {
    let facts = facts(&path.join(RUN_FILE))?;
    let mut lacks = Vec::new();
    let scene = fs::read_to_string(path.join(SCENE_FILE)).ok();
    if scene.is_none() {
        lacks.push(format!("The folder holds no readable {SCENE_FILE}, so the scene is not shown."));
    }
    let limits = limits(&facts, path);
    if limits.is_none() {
        lacks.push(
            "The folder does not hold the limits of the step. `granular check scene.ron --json > check.json`, called in \
             the folder, adds them."
                .to_owned(),
        );
    }
    let mut files = Vec::new();
    list(path, "", DEEPEST, &mut files);
    files.sort();
    Ok(Run { name, path: path.to_path_buf(), facts, scene, limits, files, lacks })
}

fn facts(path: &Path) -> Result<Value, ReportError> {
    let fix = "mend the file, or run the scene again";
    let wrong = |reason: String| ReportError::new(path, reason, "JSON as `granular run` writes it", fix);
    let text = fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    let facts: Value = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    match facts["exit"].is_string() {
        true => Ok(facts),
        false => Err(wrong("line 1: it has no `exit`, which says how the run ended".to_owned())),
    }
}

/// Limits from `run.json`, or from what a check printed.
fn limits(facts: &Value, path: &Path) -> Option<Value> {
    let is_list = |value: &Value| value.as_array().is_some_and(|list| !list.is_empty());
    let of_check = || {
        let text = fs::read_to_string(path.join(CHECK_FILE)).ok()?;
        serde_json::from_str::<Value>(&text).ok().map(|check| check["limits"].clone())
    };
    Some(facts["limits"].clone()).filter(is_list).or_else(of_check).filter(is_list)
}

/// Lists the files below a folder, but not those of runs within it.
fn list(root: &Path, below: &str, depth: usize, files: &mut Vec<String>) {
    for entry in fs::read_dir(root.join(below)).into_iter().flatten().flatten() {
        let Ok(name) = entry.file_name().into_string() else { continue };
        let Ok(kind) = entry.file_type() else { continue };
        let path = if below.is_empty() { name.clone() } else { format!("{below}/{name}") };
        if INPUTS.contains(&path.as_str()) {
            continue;
        }
        if kind.is_file() {
            files.push(path);
        } else if kind.is_dir() && depth > 0 && !entry.path().join(RUN_FILE).is_file() {
            list(root, &path, depth - 1, files);
        }
    }
}
