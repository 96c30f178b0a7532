//! Scenes of several methods: joined by a law, apart, and side by side.

use crate::support::{Outcome, Scratch, assert_same_run, facts, snapshots, workspace};
use std::fs;

/// Grains that carry obstacles through a fluid, on fewer cells.
const JOINED: [&str; 2] = ["solvers.water.spacing=1 mm", "stages.0.end=For(\"40 ms\")"];
/// What needs later times.
const DRAWN: [&str; 1] = ["figures.0.times=[0.02]"];

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let scene = workspace().join("examples/ch5_carried_grains/scene.ron");
    fs::copy(scene, scratch.path("scene.ron")).unwrap();
    scratch
}

fn edited<'a>(out: &'a str, edits: &[&'a str]) -> Vec<&'a str> {
    let sets = JOINED.iter().chain(&DRAWN).chain(edits).flat_map(|edit| ["--set", edit]);
    ["run", "scene.ron", "--quiet", "--out", out].into_iter().chain(sets).collect()
}

fn run(scratch: &Scratch, out: &str, edits: &[&str]) -> Outcome {
    scratch.granular(&edited(out, edits))
}

#[test]
fn joined_methods_have_the_same_bits_for_any_number_of_threads_and_after_an_interruption() {
    let scratch = scratch("joined");
    run(&scratch, "one", &[]).expect(0);
    let whole = facts(&scratch.path("one"));
    for threads in ["1", "2", "3", "8"] {
        let mut words = edited("threads", &[]);
        words.extend(["--threads", threads, "--force"]);
        scratch.granular(&words).expect(0);
        assert_same_run(&scratch.path("one"), &scratch.path("threads"));
    }
    let metrics = whole["metrics"].as_object().unwrap();
    assert!(
        metrics.contains_key("grains.height") && metrics.contains_key("water.largest_speed"),
        "{metrics:?}"
    );
    assert!(whole["stages"][0]["solvers"]["grains"]["height"].as_f64().unwrap() > 0.05);
    // The fluid is pushed aside, so that it moves; grains fall as without it.
    assert!(metrics["water.largest_speed"].as_f64().unwrap() > 0.1);
    let often = ["snapshot_every=1 ms"];
    run(&scratch, "whole", &often).expect(0);
    let running = scratch.start(&edited("part", &often));
    let outcome = running.interrupt_when(|| snapshots(&scratch.path("part")).len() >= 2);
    // A fast machine may be done before the signal comes.
    if outcome.code != Some(0) {
        outcome.expect(130);
        scratch.granular(&["resume", "part", "--threads", "3"]).expect(0);
    }
    assert_same_run(&scratch.path("whole"), &scratch.path("part"));
}

#[test]
fn methods_that_nothing_joins_run_apart_and_are_compared() {
    let scratch = scratch("apart");
    let apart = ["couplings=[]", "fluid.largest_speed=0.1 m/s", "gravity=[\"0.1 m/s^2\", \"-9.81 m/s^2\"]"];
    run(&scratch, "apart", &apart).expect(0);
    assert_eq!(facts(&scratch.path("apart"))["runs"]["grains"]["exit"], "done");
    assert!(
        scratch.path("apart/grains/grains.csv").is_file()
            && scratch.path("apart/water/vorticity.png").is_file()
    );
    assert!(!scratch.path("apart/water/grains.csv").exists());
    run(&scratch, "joined", &[]).expect(0);
    // Grains are not acted on, so that a fluid around them changes nothing but their sideways gravity.
    let words = ["compare", "joined", "apart/grains", "--columns", "height,kinetic_energy", "--json"];
    let found = scratch.granular(&words).expect(0).json();
    let rows = found["rows"].as_array().unwrap();
    let of =
        |name: &str| rows.iter().find(|row| row["quantity"] == name && !row["difference"].is_null()).unwrap();
    // Steps of the grains divide those of the lattice where they are joined.
    assert!(of("height")["difference"]["largest"].as_f64().unwrap().abs() < 1e-5);
    assert!(of("kinetic_energy")["difference"]["largest"].as_f64().unwrap() != 0.0);
    for file in ["compare.csv", "compare.svg", "compare.png"] {
        assert!(scratch.path("compare").join(file).is_file(), "{file}");
    }
    let text = fs::read_to_string(scratch.path("compare/compare.csv")).unwrap();
    assert!(text.starts_with("quantity,unit,over,source,last,last_less_first,"), "{text}");
    // Fields on the same cells are compared, too.
    let words = ["compare", "joined", "apart", "--columns", "vorticity", "--out", "fields", "--json"];
    let found = scratch.granular(&words).expect(0).json();
    assert_eq!(found["rows"][0]["over"], "cells");
    for file in ["compare_vorticity.png", "compare_vorticity_difference.svg"] {
        assert!(scratch.path("fields").join(file).is_file(), "{file}");
    }
    let error = scratch.granular(&["compare", "joined", "apart", "--columns", "hight"]).expect(5);
    error.says(&["no two of them share hight", "apart/water:"]);
    scratch.granular(&["compare", "joined"]).expect(5).says(&["two runs or tables"]);
}

#[test]
fn laws_name_solvers_that_there_are() {
    let scratch = scratch("laws");
    let cases: &[(&str, &[&str])] = &[
        (
            "couplings.0.grains=sand",
            &["`couplings.0.grains` is `sand`, which is no solver", "a solver that is Dem: grains"],
        ),
        (
            "couplings.0.fluid=grains",
            &["`couplings.0.fluid` is `grains`, which is Dem", "a solver that is Lbm: water"],
        ),
        ("couplings.0.radius=0", &["`couplings.0.radius` is 0"]),
        ("outputs.0.of=watr", &["`outputs.0.of` is `watr`, which is no solver", "did you mean `water`?"]),
        ("stages.0.of=\"stone\"", &["`stages.0.of` is `stone`"]),
        ("outputs.1.of=grains", &["`mass_excess`, which nothing shows"]),
        (
            "cell=(periodic: [true, false], size: [\"40 mm\", \"1 m\"])",
            &["a scene without inlets, outlets and cell"],
        ),
    ];
    for (edit, parts) in cases {
        run(&scratch, "refused", &[edit]).expect(2).says(parts);
    }
}
