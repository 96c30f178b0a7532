//! Figures that a run left.

use crate::arrays::Arrays;
use crate::folder::Run;
use serde_json::{Value, json};
use std::{fs, io};

/// Figures larger than this are taken as pixels, where both are there.
const LARGEST_DRAWING: u64 = 150_000;
/// Figures larger than this are left out.
const LARGEST: u64 = 8_000_000;

/// Writes the figures of a run, each once: as a drawing, or as pixels where the drawing is large or not there.
pub(crate) fn write(run: &Run, arrays: &mut Arrays<'_>, lacks: &mut Vec<String>) -> io::Result<Vec<Value>> {
    let mut figures = Vec::new();
    for (stem, name, kind) in chosen(run) {
        match fs::read(run.path.join(&name)) {
            Ok(bytes) if bytes.len() as u64 <= LARGEST => {
                let array = arrays.push(&bytes)?;
                figures.push(json!({ "name": stem, "file": name, "kind": kind, "array": array }));
            }
            Ok(bytes) => {
                let size = bytes.len() / 1_000_000;
                lacks.push(format!("The figure {name} is left out: it has {size} MB, more than 8 MB."));
            }
            Err(error) => lacks.push(format!("The figure {name} is left out: {error}.")),
        }
    }
    if figures.is_empty() {
        lacks.push("The run left no figures.".to_owned());
    }
    Ok(figures)
}

/// Name, file and kind of each figure.
fn chosen(run: &Run) -> Vec<(String, String, &'static str)> {
    let (svg, png) = ("image/svg+xml", "image/png");
    let mut chosen = Vec::new();
    for name in run.files_with(".svg") {
        let stem = name.trim_end_matches(".svg");
        let pixels = format!("{stem}.png");
        let size = fs::metadata(run.path.join(name)).map_or(0, |data| data.len());
        if size > LARGEST_DRAWING && run.files.contains(&pixels) {
            chosen.push((stem.to_owned(), pixels, png));
        } else {
            chosen.push((stem.to_owned(), name.to_owned(), svg));
        }
    }
    for name in run.files_with(".png") {
        let stem = name.trim_end_matches(".png");
        if !run.files.contains(&format!("{stem}.svg")) {
            chosen.push((stem.to_owned(), name.to_owned(), png));
        }
    }
    chosen.sort();
    chosen
}
