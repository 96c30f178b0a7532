//! Samples that one scene saves and another takes; cylinders in space.

use crate::support::Scratch;
use granular_io::read_table;
use std::fs;

/// A deposit that is shaken and saved.
pub(crate) const PREPARE: &str = r#"Scene(
    version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "glass": (density: 2650, normal_stiffness: "1e5 N/m", restitution: 0.5, friction: 0.3) },
    sample: Column(extent: Grains(150), aspect_ratio: 1.0, grading: EqualMass(min: "0.9 mm", max: "1.4 mm"),
        material: "glass", packing: Loose, seed: 2),
    walls: [Floor(material: "glass"), Left(material: "glass"), Right(material: "glass")],
    stages: [
        (name: "deposit", end: For("0.12 s")),
        (name: "shake", end: For("0.03 s"), changes: [
            Shake(acceleration: ["4 m/s^2", "15 m/s^2"], from: "60 Hz", to: "300 Hz", pass: "10 ms"),
        ]),
        (name: "pack", end: Packed(solid_fraction: 0.999, within: "5 ms")),
        (name: "rest", end: For("0.03 s"), save: "saved/sample.csv"),
    ],
    solvers: { "grains": Dem(()) },
    outputs: [(every: Time("1 ms"), write: Table(path: "series.csv", probes: ["kinetic_energy", "solid_fraction", "energy_residual",
        "homogeneity", "median_diameter"]))],
)"#;

/// The same grains behind a gate.
pub(crate) const COLLAPSE: &str = r#"Scene(
    version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "glass": (density: 2650, normal_stiffness: "1e5 N/m", restitution: 0.5, friction: 0.3) },
    sample: File(path: "prepared/saved/sample.csv"),
    walls: [Floor(material: "glass"), Left(material: "glass"), Gate(material: "glass", opens: "collapse")],
    stages: [(name: "settle", end: For("5 ms")), (name: "collapse", end: For("60 ms"))],
    solvers: { "grains": Dem(()) },
    outputs: [(every: Time("5 ms"), write: Table(path: "series.csv", probes: ["front", "height"]))],
)"#;

fn column(run: &Scratch, path: &str, name: &str) -> Vec<f64> {
    read_table(&run.path(path)).unwrap().column(name).unwrap()
}

#[test]
fn a_saved_sample_collapses_in_another_scene() {
    let scratch = Scratch::new("samples");
    fs::write(scratch.path("prepare.ron"), PREPARE).unwrap();
    fs::write(scratch.path("collapse.ron"), COLLAPSE).unwrap();
    scratch
        .granular(&["run", "prepare.ron", "--out", "prepared", "--threads", "1"])
        .expect(0)
        .says(&["not packed within the time"]);
    let table = "prepared/series.csv";
    let (time, kinetic) = (column(&scratch, table, "time"), column(&scratch, table, "kinetic_energy"));
    let largest = |from: f64, to: f64| {
        let within = time.iter().zip(&kinetic).filter(|(t, _)| (from..to).contains(*t));
        within.map(|(_, energy)| *energy).fold(0.0, f64::max)
    };
    // Shaken from 0.12 to 0.15 s; not before and not after.
    assert!(
        largest(0.12, 0.15) > 10.0 * largest(0.11, 0.12),
        "{} {}",
        largest(0.12, 0.15),
        largest(0.11, 0.12)
    );
    assert!(largest(0.18, 0.19) < 0.2 * largest(0.12, 0.15));
    let solid = column(&scratch, table, "solid_fraction");
    assert!(solid.last().is_some_and(|found| (0.7..0.9).contains(found)), "{:?}", solid.last());
    // The table says where the bulk begins to exist: grains in flight have none.
    assert!(solid[0].is_nan());

    scratch.granular(&["run", "collapse.ron", "--out", "fallen", "-q", "--threads", "1"]).expect(0);
    let sample = |path: &str| fs::read(scratch.path(path)).unwrap();
    assert!(sample("prepared/saved/sample.csv") == sample("fallen/initial-sample.csv"));
    let front = column(&scratch, "fallen/series.csv", "front");
    let farthest = front.iter().copied().fold(0.0, f64::max);
    assert!(farthest > 1.3 * front[0], "{front:?}");
    // The folder holds what it needs: the sample may go.
    fs::remove_dir_all(scratch.path("prepared")).unwrap();
    scratch.granular(&["check", "fallen/scene.ron"]).expect(0);
    scratch
        .granular(&["run", "collapse.ron", "--out", "again"])
        .expect(2)
        .says(&["cannot be read", "sample.path"]);
}

/// Half a cylinder behind a tube that lifts.
const LIFTED: &str = r#"Scene(
    version: 1, dimension: Space, gravity: [0.0, 0.0, -9.81],
    materials: { "glass": (density: 2650, normal_stiffness: "1e4 N/m", restitution: 0.5, friction: 0.3, rolling_friction: 0.1) },
    sample: Cylinder(extent: Width("20 mm"), aspect_ratio: 0.8, half: true, grading: Single("2 mm"), material: "glass",
        packing: Loose),
    walls: [
        Floor(material: "glass"), Sides(material: "glass"),
        Tube(name: "tube", from: ["0 mm", "0 mm", "-1 mm"], to: ["0 mm", "0 mm", "40 mm"], radius: "10 mm",
            material: "glass", moves: Steady(["0 m/s", "0 m/s", "0.5 m/s"])),
    ],
    stages: [
        (name: "settle", end: For("80 ms")),
        (name: "lift", end: For("100 ms"), changes: [Start("tube")]),
    ],
    solvers: { "grains": Dem(()) },
    outputs: [(every: Time("2 ms"), write: Table(path: "series.csv", probes: ["radial_front", "height", "force_on_front_y",
        "force_on_tube_z"]))],
)"#;

#[test]
fn half_a_cylinder_stays_in_its_tube_until_that_lifts() {
    let scratch = Scratch::new("lifted");
    fs::write(scratch.path("lifted.ron"), LIFTED).unwrap();
    scratch.granular(&["run", "lifted.ron", "--out", "lifted", "-q", "--threads", "1"]).expect(0);
    let front = column(&scratch, "lifted/series.csv", "radial_front");
    assert!(front[..40].iter().all(|front| *front < 10.01e-3), "{front:?}");
    assert!(front.last().unwrap() > &10.5e-3, "{front:?}");
    // It leans on its flat side, and the tube carries no load any more.
    assert!(column(&scratch, "lifted/series.csv", "force_on_front_y")[39] < 0.0);
    assert_eq!(column(&scratch, "lifted/series.csv", "force_on_tube_z").last(), Some(&0.0));
    // In the plane there is none, and a whole one has no sides.
    for (edit, expected) in [
        ("sample.half=false", "a column in space or half a cylinder"),
        ("sample.packing=Ballistic", "Loose or Hexagonal in space"),
        ("sample.extent=Width(\"1 mm\")", "too narrow a sample"),
        ("walls=[Right(material: \"glass\")]", "a Gate beside a cylinder"),
    ] {
        scratch.granular(&["check", "lifted.ron", "--set", edit]).expect(2).says(&[expected]);
    }
}
