//! Grains averaged on grids, and tracks of grains, by the command.

use crate::support::{SMALL, Scratch, assert_same_run, snapshots};
use granular_io::vtk::{read_vti, read_vtp};
use granular_io::{Collection, read_table};
use std::f64::consts::PI;
use std::fs;

/// The outputs of the small column, replaced.
const OUTPUTS: &str = r#"
    outputs: [
        (every: Time("10 ms"), write: Fields(path: "grains", fields: ["radius", "id"])),
        (every: Time("10 ms"), write: Fields(path: "coarse/all", fields: ["density", "momentum", "solid_fraction",
            "pressure"], grid: (from: ["-10 mm", "-10 mm"], to: ["80 mm", "40 mm"], spacing: "2.5 mm"))),
        (every: Time("10 ms"), write: Profile(path: "upright.csv", from: ["5 mm", "0 mm"], to: ["5 mm", "9 mm"],
            points: 4, fields: ["density", "velocity"],
            grid: (from: ["-5 mm", "-5 mm"], to: ["20 mm", "25 mm"], spacing: "2.5 mm", width: 2))),
        (every: Time("5 ms"), write: Tracks(path: "tracks.csv", grains: Every(40),
            fields: ["velocity", "spin", "force", "stress"])),
        (every: Time("5 ms"), write: Tracks(path: "two.csv", grains: Ids([7, 3]), fields: [])),
    ],
    figures: [
        Map(path: "map", fields: "coarse/all", color: "solid_fraction", stage: "collapse", times: [0, 0.02]),
        Map(path: "speed", fields: "coarse/all", color: "momentum", stage: "collapse", times: [0]),
    ],
)"#;

const RUN: &[&str] =
    &["run", "coarse.ron", "-q", "--set", "stages.1.end=For(\"40 ms\")", "--set", "snapshot_every=20 ms"];

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let start = SMALL.find("    outputs:").unwrap();
    fs::write(scratch.path("coarse.ron"), format!("{}{}", &SMALL[..start], &OUTPUTS[1..])).unwrap();
    scratch
}

#[test]
fn averages_hold_the_mass_of_the_grains_and_tracks_follow_them() {
    let scratch = scratch("coarse");
    scratch.granular(&[RUN, &["--out", "run"]].concat()).expect(0);
    let list = |name: &str| Collection::open(&scratch.path("run").join(name)).unwrap();
    let (points, grids) = (list("grains.pvd"), list("coarse/all.pvd"));
    assert!(grids.len() > 4 && grids.len() == points.len());
    let radii = read_vtp(&scratch.path("run").join(&points.entries()[0].1)).unwrap();
    let radii = radii.magnitude("radius").unwrap();
    let mass: f64 = radii.iter().map(|radius| 2650.0 * PI * radius * radius).sum();
    for (time, file) in grids.entries() {
        let grid = read_vti(&scratch.path("run/coarse").join(file)).unwrap();
        assert_eq!((grid.time, grid.cells), (*time, [36, 20, 1]));
        let found: f64 = grid.magnitude("density").unwrap().iter().map(|d| d * 2.5e-3 * 2.5e-3).sum();
        assert!((found / mass - 1.0).abs() < 1e-12, "{found} of {mass}");
        let largest = grid.magnitude("solid_fraction").unwrap().into_iter().fold(0.0, f64::max);
        assert!((0.7..0.95).contains(&largest), "{largest}");
    }
    let table = read_table(&scratch.path("run/tracks.csv")).unwrap();
    let head: Vec<&str> = table.columns.iter().map(|(name, _)| name.as_str()).collect();
    let expected = "time id x y velocity_x velocity_y spin force_x force_y stress_xx stress_yy stress_xy";
    assert_eq!(head, expected.split(' ').collect::<Vec<_>>());
    assert_eq!(table.unit("force_x"), Some("N"));
    let grains = radii.len();
    let looks = read_table(&scratch.path("run/two.csv")).unwrap();
    assert_eq!(looks.column("id").unwrap()[..4], [3.0, 7.0, 3.0, 7.0]);
    assert_eq!(table.rows.len(), looks.rows.len() / 2 * grains.div_ceil(40));
    let upright = read_table(&scratch.path("run/upright.csv")).unwrap();
    let head: Vec<&str> = upright.columns.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(head, ["time", "distance", "x", "y", "density", "velocity_x", "velocity_y"]);
    assert!(upright.column("density").unwrap().iter().any(|density| *density > 1000.0));
    for figure in ["map.svg", "map.png", "speed.png"] {
        assert!(fs::metadata(scratch.path("run").join(figure)).unwrap().len() > 1000, "{figure}");
    }
}

#[test]
fn averages_and_tracks_go_on_after_an_interrupt() {
    let scratch = scratch("coarse-resume");
    scratch.granular(&[RUN, &["--out", "whole"]].concat()).expect(0);
    let run = scratch.start(&[RUN, &["--out", "part"]].concat());
    while snapshots(&scratch.path("part")).len() < 2 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    run.signal("KILL");
    // A fast machine may be done before the signal comes.
    if run.wait().code != Some(0) {
        scratch.granular(&["resume", "part", "-q", "--threads", "3"]).expect(0);
    }
    assert_same_run(&scratch.path("whole"), &scratch.path("part"));
}

/// What is set, and parts of the message.
const REFUSED: &[(&str, &[&str])] = &[
    (
        "outputs.1.write.grid.from=[0]",
        &["`outputs.1.write.grid.from` is a list of 1", "2 values, one per axis"],
    ),
    ("outputs.1.write.grid.to=[-1, 1]", &["`outputs.1.write.grid.to`", "extent of the grid"]),
    ("outputs.1.write.grid.spacing=0", &["`outputs.1.write.grid.spacing` is 0", "positive"]),
    ("outputs.1.write.grid.spacing=\"1 um\"", &["`outputs.1.write.grid.spacing`", "at most 1e8"]),
    ("outputs.1.write.grid.width=9", &["`outputs.1.write.grid.width` is 9", "1 to 8 cells"]),
    ("outputs.1.write.fields=[\"radius\"]", &["`radius`, which nothing shows", "inertial_number"]),
    ("outputs.2.write.to=[\"5 mm\", \"90 mm\"]", &["outside the grid", "a line in the grid"]),
    ("outputs.3.write.grains=Every(0)", &["`outputs.3.write.grains` is 0", "1 or more"]),
    ("outputs.4.write.grains=Ids([])", &["`outputs.4.write.grains` is empty"]),
    ("outputs.4.write.grains=Ids([1, 100000])", &["`outputs.4.write.grains` is 100000", "from 0 on"]),
    ("outputs.3.write.fields=[\"front\"]", &["`front`, which nothing shows"]),
];

#[test]
fn grids_and_tracks_that_make_no_sense_are_refused_by_name() {
    let scratch = scratch("coarse-refused");
    for (edit, parts) in REFUSED {
        scratch.granular(&["run", "coarse.ron", "--out", "out", "--set", edit]).expect(2).says(parts);
        assert!(!scratch.path("out").exists(), "{edit} left a folder");
    }
    // What can be asked for is listed.
    let listed = scratch.granular(&["info", "coarse.ron"]).expect(0).out;
    for part in ["Grid     inertial_number", "Field    force", "Number   front"] {
        assert!(listed.contains(part), "{part} is not in\n{listed}");
    }
}
