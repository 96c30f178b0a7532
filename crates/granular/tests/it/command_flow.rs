//! Scenes of fluids at the command: what a run leaves, the same bits, and what is refused.

use crate::support::{Scratch, assert_same_run, facts, snapshots};
use std::fs;

const FLOW: &str = include_str!("flow.ron");
const RUN: &[&str] = &["run", "flow.ron", "--quiet"];

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    fs::write(scratch.path("flow.ron"), FLOW).unwrap();
    scratch
}

fn edited(out: &str, edits: &[&str]) -> Vec<String> {
    let words =
        RUN.iter().copied().chain(["--out", out]).chain(edits.iter().flat_map(|edit| ["--set", edit]));
    words.map(str::to_owned).collect()
}

fn run(scratch: &Scratch, out: &str, edits: &[&str]) -> crate::support::Outcome {
    let words = edited(out, edits);
    scratch.granular(&words.iter().map(String::as_str).collect::<Vec<_>>())
}

#[test]
fn a_flow_leaves_its_tables_fields_figures_and_metrics() {
    let scratch = scratch("flow");
    run(&scratch, "run", &[]).expect(0);
    let facts = facts(&scratch.path("run"));
    assert_eq!(facts["stages"][1]["ended"], "not steady within the time");
    let metric =
        |name: &str| facts["metrics"][name].as_f64().unwrap_or_else(|| panic!("no metric {name}: {facts}"));
    // The disk shakes the fluid at its own frequency.
    let frequency = metric("frequency_of_lift_coefficient_of_disk");
    assert!((frequency - 2.0).abs() < 0.05, "{frequency}");
    let strouhal = metric("strouhal_of_lift_coefficient_of_disk");
    assert!((strouhal - frequency * 8e-3 / 20e-3).abs() < 1e-9, "{strouhal}");
    assert!(metric("drag_coefficient_of_disk") > 0.5);
    assert!(metric("largest_speed") > 0.02);
    let profile = granular_io::read_table(&scratch.path("run/profile.csv")).unwrap();
    let names: Vec<&str> = profile.columns.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["time", "distance", "x", "y", "velocity_x", "velocity_y", "pressure"]);
    assert_eq!(profile.rows.len() % 31, 0);
    let top = profile.rows.last().unwrap();
    assert!((top[4] - 5e-3).abs() < 1e-3, "the fluid moves with the wall above: {top:?}");
    for figure in ["map", "wake", "spectrum"] {
        assert!(fs::read(scratch.path(&format!("run/{figure}.png"))).unwrap().starts_with(b"\x89PNG"));
    }
    scratch.granular(&["plot", "run"]).expect(0);
    let shown = scratch.granular(&["info", "flow.ron"]).expect(0).out;
    for name in ["drag_coefficient_of_disk", "pressure_at_wake", "torque_on_step_z", "vorticity"] {
        assert!(shown.contains(name), "{name} is not in\n{shown}");
    }
}

#[test]
fn a_flow_has_the_same_bits_for_any_number_of_threads_and_after_an_interruption() {
    let scratch = scratch("flow-bits");
    for precision in ["Double", "Single"] {
        let precise = format!("solvers.oil.precision={precision}");
        let edits = [precise.as_str(), "stages.1.end=For(\"4 s\")"];
        run(&scratch, "whole", &edits).expect(0);
        let words = edited("part", &edits);
        let run = scratch.start(&words.iter().map(String::as_str).collect::<Vec<_>>());
        let outcome = run.interrupt_when(|| snapshots(&scratch.path("part")).len() >= 2);
        // A fast machine may be done before the signal comes.
        if outcome.code != Some(0) {
            outcome.expect(130);
            scratch.granular(&["resume", "part", "--threads", "3"]).expect(0);
        }
        assert_same_run(&scratch.path("whole"), &scratch.path("part"));
        for folder in ["whole", "part"] {
            fs::remove_dir_all(scratch.path(folder)).unwrap();
        }
    }
}

/// What is set, the exit code, and parts of the message.
const REFUSED: &[(&str, i32, &[&str])] = &[
    ("fluid.viscosity=\"1e-5 Pa s\"", 2, &["a viscosity, but a kinematic viscosity"]),
    ("fluid.viscosity=0", 2, &["`fluid.viscosity` is 0", "above 0"]),
    ("fluid.size=[\"60 mm\"]", 2, &["`fluid.size` is a list of 1", "2 values, one per axis"]),
    (
        "fluid.size.1=\"30.4 mm\"",
        2,
        &["`solvers.oil.spacing`", "does not divide fluid.size.1", "0.0008 m divides all sides"],
    ),
    ("fluid.faces.top=Periodic", 2, &["one periodic face along axis 1", "both or none"]),
    ("fluid.faces.top=MovingWall([0, \"5 mm/s\"])", 2, &["velocity of a wall", "a velocity along the wall"]),
    ("fluid.faces.left=Wall", 2, &["`fluid.start` is LikeInflow", "an Inflow at fluid.faces.left"]),
    ("fluid.obstacles.1.name=disk", 2, &["`fluid.obstacles.1.name` is `disk` again"]),
    ("fluid.obstacles.0.shape.radius=0", 2, &["`fluid.obstacles.0.shape.radius` is 0 m", "above 0"]),
    ("fluid.obstacles.0.shape.radius=\"0.1 mm\"", 2, &["`disk`, which covers the centre of no cell"]),
    ("fluid.obstacles.0.spin=[1, 2]", 2, &["`fluid.obstacles.0.spin`", "one value in the plane"]),
    (
        "fluid.gauges={\"far\": [\"70 mm\", \"18 mm\"]}",
        2,
        &["`fluid.gauges.far` is at x = 0.07 m, outside the fluid", "x from -0.01 to 0.05 m"],
    ),
    ("solvers.oil.step=Mach(0.6)", 3, &["Mach number is 0.6", "at most 0.3"]),
    ("solvers.oil.step=RelaxationTime(0.4)", 2, &["`solvers.oil.step` is 0.4", "above 0.5 steps"]),
    ("solvers.oil.operator=TwoRelaxation(-1)", 2, &["`solvers.oil.operator` is of Lambda -0.9", "above 0"]),
    ("solvers.oil=Dem(())", 2, &["`sample` is missing", "`fluid` is given"]),
    ("stages.0.time_step=\"1 ms\"", 2, &["`stages.0.time_step`", "set solvers.oil.step"]),
    ("stages.0.end=Quiet(kinetic_over_potential: 1, within: 1)", 2, &["`stages.0.end`", "For or Steady"]),
    (
        "stages.1.changes=[StopMotion]",
        2,
        &[
            "`stages.1.changes.0`",
            "ObstacleSpin or Gravity",
            "`oil` is Lbm, which does not use it; Dem or Mpm does",
        ],
    ),
    ("outputs.2.write.to=[\"20 mm\", \"31 mm\"]", 2, &["outside the fluid", "a line in the fluid"]),
    ("outputs.0.write.probes=[\"drag_coefficient_of_step\"]", 2, &["which nothing shows"]),
    ("figures.0.range=[2, 1]", 2, &["`figures.0.range`", "the lower one first"]),
];

#[test]
fn a_flow_that_makes_no_sense_is_refused_by_name_and_leaves_no_trace() {
    let scratch = scratch("flow-refused");
    for (edit, code, parts) in REFUSED {
        run(&scratch, "out", &[edit]).expect(*code).says(parts);
        assert!(!scratch.path("out").exists(), "{edit} left a folder");
    }
}

#[test]
fn a_flow_that_blows_up_is_stopped_by_name_with_its_last_good_state() {
    let scratch = scratch("flow-stopped");
    // Nobody can know beforehand how fast this gravity drives the fluid.
    let outcome = run(&scratch, "out", &["gravity=[20, 0]"]).expect(4);
    outcome.says(&[
        "density over that at rest in cell",
        "its distance from 1: ",
        "the last good snapshot is in",
    ]);
    assert!(!snapshots(&scratch.path("out")).is_empty());
}

#[test]
fn check_tells_what_a_flow_derives_and_leaves_out() {
    let scratch = scratch("flow-check");
    let report = scratch.granular(&["check", "flow.ron"]).expect(0);
    for part in ["relaxation time", "Mach number", "grid Reynolds number", "the scene can be run"] {
        assert!(report.out.contains(part), "{part} is not in\n{}", report.out);
    }
    let json = scratch.granular(&["check", "flow.ron", "--json"]).expect(0).json();
    let bytes = json["bytes_per_item"].as_u64().unwrap();
    assert!((72..140).contains(&bytes), "{bytes} bytes per cell of a small grid");
}
