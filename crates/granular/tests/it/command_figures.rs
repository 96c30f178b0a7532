//! Figures of a run, the drawing of a scene before it, and what is told of them.

use crate::support::{SMALL, Scratch, facts, files};
use std::fs;

/// A scene with a table of few rows and a spectrum of it, which needs more.
fn with_a_spectrum() -> String {
    let table = "        (every: Time(\"30 ms\"), write: Table(path: \"few.csv\", probes: [\"front\"])),\n    ],\n    figures: [\n";
    let spectrum =
        "        Spectrum(path: \"spectrum\", table: \"few.csv\", column: \"front\", stage: \"collapse\"),\n";
    SMALL.replace("    ],\n    figures: [\n", &format!("{table}{spectrum}"))
}

#[test]
fn a_figure_that_cannot_be_drawn_leaves_the_run_done_and_is_told() {
    let scratch = Scratch::new("undrawn");
    fs::write(scratch.path("small.ron"), with_a_spectrum()).unwrap();
    let said =
        ["warning: figures.0 `spectrum` was not drawn: the series of `front`", "too short for a spectrum"];
    scratch.granular(&["run", "small.ron", "-q", "--out", "run"]).expect(0).says(&said);
    let known = facts(&scratch.path("run"));
    assert_eq!((&known["exit"], &known["figures"]["drawn"]), (&"done".into(), &4.into()));
    assert_eq!(known["figures"]["failed"].as_array().unwrap().len(), 1, "{}", known["figures"]);
    // The others are there, also when they are drawn again.
    let before = files(&scratch.path("run"));
    assert!(before.contains_key("flow.svg") && !before.contains_key("spectrum.svg"));
    let again = scratch.granular(&["plot", "run"]).expect(5);
    assert!(again.err.contains("error: figures.0 `spectrum` was not drawn"), "{}", again.err);
    assert!(again.out.contains("run/runout.svg"), "{}", again.out);
    assert!(files(&scratch.path("run")) == before, "the figures differ");
    scratch.granular(&["resume", "run"]).expect(5).says(&["this run is done"]);
    // What is told of the run has no raw JSON.
    let told = scratch.granular(&["info", "run"]).expect(0).out;
    for part in ["run: done", "stage collapse", "figure failed", "wall time", "grain-steps/s", "files "] {
        assert!(told.contains(part), "{part} is not in\n{told}");
    }
    assert!(!told.contains('{') && told.lines().count() < 40, "{told}");
}

#[test]
fn a_time_after_the_end_is_told_before_and_after_the_run_and_repeats_no_panel() {
    let scratch = Scratch::with_scene("late");
    let late = "figures.2.times=[0, 1, 50, 60]";
    let warned = scratch.granular(&["check", "small.ron", "--set", late]).expect(0).out;
    assert!(
        warned.contains("warning: figures.2 `flow`: the run ends before 50 √(H₀/g), 60 √(H₀/g)"),
        "{warned}"
    );
    let said = ["figures.2 `flow`: the last state is shown for t = 50", "nothing is shown for t = 60"];
    scratch.granular(&["run", "small.ron", "--out", "run", "--set", late]).expect(0).says(&said);
    let svg = fs::read_to_string(scratch.path("run/flow.svg")).unwrap();
    assert_eq!(svg.matches(">t = ").count(), 3, "three states, none of them twice");
    let quiet = scratch.granular(&["check", "small.ron"]).expect(0).out;
    assert!(!quiet.contains("warning"), "{quiet}");
}

#[test]
fn a_check_tells_what_the_sample_takes_up_and_draws_it() {
    let scratch = Scratch::with_scene("drawn");
    let told = scratch.granular(&["check", "small.ron", "--draw", "before.svg"]).expect(0).out;
    for part in
        ["sample    ", " wide, ", " high: from ", "gravity   9.81 m/s^2 along -y", "drawing   before.svg"]
    {
        assert!(told.contains(part), "{part} is not in\n{told}");
    }
    let svg = fs::read_to_string(scratch.path("before.svg")).unwrap();
    assert!(svg.contains(">opens at collapse</text>") && svg.matches("<circle").count() == 120);
    assert!(fs::read(scratch.path("before.png")).unwrap().starts_with(b"\x89PNG"));
    let json = scratch.granular(&["check", "small.ron", "--json"]).expect(0).json();
    let sample = &json["sample"];
    assert!((sample["width"].as_f64().unwrap() - 0.0138).abs() < 1e-3, "{sample}");
    assert!(sample["lowest"].as_f64().unwrap().abs() < 1e-4, "{sample}");
    // Nothing else is written.
    assert_eq!(files(&scratch.path("")).len(), 3);
}

#[test]
fn names_with_a_dot_keep_all_of_it_and_names_that_no_table_holds_are_refused() {
    let scratch = Scratch::new("names");
    let text = SMALL
        .replace("path: \"grains\"", "path: \"grains.v2\"")
        .replace("fields: \"grains\"", "fields: \"grains.v2\"");
    fs::write(scratch.path("small.ron"), text).unwrap();
    let short = ["--set", "stages.0.end=For(\"4 ms\")", "--set", "stages.1.end=For(\"20 ms\")"];
    let run = [&["run", "small.ron", "-q", "--out", "run"][..], &short].concat();
    let outcome = scratch.granular(&run).expect(0);
    assert!(!outcome.err.contains("not drawn"), "{}", outcome.err);
    for name in ["grains.v2.pvd", "grains.v2_000000.vtp", "flow.svg"] {
        assert!(scratch.path("run").join(name).is_file(), "{name}");
    }
    // A table that is called as a frame.
    let text = SMALL.replace("series.csv", "grains_000003.vtp");
    fs::write(scratch.path("small.ron"), text).unwrap();
    let said = ["`outputs.1.write.path` is `grains` again", "`outputs.0.write.path` writes it"];
    scratch.granular(&["check", "small.ron"]).expect(2).says(&said);
    let wall = "Floor(material: \"wall\"),\n        Plane(name: \"a,b\", material: \"wall\", point: [\"-1 m\", 0], normal: [1, 0]),";
    let text = SMALL.replacen("Floor(material: \"wall\"),", wall, 1).replacen(
        "\"front\"",
        "\"force_on_a,b_x\", \"front\"",
        1,
    );
    fs::write(scratch.path("small.ron"), text).unwrap();
    let said = ["`outputs.0.write.probes.0` is `force_on_a,b_x`, which no table can hold", "rename the wall"];
    scratch.granular(&["check", "small.ron"]).expect(2).says(&said);
}

#[test]
fn stress_over_strain_is_a_figure_of_a_scene() {
    let scratch = Scratch::new("curve");
    let curve = "figures: [\n        Curve(path: \"loop\", table: \"series.csv\", x: \"front\", columns: [\"kinetic_energy\", \"height\"]),";
    let text = SMALL.replace("figures: [", curve);
    fs::write(scratch.path("small.ron"), &text).unwrap();
    let short = ["--set", "stages.0.end=For(\"4 ms\")", "--set", "stages.1.end=For(\"20 ms\")"];
    scratch.granular(&[&["run", "small.ron", "-q", "--out", "run"][..], &short].concat()).expect(0);
    let svg = fs::read_to_string(scratch.path("run/loop.svg")).unwrap();
    for label in ["front [m]", "kinetic energy [J]", "height [m]"] {
        assert!(svg.contains(&format!(">{label}</text>")), "{label}");
    }
    fs::write(scratch.path("small.ron"), text.replace("x: \"front\"", "x: \"frnt\"")).unwrap();
    scratch
        .granular(&["check", "small.ron"])
        .expect(2)
        .says(&["`figures.0.table`", "does not hold \"frnt\""]);
}
