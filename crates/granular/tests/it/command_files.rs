//! Run folders belong to one process at a time, and hold all files that their run reads.

use crate::support::{Scratch, facts, snapshots};
use std::fs;
use std::path::Path;
use std::time::Duration;

/// A sphere that falls on two triangles of a file.
const FALL: &str = r#"Scene(
    version: 1, dimension: Space, gravity: [0.0, 0.0, -9.81],
    materials: { "glass": (density: 2650, normal_stiffness: "1e4 N/m", restitution: 0.5, friction: 0.4) },
    sample: Grains([(position: [0.0, 0.0, 0.003], radius: 0.002, material: "glass")]),
    walls: [Mesh(name: "plate", file: "shapes/plate.stl", unit: "1 mm", material: "glass")],
    stages: [(name: "fall", end: For("60 ms"))],
    solvers: { "grains": Dem(()) },
    outputs: [(every: Time("2 ms"), write: Table(path: "series.csv", probes: ["height", "force_on_plate_z"]))],
)"#;

/// A square of two triangles in this height.
fn plate(height: f64) -> String {
    let corner = |x: i32, y: i32| format!("vertex {x} {y} {height}\n");
    let triangle = |corners: [String; 3]| {
        format!("facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n", corners.concat())
    };
    let one = triangle([corner(-9, -9), corner(9, -9), corner(9, 9)]);
    let other = triangle([corner(-9, -9), corner(9, 9), corner(-9, 9)]);
    format!("solid plate\n{one}{other}endsolid plate\n")
}

/// The scene in a folder of its own, apart from where the command runs.
fn with_mesh(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    fs::create_dir_all(scratch.path("scenes/shapes")).unwrap();
    fs::write(scratch.path("scenes/fall.ron"), FALL).unwrap();
    fs::write(scratch.path("scenes/shapes/plate.stl"), plate(0.0)).unwrap();
    scratch
}

#[cfg(unix)]
#[test]
fn two_processes_never_write_to_one_run_folder() {
    let scratch = Scratch::with_scene("lock");
    let long = ["run", "small.ron", "--out", "run", "-q", "--set", "stages.1.end=For(\"100 s\")"];
    let run = scratch.start(&long);
    while snapshots(&scratch.path("run")).is_empty() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let said = ["run: another `granular` process runs in this folder", "wait until", "--out"];
    scratch.granular(&["resume", "run"]).expect(5).says(&said);
    scratch.granular(&["run", "small.ron", "--out", "run", "--force"]).expect(5).says(&said);
    // Looking is free, and what runs goes on undisturbed.
    scratch.granular(&["info", "run"]).expect(0);
    assert_eq!(facts(&scratch.path("run"))["exit"], "running");
    // The lock goes with the process, however that ends.
    run.signal("KILL");
    run.wait();
    let resumed = scratch.start(&["resume", "run", "-q"]);
    std::thread::sleep(Duration::from_millis(50));
    resumed.signal("TERM");
    resumed.wait();
    scratch.granular(&["run", "small.ron", "--out", "run", "-q", "--force"]).expect(0);
    assert_eq!(facts(&scratch.path("run"))["exit"], "done");
    // No output may take the name.
    let taken = ["check", "small.ron", "--set", "outputs.0.write.path=lock"];
    scratch.granular(&taken).expect(2).says(&["which the run itself writes"]);
}

#[test]
fn meshes_count_from_the_folder_of_the_scene_and_are_kept_with_the_run() {
    let scratch = with_mesh("mesh");
    scratch.granular(&["run", "scenes/fall.ron", "--out", "fallen", "-q"]).expect(0);
    let stl = |path: &str| fs::read(scratch.path(path)).unwrap();
    assert!(stl("fallen/meshes/0.stl") == stl("scenes/shapes/plate.stl"));
    let force = fs::read_to_string(scratch.path("fallen/series.csv")).unwrap();
    assert!(!force.lines().next_back().unwrap().ends_with(",0"), "the sphere lies on the plate:\n{force}");
    // The folder holds what it needs: the file may go.
    fs::remove_dir_all(scratch.path("scenes/shapes")).unwrap();
    scratch.granular(&["run", "fallen/scene.ron", "--out", "again", "-q"]).expect(0);
    assert_eq!(facts(&scratch.path("again"))["state_hash"], facts(&scratch.path("fallen"))["state_hash"]);
    let lacks = ["`walls.0.file`", "scenes/shapes/plate.stl", "counts from the folder of the scene"];
    scratch.granular(&["check", "scenes/fall.ron"]).expect(2).says(&lacks);
}

/// Names of the folders of a sweep.
fn folders(sweep: &Path) -> Vec<String> {
    let table = fs::read_to_string(sweep.join("table.csv")).unwrap();
    table.lines().skip(1).map(|line| line.split(',').next().unwrap().to_owned()).collect()
}

#[test]
fn a_sweep_runs_again_when_a_file_of_its_scene_has_changed() {
    let scratch = with_mesh("sweep-files");
    let sweep = ["sweep", "scenes/fall.ron", "--set", "materials.glass.friction=0.2,0.4", "--out", "sweep"];
    scratch.granular(&sweep).expect(0);
    let before = folders(&scratch.path("sweep"));
    scratch.granular(&sweep).expect(0).says(&["2 of 2 runs are done"]);
    fs::write(scratch.path("scenes/shapes/plate.stl"), plate(0.5)).unwrap();
    let forecast = scratch.granular(&[&sweep[..], &["--dry-run"]].concat()).expect(0).out;
    assert!(forecast.contains("2 runs: 2 would start, 0 resume, 0 fail, 0 stay"), "{forecast}");
    scratch.granular(&sweep).expect(0);
    let after = folders(&scratch.path("sweep"));
    assert!(before.iter().all(|folder| !after.contains(folder)), "{before:?} {after:?}");
    // What was is there again with the old file.
    fs::write(scratch.path("scenes/shapes/plate.stl"), plate(0.0)).unwrap();
    scratch.granular(&sweep).expect(0).says(&["2 of 2 runs are done"]);
    assert_eq!(folders(&scratch.path("sweep")), before);
    // Without the file each run is told, and is another one when it is there.
    fs::remove_file(scratch.path("scenes/shapes/plate.stl")).unwrap();
    scratch.granular(&sweep).expect(2).says(&["2 of 2 runs failed", "walls.0.file"]);
}
