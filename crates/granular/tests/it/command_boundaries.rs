//! Scenes with moving walls, meshes, held grains and grains that come and go: runs, resumes, and messages.

use crate::support::Scratch;
use std::fs;

/// Spheres that rain on a pyramid from a file and on held grains, between sides of which one shakes and one presses.
pub(crate) const SPACE: &str = r#"Scene(
    version: 1, dimension: Space, gravity: [0.0, 0.0, -9.81],
    materials: { "glass": (density: "2650 kg/m^3", normal_stiffness: "1e4 N/m", restitution: 0.5, friction: 0.4) },
    walls: [
        Mesh(name: "pyramid", file: "pyramid.stl", unit: "1 mm", at: ["0 mm", "0 mm", "1 mm"], material: "glass"),
        HeldGrains(name: "bumps", low: ["-10 mm", "-10 mm", "0 mm"], high: ["10 mm", "10 mm", "0 mm"],
            diameter: "2 mm", spacing: "1.9 mm", scatter: "0.1 mm", material: "glass"),
        Plane(name: "left", point: ["-10 mm", "0 mm", "0 mm"], normal: [1, 0, 0], material: "glass",
            moves: Oscillate(amplitude: ["0.2 mm", "0 mm", "0 mm"], frequency: "50 Hz")),
        Plane(name: "right", point: ["10 mm", "0 mm", "0 mm"], normal: [-1, 0, 0], material: "glass",
            moves: Servo(pressure: "10 Pa", area: 4e-4, mass: "1 g", max_speed: "0.05 m/s")),
    ],
    inlets: [(name: "rain", low: ["-6 mm", "-6 mm", "8 mm"], high: ["6 mm", "6 mm", "16 mm"], rate: 2000, number: 60,
        grading: EqualMass(min: "1.5 mm", max: "2 mm"), material: "glass", velocity: ["0 m/s", "0 m/s", "-0.3 m/s"])],
    outlets: [Outside(low: ["-12 mm", "-12 mm", "-5 mm"], high: ["12 mm", "12 mm", "30 mm"])],
    stages: [
        (name: "fill", end: For("0.04 s")),
        (name: "press", end: For("0.02 s"), changes: [Start("right"), Halt("left")]),
    ],
    solvers: { "grains": Dem((steps_per_contact: 50)) },
    outputs: [(every: Time("2 ms"), write: Table(path: "series.csv", probes: [
        "grains", "inserted", "not_placed", "removed", "wall_work", "energy_residual", "energy_exchanged",
        "force_on_pyramid_z", "force_on_bumps_z", "force_on_right_x",
    ]))],
)"#;

pub(crate) const PYRAMID: &str = "solid pyramid\n\
    facet normal 0 0 0\nouter loop\nvertex -4 -4 0\nvertex 4 -4 0\nvertex 0 0 4\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 4 -4 0\nvertex 4 4 0\nvertex 0 0 4\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 4 4 0\nvertex -4 4 0\nvertex 0 0 4\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex -4 4 0\nvertex -4 -4 0\nvertex 0 0 4\nendloop\nendfacet\n\
    endsolid pyramid\n";

fn folder() -> Scratch {
    let scratch = Scratch::new("boundaries");
    fs::write(scratch.path("scene.ron"), SPACE).unwrap();
    fs::write(scratch.path("pyramid.stl"), PYRAMID).unwrap();
    scratch
}

/// A column of a table, by the start of its title.
fn column(scratch: &Scratch, title: &str) -> Vec<f64> {
    let text = fs::read_to_string(scratch.path("out/series.csv")).unwrap();
    let mut lines = text.lines();
    let place = lines.next().unwrap().split(',').position(|name| name.starts_with(title)).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}

#[test]
fn a_scene_with_all_boundaries_runs_and_its_books_balance() {
    let scratch = folder();
    scratch.granular(&["run", "scene.ron", "--out", "out", "--quiet"]).expect(0);
    let last = |title: &str| *column(&scratch, title).last().unwrap();
    assert_eq!(last("inserted") + last("not_placed"), 60.0);
    assert_eq!(last("grains"), last("inserted") - last("removed"));
    assert!(last("inserted") > 20.0);
    for wall in ["force_on_pyramid_z", "force_on_bumps_z"] {
        assert!(column(&scratch, wall).iter().any(|&force| force < 0.0), "{wall}");
    }
    let worst = column(&scratch, "energy_residual").iter().fold(0.0, |worst: f64, &r| worst.max(r.abs()));
    assert!(worst < 1e-3 * last("energy_exchanged"), "{worst:e} of {:e}", last("energy_exchanged"));
}

#[test]
fn what_cannot_be_is_refused_with_the_place() {
    let cases: &[(&str, &str, &[&str])] = &[
        (
            "pyramid.stl",
            "cone.stl",
            &["`walls.0.file` is `cone.stl`", "the path counts from the folder of the scene"],
        ),
        ("spacing: \"1.9 mm\"", "spacing: \"0 mm\"", &["`walls.1` is", "positive diameter and spacing"]),
        ("pressure: \"10 Pa\", area: 4e-4", "pressure: \"10 Pa\"", &["`walls.3.moves`", "area: .."]),
        ("frequency: \"50 Hz\"", "frequency: \"-50 Hz\"", &["`walls.2.moves`", "frequency of wall `left`"]),
        ("[\"0.2 mm\", \"0 mm\", \"0 mm\"]", "[\"0.2 mm\"]", &["`walls.2.moves.amplitude`", "3 values"]),
        ("rate: 2000", "rate: 0", &["`inlets.0` is", "rate of inlet `rain`"]),
        (
            "high: [\"6 mm\", \"6 mm\", \"16 mm\"]",
            "high: [\"6 mm\", \"6 mm\", \"9 mm\"]",
            &["extent of inlet `rain`"],
        ),
        (
            "Start(\"right\")",
            "Start(\"rigth\")",
            &["`stages.1.changes.0`", "left, right, rain", "did you mean `right`?"],
        ),
        ("Start(\"right\")", "Start(\"bumps\")", &["`stages.1.changes.0`", "left, right, rain"]),
        (
            "low: [\"-12 mm\", \"-12 mm\", \"-5 mm\"]",
            "low: [\"20 mm\", \"-12 mm\", \"-5 mm\"]",
            &["`outlets.0`"],
        ),
    ];
    for (from, to, parts) in cases {
        let scratch = folder();
        assert!(SPACE.contains(from), "{from}");
        fs::write(scratch.path("scene.ron"), SPACE.replace(from, to)).unwrap();
        let message = scratch.granular(&["check", "scene.ron"]).expect(2).err;
        for part in *parts {
            assert!(message.contains(part), "{to}: no {part} in\n{message}");
        }
    }
    let plane = "Scene(version: 1, dimension: Plane, materials: { \"a\": (normal_stiffness: 1e5, restitution: 0.5, friction: 0.5) },
        sample: Grains([(position: [0.0, 0.1], radius: 0.001, material: \"a\")]),
        walls: [Mesh(name: \"m\", file: \"pyramid.stl\", material: \"a\")],
        stages: [(name: \"s\", end: For(1.0))], solvers: { \"grains\": Dem(()) })";
    let scratch = folder();
    fs::write(scratch.path("scene.ron"), plane).unwrap();
    let message = scratch.granular(&["check", "scene.ron"]).expect(2).err;
    assert!(message.contains("in the plane a Chain does the same"), "{message}");
}
