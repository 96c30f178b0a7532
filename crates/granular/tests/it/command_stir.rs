//! Fluids that are stirred: forces that vary, lids, walls that slip, an annulus, and what stages change.

use crate::support::{Scratch, assert_same_run, facts};
use std::fs;

/// A force that varies along y in a periodic box.
const KOLMOGOROV: &str = r#"Scene(
    version: 1,
    dimension: Plane,
    fluid: (
        size: ["4 mm", "32 mm"],
        viscosity: "1e-5 m^2/s",
        largest_speed: "3 mm/s",
        forces: [(
            acceleration: ["1e-3 m/s^2", 0],
            in_space: Sine(along: Y, wavelength: "32 mm", phase: 0.3),
        )],
    ),
    solvers: { "oil": Lbm((spacing: "1 mm", step: RelaxationTime(0.8))) },
    stages: [(name: "run", end: For("26 s"))],
    outputs: [(every: Time("26 s"), write: Table(path: "series.csv", probes: ["largest_speed"]))],
)"#;

/// A shaft that starts to turn in a tank.
const ANNULUS: &str = r#"Scene(
    version: 1,
    dimension: Plane,
    fluid: (
        size: ["60 mm", "60 mm"],
        viscosity: "1e-4 m^2/s",
        obstacles: [
            (name: "shaft", shape: Ball(centre: ["30 mm", "30 mm"], radius: "12 mm")),
            (name: "tank", shape: Hole(Ball(centre: ["30 mm", "30 mm"], radius: "28 mm"))),
        ],
    ),
    solvers: { "oil": Lbm((spacing: "1 mm", step: RelaxationTime(0.8))) },
    stages: [
        (name: "rest", end: For("0.05 s")),
        (name: "turning", end: For("4 s"), changes: [ObstacleSpin(obstacle: "shaft", spin: ["0.5 rad/s"])]),
    ],
    outputs: [(every: Time("0.05 s"), write: Table(path: "series.csv", probes: [
        "torque_on_shaft_z", "torque_on_tank_z", "largest_speed",
    ]))],
)"#;

/// A closed box under a lid without jumps, shaken, of which a wall slips and another starts to move.
const CAVITY: &str = r#"Scene(
    version: 1,
    dimension: Plane,
    fluid: (
        size: ["40 mm", "40 mm"],
        viscosity: "1e-5 m^2/s",
        faces: (
            left: NavierSlip(length: "2 mm"), right: Wall, bottom: NavierSlip(length: "1 mm", velocity: ["1 mm/s", 0]),
            top: RegularisedLid(["10 mm/s", 0]),
        ),
        forces: [
            (acceleration: ["1e-3 m/s^2", 0], in_space: Sine(along: Y, wavelength: "40 mm"),
                in_time: Oscillating(frequency: "3 Hz", phase: 0.5)),
            (acceleration: [0, "1e-3 m/s^2"], in_time: Oscillating(frequency: "1 Hz")),
        ],
    ),
    solvers: { "oil": Lbm((spacing: "1 mm", step: Mach(0.1))) },
    stages: [
        (name: "lid", end: For("0.5 s")),
        (name: "both", end: For("1 s"), changes: [FaceVelocity(face: "right", velocity: [0, "12 mm/s"])]),
    ],
    snapshot_every: "50 ms",
    outputs: [(every: Time("20 ms"), write: Table(path: "series.csv", probes: ["largest_speed", "kinetic_energy"]))],
)"#;

fn scratch(name: &str, scene: &str) -> Scratch {
    let scratch = Scratch::new(name);
    fs::write(scratch.path("stir.ron"), scene).unwrap();
    scratch
}

fn last_row(scratch: &Scratch) -> Vec<f64> {
    granular_io::read_table(&scratch.path("run/series.csv")).unwrap().rows.last().unwrap().clone()
}

#[test]
fn a_force_in_space_drives_kolmogorov_flow() {
    let scratch = scratch("kolmogorov", KOLMOGOROV);
    scratch.granular(&["run", "stir.ron", "--quiet", "--out", "run"]).expect(0);
    // a / (nu k^2), seen at the centres of cells; a wave of 32 cells is 0.5 % off at second order.
    let k = std::f64::consts::TAU / 32e-3;
    let expected = 1e-3 / (1e-5 * k * k);
    let found = last_row(&scratch)[1];
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

#[test]
fn a_shaft_that_a_stage_turns_bears_the_torque_of_an_annulus() {
    let scratch = scratch("annulus", ANNULUS);
    scratch.granular(&["run", "stir.ron", "--quiet", "--out", "run"]).expect(0);
    let (inner, outer): (f64, f64) = (12e-3, 28e-3);
    let b = 0.5 * (inner * outer).powi(2) / (outer * outer - inner * inner);
    let torque = 4.0 * std::f64::consts::PI * 1000.0 * 1e-4 * b;
    let row = last_row(&scratch);
    assert!(
        (-row[1] / torque - 1.0).abs() < 0.02 && (row[2] / torque - 1.0).abs() < 0.02,
        "{row:?} {torque}"
    );
    let table = granular_io::read_table(&scratch.path("run/series.csv")).unwrap();
    assert_eq!(table.rows[1][3], 0.0, "nothing moves before");
    // The step is one for the speed to come.
    scratch.granular(&["check", "stir.ron", "--set", "solvers.oil.step=Mach(0.05)"]).expect(0);
}

#[test]
fn a_stirred_cavity_has_the_same_bits_after_an_interruption() {
    let scratch = scratch("cavity", CAVITY);
    for stage in ["0", "1"] {
        let edit = format!("stages.{stage}.end=For(\"3 s\")");
        let start = |out: &str| scratch.start(&["run", "stir.ron", "--quiet", "--out", out, "--set", &edit]);
        start("whole").wait().expect(0);
        let rows =
            || fs::read_to_string(scratch.path("part/series.csv")).map_or(0, |text| text.lines().count());
        let outcome = start("part").interrupt_when(|| rows() >= 45);
        // A fast machine may be done before the signal comes.
        if outcome.code != Some(0) {
            outcome.expect(130);
            scratch.granular(&["resume", "part", "--threads", "3"]).expect(0);
        }
        assert_same_run(&scratch.path("whole"), &scratch.path("part"));
        assert_eq!(
            facts(&scratch.path("part"))["stages"][1]["ended"],
            facts(&scratch.path("whole"))["stages"][1]["ended"]
        );
        for folder in ["whole", "part"] {
            fs::remove_dir_all(scratch.path(folder)).unwrap();
        }
    }
}

/// What is set, and parts of the message.
const REFUSED: &[(&str, &[&str])] = &[
    ("fluid.forces.0.acceleration=[1]", &["`fluid.forces.0.acceleration` is a list of 1", "2 values"]),
    ("fluid.forces.0.in_space.along=Z", &["`fluid.forces.0.in_space.along` is Z", "X or Y in the plane"]),
    ("fluid.forces.0.in_space.wavelength=0", &["`fluid.forces.0.in_space.wavelength` is 0", "above 0"]),
    ("fluid.forces.1.in_time.frequency=0", &["`fluid.forces.1.in_time.frequency` is 0", "Steady"]),
    ("fluid.faces.left.length=\"-1 mm\"", &["`fluid.faces.left.length` is -0.001 m", "0 or more"]),
    ("fluid.faces.bottom.velocity=[1]", &["`fluid.faces.bottom.velocity` is a list of 1"]),
    ("fluid.faces.top=RegularisedLid([0, \"1 mm/s\"])", &["velocity of a wall", "a velocity along the wall"]),
    (
        "stages.1.changes.0.face=roof",
        &["`stages.1.changes.0.face` is `roof`", "one of left, right, bottom, top"],
    ),
    ("stages.1.changes.0.velocity=[1, 0]", &["`stages.1.changes.0.velocity`", "a velocity along the wall"]),
    (
        "fluid.faces.right=FreeSlip",
        &["`stages.1.changes.0.face` is FreeSlip", "NavierSlip and Inflow have a velocity"],
    ),
    (
        "stages.0.changes=[ObstacleSpin(obstacle: \"disk\", spin: [1])]",
        &["`stages.0.changes.0.obstacle` is `disk`"],
    ),
    (
        "stages.0.changes=[StopMotion]",
        &["`stages.0.changes.0`", "FaceVelocity, ObstacleSpin or Gravity", "Dem or Mpm does"],
    ),
    (
        "fluid.obstacles=[(name: \"a\", shape: Hole(Ball(centre: [0, 0], radius: 0)))]",
        &["`fluid.obstacles.0.shape.Hole.radius` is 0 m"],
    ),
    (
        "fluid.obstacles=[(name: \"a\", shape: Hole(Ball(centre: [1, 0], radius: 0.1)))]",
        &["covered by obstacles everywhere"],
    ),
    (
        "fluid.obstacles=[(name: \"a\", shape: Hole(Ball(centre: [0, 0], radius: 1)), path: Steady([0, 0]))]",
        &["`fluid.obstacles.0.path`", "a path of a Ball", "a spin instead"],
    ),
];

#[test]
fn a_stirred_fluid_that_makes_no_sense_is_refused_by_name() {
    let scratch = scratch("stir-refused", CAVITY);
    for (edit, parts) in REFUSED {
        scratch.granular(&["check", "stir.ron", "--set", edit]).expect(2).says(parts);
    }
    // A wall that starts later counts for the Mach number.
    let fast = "stages.1.changes.0.velocity=[0, \"100 m/s\"]";
    let slow = ["check", "stir.ron", "--set", fast, "--set", "solvers.oil.step=RelaxationTime(0.8)"];
    scratch.granular(&slow).expect(3).says(&["Mach number is"]);
}
