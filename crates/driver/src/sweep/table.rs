//! The table of a sweep: one row per run, with its values, its end, and what it measured.

use super::{Point, State};
use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::parts::{self, Part};
use crate::scene::{Output, Scene, Writer};
use granular_io::{csv_row, csv_rows, write_atomically};
use std::path::Path;

/// Names and values, in the order in which they become columns.
pub(super) type Measures = Vec<(String, String)>;

/// What a run that is done measured: the metrics of its `run.json`, then the last row of each table,
/// under `<table>:<column>`; all with their units in brackets.
pub(super) fn measures(out: &Path, point: &Point) -> Result<Measures, Failure> {
    let Ok(run) = RunFolder::open(&out.join(&point.folder)) else { return Ok(Vec::new()) };
    let facts = run.facts()?;
    if facts["exit"] != "done" {
        return Ok(Vec::new());
    }
    let metrics = facts["metrics"].as_object().into_iter().flatten();
    let with_unit = |name: &str| match facts["units"][name].as_str() {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.to_owned(),
    };
    // What could not be measured is an empty field.
    let text = |value: &serde_json::Value| if value.is_null() { String::new() } else { value.to_string() };
    let mut found: Measures = metrics.map(|(name, value)| (with_unit(name), text(value))).collect();
    for part in parts::of(&point.text)? {
        found.extend(last_rows(&run.path().join(&part.name), &part)?);
    }
    Ok(found)
}

/// The last row of each table of a run, the name of the part in front if there are several.
fn last_rows(folder: &Path, part: &Part) -> Result<Measures, Failure> {
    let mut found = Measures::new();
    let scene: Scene = part.text.parse()?;
    for Output { write, .. } in &scene.outputs {
        let Writer::Table { path, .. } = write else { continue };
        let file = folder.join(path);
        let text = std::fs::read_to_string(&file).map_err(|error| Failure::io(file.display(), error))?;
        // Tables are long: of all rows but the first and the last, no field is looked at.
        let (head, last) = text.split_once('\n').unwrap_or((text.as_str(), ""));
        let last = last.lines().next_back().unwrap_or_default();
        let (Some(head), Some(last)) = (csv_rows(head).next(), csv_rows(last).next()) else { continue };
        let name = path.strip_suffix(".csv").unwrap_or(path);
        let name = if part.name.is_empty() { name.to_owned() } else { format!("{}.{name}", part.name) };
        let columns = head.fields().map(|column| format!("{name}:{column}"));
        found.extend(columns.zip(last.fields().map(str::to_owned)));
    }
    Ok(found)
}

/// The whole table. What a run did not measure is an empty field.
pub(super) fn text(axes: &[&str], runs: &[(&Point, State, Measures)]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in runs.iter().flat_map(|(.., measures)| measures) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let head = ["run"].into_iter().chain(axes.iter().copied()).chain(["exit"]);
    let mut text = csv_row(head.chain(names.iter().copied()));
    for (point, state, measures) in runs {
        let value = |name: &&str| {
            let found = measures.iter().find(|(known, _)| known == name);
            found.map_or("", |(_, value)| value.as_str())
        };
        let fields = [point.folder.as_str()].into_iter().chain(point.labels.iter().map(String::as_str));
        text += &csv_row(fields.chain([state.name()]).chain(names.iter().map(value)));
    }
    text
}

pub(super) fn write(path: &Path, text: &str) -> Result<(), Failure> {
    write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}
