//! The scenes of `examples/`, run shortened, and the reference of all that a scene may say.

use crate::support::{Scratch, workspace};
use granular_driver::parts;
use granular_driver::scene::{Scene, Writer};
use granular_driver::scene_file::{SceneText, reference};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Scenes with what makes them short. An example without a line here fails the test.
const SHORTENED: &str = include_str!("../../../../examples/shortened.txt");

/// Changes by the name of an example.
fn shortened() -> BTreeMap<&'static str, Vec<&'static str>> {
    let mut found: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let mut name = "";
    for line in SHORTENED.lines().filter(|line| !line.trim_start().starts_with('#')) {
        match line.strip_prefix("    ") {
            Some(change) => found.get_mut(name).expect("changes follow a name").push(change),
            None => {
                name = line;
                found.insert(name, Vec::new());
            }
        }
    }
    found
}

#[test]
fn every_example_runs_and_leaves_what_its_scene_asks_for() {
    let scratch = Scratch::new("examples");
    let folders = fs::read_dir(workspace().join("examples")).unwrap().map(|entry| entry.unwrap().path());
    let (shortened, mut seen) = (shortened(), BTreeSet::new());
    for folder in folders.filter(|path| path.is_dir()) {
        let name = folder.file_name().unwrap().to_str().unwrap();
        let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
        let mut scenes: Vec<_> =
            files.filter(|path| path.extension().is_some_and(|end| end == "ron")).collect();
        assert!(!scenes.is_empty(), "examples/{name} has no scene");
        // Others may start from what `scene.ron` leaves.
        scenes.sort_by_key(|scene| scene.file_stem().unwrap() != "scene");
        for scene in scenes {
            let scene_name = format!("{name}/{}", scene.file_stem().unwrap().to_str().unwrap());
            let short =
                shortened.get_key_value(scene_name.as_str()).or_else(|| shortened.get_key_value(name));
            let (key, edits) =
                short.unwrap_or_else(|| panic!("examples/shortened.txt has no line for {name}"));
            seen.insert(*key);
            let here = scratch.path("");
            let edits = edits.iter().map(|edit| edit.replace("HERE", here.to_str().unwrap()));
            let edits: Vec<String> = edits.flat_map(|edit| ["--set".to_owned(), edit]).collect();
            let out = scene_name.replace('/', "_");
            let mut arguments = vec!["run", scene.to_str().unwrap(), "--out", &out, "--quiet"];
            arguments.extend(edits.iter().map(String::as_str));
            scratch.granular(&arguments).expect(0);
            let text = SceneText::read(scratch.path(&out).join("scene.ron")).unwrap();
            // Solvers that nothing joins run in folders of their own.
            for part in parts::of(&text).unwrap() {
                assert_outputs(&scratch.path(&out).join(part.name));
            }
        }
    }
    assert_eq!(seen.len(), shortened.len(), "examples/shortened.txt has a name without an example");
}

/// Tables parse, collections list files that are there, figures are images.
fn assert_outputs(run: &Path) {
    let scene: Scene = SceneText::read(run.join("scene.ron")).unwrap().parse().unwrap();
    for output in &scene.outputs {
        let path = run.join(output.write.path());
        if path.extension().is_some_and(|ending| ending == "csv") {
            let table = granular_io::read_table(&path).unwrap();
            assert!(table.rows.len() > 5, "{} has {} rows", path.display(), table.rows.len());
            let names: Vec<&str> = table.columns.iter().map(|(name, _)| name.as_str()).collect();
            assert_eq!(names[0], "time");
            if let Writer::Profile { fields, .. } | Writer::Tracks { fields, .. } = &output.write {
                let is_there = |field: &String| names.iter().any(|name| name.starts_with(field.as_str()));
                assert!(fields.iter().all(is_there), "{names:?}");
                continue;
            }
            assert_eq!(names[1..], output.write.names().iter().map(String::as_str).collect::<Vec<_>>());
            assert!(table.columns.iter().all(|(_, unit)| !unit.is_empty()), "a column has no unit");
            // As long as grains fall there is no bulk that these could be of.
            let of_bulk = |column: usize| ["solid_fraction", "homogeneity"].contains(&names[column]);
            let known =
                |(column, value): (usize, &f64)| value.is_finite() || (of_bulk(column) && value.is_nan());
            assert!(table.rows.iter().all(|row| row.iter().enumerate().all(known)), "{}", path.display());
            assert!(table.rows.windows(2).all(|pair| pair[0][0] < pair[1][0]), "time goes on");
        } else {
            let list = granular_io::Collection::open(&path.with_extension("pvd")).unwrap();
            assert!(!list.is_empty());
            for (time, file) in list.entries() {
                let file = path.with_file_name(file);
                let (found, fields) = if file.extension().is_some_and(|ending| ending == "vti") {
                    let grid = granular_io::vtk::read_vti(&file).unwrap();
                    (grid.time, grid.fields)
                } else {
                    let points = granular_io::vtk::read_vtp(&file).unwrap();
                    (points.time, points.fields)
                };
                assert_eq!(found, *time);
                for name in output.write.names() {
                    let is_there = fields.iter().any(|(known, ..)| known == name);
                    assert!(is_there, "{} has no `{name}`", file.display());
                }
            }
        }
    }
    for figure in &scene.figures {
        let read = |ending: &str| fs::read(run.join(format!("{}.{ending}", figure.path()))).unwrap();
        let (svg, png) = (read("svg"), read("png"));
        assert!(svg.starts_with(b"<svg") || svg.starts_with(b"<?xml"), "{}", figure.path());
        assert!(svg.len() > 2000 && png.len() > 2000, "{} is empty", figure.path());
        assert!(png.starts_with(b"\x89PNG"), "{}", figure.path());
    }
}

/// What stands before the generated part.
const PREFACE: &str = "\
All keys of a scene file, which is written in [RON](https://github.com/ron-rs/ron). A value with a unit is a number in SI units or
a text such as `\"1.15 mm\"` with [its unit](units.md); a wrong unit is an error. `granular new` prints scenes to start from,
`granular check` finds the mistakes in a scene, and `--set path=value` changes a value on the command line. \"The thesis\" is Kumar2014 in
the [references](references.md).

This page is generated from the comments in `crates/driver/src/scene.rs`, the files in `crates/driver/src/scene/`, and `spec.rs` of the
solver crates: change those and run `GRANULAR_UPDATE=1 cargo test -p granular scene_reference`.";

#[test]
fn the_scene_reference_is_up_to_date() {
    let schema = schemars::schema_for!(Scene);
    let page = reference::markdown(&schema, "Scene reference");
    let head = "# Scene reference\n";
    let body = page.strip_prefix(head).expect("the title comes first");
    let page = format!("{head}\n{PREFACE}\n{body}");
    let path = workspace().join("docs/scene-reference.md");
    if std::env::var_os("GRANULAR_UPDATE").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == page,
        "{} is out of date; run GRANULAR_UPDATE=1 cargo test -p granular scene_reference",
        path.display()
    );
}
