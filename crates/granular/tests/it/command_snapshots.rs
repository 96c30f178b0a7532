//! Snapshots that are damaged, or of another scene.

use crate::support::{Scratch, assert_same_run, copy, files, snapshots};
use std::fs;
use std::path::Path;
use std::time::Duration;

const RUN: &[&str] = &[
    "run",
    "small.ron",
    "--quiet",
    "--set",
    "snapshot_every=30 ms",
    "--set",
    "stages.1.end=For(\"0.3 s\")",
    "--set",
    "figures=[]",
];

/// A run that was interrupted when it had two snapshots.
fn interrupted(scratch: &Scratch, edits: &[&str], out: &str) {
    let run = scratch.start(&[RUN, edits, &["--out", out]].concat());
    while snapshots(&scratch.path(out)).len() < 2 {
        std::thread::sleep(Duration::from_millis(1));
    }
    run.signal("INT");
    run.wait().expect(130);
}

fn flip_a_bit(path: &Path, part: f64) {
    let mut bytes = fs::read(path).unwrap();
    let place = (part * bytes.len() as f64) as usize;
    bytes[place] ^= 1;
    fs::write(path, bytes).unwrap();
}

#[test]
fn damage_costs_one_snapshot_and_two_the_run() {
    let scratch = Scratch::with_scene("damage");
    scratch.granular(&[RUN, &["--out", "whole"]].concat()).expect(0);
    interrupted(&scratch, &[], "run");

    for (name, part) in [("header", 0.0), ("middle", 0.5), ("end", 0.9999)] {
        copy(&scratch.path("run"), &scratch.path(name));
        let newest = snapshots(&scratch.path(name)).pop().unwrap();
        flip_a_bit(&newest, part);
        let resumed = scratch.granular(&["resume", name]).expect(0);
        let file = newest.file_name().unwrap().to_string_lossy();
        resumed.says(&["warning: ", &file, "an older snapshot is used", "resuming at"]);
        assert_same_run(&scratch.path("whole"), &scratch.path(name));
    }

    let folder = scratch.path("run");
    for snapshot in snapshots(&folder) {
        flip_a_bit(&snapshot, 0.5);
    }
    let before = files(&folder);
    let lost = scratch.granular(&["resume", "run"]).expect(5);
    let [older, newer] = [0, 1].map(|k| snapshots(&folder)[k].file_name().unwrap().to_owned());
    let names = [older.to_string_lossy(), newer.to_string_lossy()];
    println!("{}", lost.err);
    lost.says(&["no snapshot can be read", "section `solver`", "its checksum differs", &names[0], &names[1]]);
    assert!(files(&folder) == before, "what is left may still be of use");
}

#[test]
fn a_snapshot_of_another_scene_is_refused() {
    let scratch = Scratch::with_scene("foreign");
    interrupted(&scratch, &[], "one");
    interrupted(&scratch, &["--set", "materials.glass.friction=0.4"], "other");
    let folder = scratch.path("one");
    let foreign = |from: &str| {
        fs::remove_dir_all(folder.join("snapshots")).unwrap();
        copy(&scratch.path(from).join("snapshots"), &folder.join("snapshots"));
    };
    foreign("other");
    let before = files(&folder);
    let refused = scratch.granular(&["resume", "one"]).expect(5);
    println!("{}", refused.err);
    let parts = ["snapshot-", "section `run/scene`", "differs from one/scene.ron", "of another scene"];
    refused.says(&parts);
    assert!(files(&folder) == before, "files changed");
    // So is a scene that was changed under way.
    fs::write(scratch.path("other/scene.ron"), fs::read(folder.join("scene.ron")).unwrap()).unwrap();
    scratch.granular(&["resume", "other"]).expect(5).says(&["of another scene", "other/scene.ron"]);
}
