//! Scenes that begin without a grain, and scenes whose grains have nothing below them.

use crate::support::{Scratch, assert_same_run, snapshots};
use std::fs;

/// Disks that all come in through an inlet, onto a floor.
const RAIN: &str = r#"Scene(version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "g": (density: "2500 kg/m^3", normal_stiffness: "1e5 N/m", restitution: 0.5, friction: 0.5) },
    inlets: [(name: "in", low: ["-20 mm", "30 mm"], high: ["200 mm", "85 mm"], rate: 4000, number: 25, grading: Single("2 mm"),
        material: "g")],
    walls: [Floor(material: "g")],
    stages: [(name: "fill", end: For("0.1 s")), (name: "rest", end: For("2 s"))],
    solvers: { "d": Dem(()) }, snapshot_every: 0.02,
    figures: [Series(path: "f", table: "s.csv", columns: ["kinetic_energy", "front"])],
    outputs: [(every: Time("1 ms"), write: Table(path: "s.csv", probes: ["kinetic_energy", "front", "height"]))])"#;

/// Spheres of graded sizes with elastic constants; nothing there at the start from which a mean could be taken.
const ELASTIC: &str = r#"Scene(version: 1, dimension: Space, gravity: [0.0, 0.0, -9.81],
    materials: { "g": (density: "2500 kg/m^3", young_modulus: "1e8 Pa", poisson_ratio: 0.25, restitution: 0.5, friction: 0.5) },
    inlets: [(name: "in", low: ["-20 mm", "-15 mm", "30 mm"], high: ["20 mm", "15 mm", "55 mm"], rate: 4000, number: 50,
        velocity: ["0.2 m/s", "0 m/s", "-0.5 m/s"], grading: EqualMass(min: "3 mm", max: "6 mm"), material: "g")],
    walls: [Floor(material: "g"), Plane(name: "lid", point: ["0 mm", "0 mm", "70 mm"], normal: [0, 0, -1], material: "g",
        moves: Servo(force: "1 N", max_speed: "1 mm/s"))],
    stages: [(name: "fill", end: For("0.03 s"))],
    solvers: { "d": Dem((contact: Hertz)) })"#;

/// A column between sides, whose floor was forgotten.
const NO_FLOOR: &str = r#"Scene(version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "g": (density: "2650 kg/m^3", normal_stiffness: "1e5 N/m", restitution: 0.5, friction: 0.5) },
    sample: Column(extent: Grains(100), aspect_ratio: 1.0, material: "g", packing: Hexagonal, grading: Single("2 mm")),
    walls: [Left(material: "g"), Right(material: "g")],
    stages: [(name: "settle", end: For("5 s"))],
    solvers: { "d": Dem(()) },
    outputs: [(every: Time("10 ms"), write: Table(path: "s.csv", probes: ["height"]))])"#;

#[test]
fn a_scene_without_a_grain_at_the_start_is_resumed_and_drawn() {
    let scratch = Scratch::new("rain");
    fs::write(scratch.path("scene.ron"), RAIN).unwrap();
    scratch.granular(&["run", "scene.ron", "--quiet", "--out", "whole"]).expect(0);
    let table = fs::read_to_string(scratch.path("whole/s.csv")).unwrap();
    assert!(!table.contains("inf"), "{}", &table[..200]);
    assert!(scratch.path("whole/f.svg").is_file());
    // It is taken up from a snapshot of a stage that began without a grain.
    let run = scratch.start(&["run", "scene.ron", "--quiet", "--out", "cut"]);
    run.interrupt_when(|| !snapshots(&scratch.path("cut")).is_empty()).expect(130);
    scratch.granular(&["resume", "cut", "--quiet"]).expect(0);
    assert_same_run(&scratch.path("whole"), &scratch.path("cut"));
    scratch.granular(&["plot", "cut"]).expect(0);
}

#[test]
fn means_over_the_grains_count_those_that_come() {
    let scratch = Scratch::new("elastic");
    fs::write(scratch.path("scene.ron"), ELASTIC).unwrap();
    scratch.granular(&["run", "scene.ron", "--quiet", "--out", "hertz"]).expect(0);
    scratch
        .granular(&[
            "run",
            "scene.ron",
            "--quiet",
            "--out",
            "linear",
            "--set",
            "solvers.d=Dem((contact: Linear))",
        ])
        .expect(0);
}

#[test]
fn grains_with_nothing_below_are_told_before_the_run_and_end_it() {
    let scratch = Scratch::new("no-floor");
    fs::write(scratch.path("scene.ron"), NO_FLOOR).unwrap();
    let report = scratch.granular(&["check", "scene.ron"]).expect(0);
    assert!(report.out.contains("nothing lies below 85 of 85 grains"), "{}", report.out);
    assert!(report.out.contains("add a wall below them, such as Floor"), "{}", report.out);
    assert!(report.out.ends_with("the scene can be run, with a warning\n"), "{}", report.out);
    let run = scratch.granular(&["run", "scene.ron", "--quiet", "--out", "out"]).expect(4);
    run.says(&["all 85 grains have left the walls", "add a wall below the grains"]);
    let facts = crate::support::facts(&scratch.path("out"));
    assert_eq!(facts["code"], 4);
    assert!(facts["reason"].as_str().unwrap().contains("all 85 grains have left the walls"), "{facts}");
    // Free fall for 5 s would be 123 m.
    let table = fs::read_to_string(scratch.path("out/s.csv")).unwrap();
    let last: f64 = table.lines().last().unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((-0.5..-0.02).contains(&last), "{last}");

    let up = scratch.granular(&["check", "scene.ron", "--set", "gravity=[0, 9.81]"]).expect(0);
    assert!(up.out.contains("gravity points up"), "{}", up.out);
    for cure in [
        "walls=[Left(material: \"g\"), Right(material: \"g\"), Floor(material: \"g\")]",
        "outlets=[Beyond(point: [0, \"-1 m\"], normal: [0, -1])]",
        "gravity=[]",
    ] {
        let report = scratch.granular(&["check", "scene.ron", "--json", "--set", cure]).expect(0).json();
        assert_eq!(report["warnings"].as_array().map(Vec::len), Some(0), "{cure}: {report}");
    }
}

#[test]
fn inlets_beside_a_periodic_cell_are_refused_in_words() {
    let scratch = Scratch::new("inlet-in-cell");
    fs::write(scratch.path("scene.ron"), RAIN).unwrap();
    let cell = "cell=(periodic: [true, false], size: [\"0.3 m\", \"1 m\"])";
    let refused = scratch.granular(&["check", "scene.ron", "--set", cell]).expect(2);
    refused.says(&["1 in a scene with a periodic cell", "fill it by its `sample`"]);
}

/// A drum of one circle, and a lid whose pressure acts on the width between sides of which one moves.
#[test]
fn circles_and_pressures_between_walls_work_from_a_scene() {
    let scratch = Scratch::new("drum");
    let drum = NO_FLOOR.replace(
        "walls: [Left(material: \"g\"), Right(material: \"g\")]",
        "walls: [Circle(name: \"drum\", centre: [\"10 mm\", \"8 mm\"], radius: \"20 mm\", material: \"g\",
            moves: Rotate(about: [\"10 mm\", \"8 mm\"], spin: [\"30 rpm\"]))]",
    );
    let drum = drum.replace("For(\"5 s\")", "For(\"0.2 s\")").replace(
        "probes: [\"height\"]",
        "probes: [\"height\", \"torque_on_drum\", \"angle_of_drum\", \"position_of_drum_x\"]",
    );
    fs::write(scratch.path("drum.ron"), drum).unwrap();
    scratch.granular(&["run", "drum.ron", "--quiet", "--out", "drum"]).expect(0);
    let table = fs::read_to_string(scratch.path("drum/s.csv")).unwrap();
    let last: Vec<f64> =
        table.lines().last().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
    assert!((last[3] - last[0] * std::f64::consts::PI).abs() < 1e-9, "30 rpm is pi rad/s: {last:?}");
    assert!(last[1] > -0.0125 && (last[4] - 0.01).abs() < 1e-12, "{last:?}");

    let press = NO_FLOOR.replace(
        "walls: [Left(material: \"g\"), Right(material: \"g\")]",
        "walls: [Floor(material: \"g\"), Left(material: \"g\"), Plane(name: \"side\", point: [\"22 mm\", 0], normal: [-1, 0], material: \"g\",
            moves: Steady([\"-5 mm/s\", 0])), Plane(name: \"lid\", point: [0, \"25 mm\"], normal: [0, -1], material: \"g\",
            moves: Servo(pressure: \"2 kPa\", between: [[\"left\", \"side\"]], damping: 10))]",
    );
    let press = press.replace("For(\"5 s\")", "For(\"0.1 s\")").replace(
        "probes: [\"height\"]",
        "probes: [\"area_of_lid\", \"pressure_on_lid\", \"velocity_of_lid_y\"]",
    );
    fs::write(scratch.path("press.ron"), &press).unwrap();
    scratch.granular(&["run", "press.ron", "--quiet", "--out", "press"]).expect(0);
    let table = fs::read_to_string(scratch.path("press/s.csv")).unwrap();
    let last: Vec<f64> =
        table.lines().last().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
    assert!((last[1] - (0.022 - 0.005 * last[0])).abs() < 1e-12, "{last:?}");
    assert!(last[2] > 500.0, "{last:?}");
    fs::write(scratch.path("wrong.ron"), press.replace("\"side\"]]", "\"floor\"]]")).unwrap();
    scratch
        .granular(&["check", "wrong.ron"])
        .expect(2)
        .says(&["two planes that face one another, of: floor, left, side, lid"]);
}
