//! Which folders make a page, and what is told of others.

use crate::support::{Page, Scratch};
use granular_report::{ReportError, Request};
use serde_json::json;
use std::fs;
use std::path::Path;

fn refused(folder: &Path, out: &Path) -> ReportError {
    granular_report::write(&Request::new([folder], out)).unwrap_err()
}

#[test]
fn what_is_no_run_folder_is_refused_with_what_is_and_what_helps() {
    let scratch = Scratch::new("refused");
    let out = scratch.path("page.html");
    let none = scratch.path("none");
    assert!(refused(&none, &out).reason.contains("no such folder"));
    fs::create_dir(&none).unwrap();
    let error = refused(&none, &out);
    assert!(error.reason.contains("no run.json") || error.reason.contains("has a run.json"), "{error}");
    assert!(error.to_string().contains("allowed: a folder that `granular run` made"), "{error}");
    fs::write(none.join("run.json"), "{\"exit\": \"done\",\n  oops}").unwrap();
    let error = refused(&none, &out);
    assert!(error.reason.contains("line 2 column 3") && error.path.ends_with("run.json"), "{error}");
    fs::write(none.join("run.json"), "[]").unwrap();
    assert!(refused(&none, &out).reason.contains("`exit`"));
    assert!(refused(&none.join("run.json"), &out).reason.contains("is a file"));
    assert!(granular_report::write(&Request::new([] as [&Path; 0], &out)).is_err());
    assert!(!out.exists(), "nothing is written when something is refused");
}

#[test]
fn a_page_that_cannot_be_written_leaves_the_old_one() {
    let scratch = Scratch::new("unwritable");
    let folder = scratch.run("a");
    let error = refused(&folder, &scratch.path("no/such/page.html"));
    assert!(error.fix.contains("--out"), "{error}");
    assert!(refused(&folder, &folder).reason.contains("is a folder"));
}

#[test]
fn a_bare_folder_makes_a_page_that_says_what_it_lacks() {
    let scratch = Scratch::new("bare");
    let page = Page::of(&scratch, &[scratch.bare("a")]);
    let run = &page.data()["runs"][0];
    assert_eq!((&run["tables"], &run["figures"], &run["movies"]), (&json!([]), &json!([]), &json!([])));
    let lacks: Vec<&str> =
        run["lacks"].as_array().unwrap().iter().map(|said| said.as_str().unwrap()).collect();
    for part in ["scene.ron", "limits", "no table", "no figures", "no fields over time"] {
        assert!(lacks.iter().any(|said| said.contains(part)), "{part}: {lacks:?}");
    }
    assert_eq!(page.written.left_out.len(), lacks.len());
}

#[test]
fn limits_come_from_the_run_or_from_a_check() {
    let scratch = Scratch::new("limits");
    let folder = scratch.bare("a");
    fs::write(folder.join("check.json"), r#"{"limits": [{"name": "contact time", "binds": true}]}"#).unwrap();
    let limits = |page: &Page| page.data()["runs"][0]["limits"][0]["name"].clone();
    assert_eq!(limits(&Page::of(&scratch, std::slice::from_ref(&folder))), json!("contact time"));
    fs::write(folder.join("run.json"), r#"{"exit": "done", "limits": [{"name": "own"}]}"#).unwrap();
    assert_eq!(limits(&Page::of(&scratch, &[folder])), json!("own"));
}

#[test]
fn several_folders_get_names_that_tell_them_apart_and_folders_of_runs_stand_for_them() {
    let scratch = Scratch::new("several");
    scratch.run("sweep/a/run");
    scratch.run("sweep/b/run");
    // A run of two parts: the outer folder is a run too, which has no results of its own.
    scratch.bare("both");
    scratch.run("both/grains");
    scratch.run("both/continuum");
    let page =
        Page::of(&scratch, &[scratch.path("sweep"), scratch.path("both"), scratch.path("sweep/a/run")]);
    let data = page.data();
    let names: Vec<&str> =
        data["runs"].as_array().unwrap().iter().map(|run| run["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["a/run", "b/run", "continuum", "grains"]);
    assert_eq!((page.written.runs, &data["heading"]), (4, &json!("Two grains: 4 runs")));
}
