//! Stages that begin with a push: what is checked, run, measured, and taken up again.

use crate::support::{Scratch, assert_same_run, facts, snapshots, workspace};
use std::fs;

/// A pile of 100 disks that is pushed.
const SCENE: &str = r#"Scene(
    version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "glass": (density: 2650, normal_stiffness: "1e5 N/m", restitution: 0.5, friction: 0.4, rolling_friction: 0.1) },
    sample: Column(extent: Grains(100), aspect_ratio: 0.5, grading: EqualMass(min: "0.9 mm", max: "1.4 mm"),
        material: "glass", packing: Ballistic, seed: 2),
    walls: [Floor(material: "glass"), Left(material: "glass"), Gate(material: "glass", opens: "spread")],
    stages: [
        (name: "spread", end: For("80 ms")),
        (name: "impact", end: Quiet(kinetic_over_potential: 1e-5, within: "500 ms"), changes: [
            Push(energy_per_grain: 12, profile: Gradient),
        ]),
    ],
    solvers: { "grains": Dem((steps_per_contact: 150)) },
    outputs: [(every: Time("1 ms"), write: Table(path: "series.csv", probes: ["front", "kinetic_energy", "kinetic_energy_x",
        "energy_residual"]))],
    figures: [Impact(path: "impact", table: "series.csv", stage: "impact")],
)"#;

fn with_scene(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    fs::write(scratch.path("push.ron"), SCENE).unwrap();
    scratch
}

#[test]
fn a_push_is_announced_given_and_measured() {
    let scratch = with_scene("push");
    let check = scratch.granular(&["check", "push.ron"]).expect(0);
    for part in
        ["impact  ", "begins with a push along [1.0, 0.0]", "12.0000 m g d per grain", "nothing at the top"]
    {
        assert!(check.out.contains(part), "`{part}` is not in:\n{}", check.out);
    }
    let json = scratch.granular(&["check", "push.ron", "--json"]).expect(0).json();
    assert_eq!(json["pushes"][0]["stage"], "impact");

    scratch.granular(&["run", "push.ron", "--out", "run", "-q", "--threads", "1"]).expect(0);
    let facts = facts(&scratch.path("run"));
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let push = &facts["stages"][1]["solvers"]["grains"]["push"];
    assert!(facts["stages"][0]["solvers"]["grains"].get("push").is_none());
    let scale = ["mass", "gravity", "diameter"].iter().map(|key| number(&push[*key])).product::<f64>();
    assert!((number(&push["energy"]) / scale - 12.0).abs() < 1e-12, "{push}");
    let metrics = &facts["metrics"];
    assert!((number(&metrics["impact_energy_per_grain"]) - 12.0).abs() < 1e-12);
    assert_eq!(metrics["impact_momentum"], push["momentum"]);
    // What the metrics say is in the table.
    let table = granular_io::read_table(&scratch.path("run/series.csv")).unwrap();
    let column = |name: &str| table.column(name).unwrap();
    let start = number(&facts["stages"][1]["start"]);
    let at = column("time").iter().position(|time| *time > start).unwrap();
    let run_out = number(&metrics["impact_runout"]);
    let first = number(&facts["stages"][1]["solvers"]["grains"]["front"]);
    assert!(
        (column("front").last().unwrap() / first - 1.0 - run_out).abs() < 1e-12 && run_out > 0.3,
        "{run_out}"
    );
    // The first row after the push comes within a millisecond, when a little is lost.
    let energy = number(&push["energy"]);
    let given = column("kinetic_energy")[at] / energy;
    assert!((0.8..1.001).contains(&given), "{given}");
    let residual = column("energy_residual");
    assert!(residual.iter().all(|residual| residual.abs() < 1e-3 * energy), "{residual:?}");
    for name in ["impact_duration", "impact_half_life", "impact_rise_ends", "impact_motion_ends"] {
        assert!(number(&metrics[name]) > 0.0, "{metrics}");
    }
    assert!(fs::metadata(scratch.path("run/impact.svg")).unwrap().len() > 2000);
}

#[test]
fn a_run_that_is_interrupted_after_a_push_ends_in_the_same_bits() {
    let scratch = with_scene("push-interrupt");
    let run =
        ["run", "push.ron", "-q", "--set", "snapshot_every=20 ms", "--set", "stages.0.end=For(\"10 ms\")"];
    scratch.granular(&[&run[..], &["--out", "whole", "--threads", "1"]].concat()).expect(0);
    let started = scratch.start(&[&run[..], &["--out", "again", "--threads", "3"]].concat());
    let stages = &facts(&scratch.path("whole"))["stages"];
    let at = |key: &str, stage: usize| stages[stage][key].as_f64().unwrap();
    let first = (at("start", 1) / at("dt", 0)).round() as u64;
    // One at the start of each stage, then on a timer.
    let pushed = || {
        let step = |path: &std::path::PathBuf| {
            path.file_stem()?.to_str()?.rsplit(['-', '_']).next()?.parse::<u64>().ok()
        };
        snapshots(&scratch.path("again")).iter().filter_map(step).max().is_some_and(|step| step >= first)
    };
    while !pushed() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    started.signal("INT");
    let code = started.wait().code;
    assert!(code == Some(130) || code == Some(0), "{code:?}");
    if code == Some(130) {
        scratch.granular(&["resume", "again", "-q", "--threads", "2"]).expect(0);
    }
    assert_same_run(&scratch.path("whole"), &scratch.path("again"));
}

#[test]
fn pushes_that_make_no_sense_are_explained() {
    let scratch = with_scene("push-wrong");
    let push = "stages.1.changes.0";
    let cases: &[(&str, &[&str])] = &[
        (
            "Push(profile: Gradient)",
            &["stages.1.changes.0` is 0 of them", "one of `speed`, `energy` and `energy_per_grain`"],
        ),
        ("Push(speed: 1, energy: 2)", &["is 2 of them"]),
        ("Push(energy: -1)", &["stages.1.changes.0.energy` is -1", "turn `direction` round"]),
        ("Push(energy_per_grain: -1)", &["stages.1.changes.0.energy_per_grain` is -1", "0 or more"]),
        ("Push(speed: \"1 m\")", &["`1 m` is a length, but a velocity"]),
        (
            "Push(speed: 1, direction: [0, 0])",
            &["changes.0.direction` is [0.0, 0.0]", "2 numbers, one per axis, not all zero"],
        ),
        ("Push(speed: 1, direction: [1])", &["changes.0.direction` is [1.0]"]),
        ("Push(speed: 1, profile: Linear)", &["Linear", "Uniform", "Gradient"]),
    ];
    for (wrong, parts) in cases {
        let set = format!("{push}={wrong}");
        scratch.granular(&["check", "push.ron", "--set", &set]).expect(2).says(parts);
    }
    let check = |set: &[&str]| {
        let set: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
        scratch.granular(&[&["check", "push.ron"], &set[..]].concat()).expect(2)
    };
    check(&["gravity=[0, 0]"]).says(&["energy_per_grain` is 12", "a stage with gravity"]);
    check(&["figures.0.stage=spread"])
        .says(&["figures.0.stage` is `spread`, which pushes nothing", "a stage with a Push: impact"]);
    check(&["figures.0.transient=-1"]).says(&["figures.0.transient` is -1"]);
    check(&["outputs.0.write.probes=[\"front\"]"])
        .says(&["does not hold \"kinetic_energy\", \"kinetic_energy_x\""]);
}

#[test]
fn a_saved_pile_is_pushed_by_the_other_scene_of_the_example() {
    let scratch = Scratch::new("pile");
    for name in ["scene.ron", "from_pile.ron"] {
        fs::copy(workspace().join("examples/ch4_slope_impact").join(name), scratch.path(name)).unwrap();
    }
    let short = [
        "--set",
        "sample.extent=Grains(60)",
        "--set",
        "stages.0.end=For(\"10 ms\")",
        "--set",
        "stages.1.end=For(\"100 ms\")",
        "--set",
        "stages.2.end=For(\"20 ms\")",
    ];
    scratch.granular(&[&["run", "scene.ron", "--out", "pile", "-q"], &short[..]].concat()).expect(0);
    let short = [
        "--set",
        "sample.path=\"pile/pile.csv\"",
        "--set",
        "stages.0.end=For(\"20 ms\")",
        "--set",
        "stages.1.end=For(\"20 ms\")",
    ];
    scratch.granular(&[&["run", "from_pile.ron", "--out", "run", "-q"], &short[..]].concat()).expect(0);
    let given = facts(&scratch.path("run"))["metrics"]["impact_energy_per_grain"].as_f64().unwrap();
    assert!((given - 8.0).abs() < 1e-12, "{given}");
}
