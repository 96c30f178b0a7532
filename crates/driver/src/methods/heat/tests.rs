//! What the toy gets from the driver for its folder and its line.

use crate::check;
use crate::failure::Failure;
use crate::run::{self, Interrupt};
use crate::scene_file::SceneText;
use crate::sweep::{Plan, Request, Work};
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

const SCENE: &str = r#"Scene(
    version: 1,
    dimension: Plane,
    stages: [(name: "cool", end: For("2 s"))],
    solvers: { "plate": Heat((size: "0.1 m", cells: 32, diffusivity: 1e-4)) },
    outputs: [
        (every: Time("0.1 s"), write: Table(path: "series.csv", probes: ["largest_temperature"])),
        (every: Time("1 s"), of: "plate", write: Fields(path: "plate", fields: ["temperature"])),
        (every: Time("1 s"), write: Profile(path: "line.csv", from: ["0 m", "0.05 m"], to: ["0.1 m", "0.05 m"], points: 5, fields: ["temperature"])),
    ],
    figures: [
        Series(path: "cooling", table: "series.csv", columns: ["largest_temperature"]),
        Map(path: "map", fields: "plate", color: "temperature", stage: "cool", times: [0, 1]),
    ],
)"#;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("granular-heat-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn scene(edits: &[&str]) -> SceneText {
    let mut text = SceneText::new("scene.ron", SCENE);
    edits.iter().for_each(|edit| text.set(edit).unwrap());
    text
}

fn done(text: &SceneText, out: &Path) -> serde_json::Value {
    run::run(text, out, false, true, &Interrupt::default()).unwrap()
}

#[test]
fn a_check_knows_its_limit_and_its_keys() {
    let report = check::check(&scene(&[])).unwrap();
    assert!(report.problems.is_empty());
    assert_eq!(report.limits.steps[0].name, "diffusion");
    assert_eq!(report.to_json()["size"], 1024);
    let Err(Failure::Scene(problems)) = check::check(&scene(&["solvers.plate.cells=2"])) else { panic!() };
    assert!(problems[0].to_string().contains("solvers.plate.cells"), "{}", problems[0]);
    let walls = scene(&["walls=[Floor(material: \"wood\")]"]);
    let Err(Failure::Scene(problems)) = check::check(&walls) else { panic!() };
    assert!(
        problems[0].to_string().contains("`plate` is Heat, which does not use it; Dem or Mpm does"),
        "{}",
        problems[0]
    );
}

#[test]
fn a_run_leaves_tables_fields_and_figures_and_cools_as_it_must() {
    let folder = Folder::new("run");
    let facts = done(&scene(&[]), &folder.0.join("out"));
    assert_eq!(facts["exit"], "done");
    // Each step takes the same share of a wave that the grid can carry.
    let turn = TAU / 32.0;
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let factor = 1e-4 * number(&facts["stages"][0]["dt"]) / (0.1_f64 / 32.0).powi(2);
    let left = (1.0 - factor * 2.0 * (1.0 - turn.cos())).powf(number(&facts["steps"]));
    let (found, expected) = (number(&facts["metrics"]["largest_temperature"]), (0.5 * turn).cos() * left);
    assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
    for file in ["series.csv", "line.csv", "plate.pvd", "plate_000002.vti", "cooling.svg", "map.png"] {
        assert!(folder.0.join("out").join(file).is_file(), "{file}");
    }
    assert_eq!(run::plot(&folder.0.join("out")).unwrap().paths.len(), 2);
}

#[test]
fn an_interrupted_run_is_resumed_to_the_same_bits() {
    let folder = Folder::new("resume");
    let text = scene(&["stages.0.end=For(\"40 s\")", "outputs.0.every=Steps(1)"]);
    let whole = done(&text, &folder.0.join("whole"));
    let (part, interrupt) = (folder.0.join("part"), Interrupt::default());
    let (raised, series) = (interrupt.raised.clone(), part.join("series.csv"));
    let waiting = std::thread::spawn(move || {
        while fs::read_to_string(&series).map_or(0, |text| text.lines().count()) < 5 {
            std::thread::yield_now();
        }
        raised.store(true, Ordering::Relaxed);
    });
    let stopped = run::run(&text, &part, false, true, &interrupt);
    waiting.join().unwrap();
    // A run that was faster than the signal is done.
    assert!(stopped.is_ok() || matches!(stopped, Err(Failure::Interrupted { .. })));
    if stopped.is_err() {
        run::resume(&part, true, &Interrupt::default()).unwrap();
    }
    let facts: serde_json::Value = serde_json::from_slice(&fs::read(part.join("run.json")).unwrap()).unwrap();
    assert_eq!(facts["state_hash"], whole["state_hash"]);
    let read = |run: &str| fs::read(folder.0.join(run).join("series.csv")).unwrap();
    assert_eq!(read("part"), read("whole"));
}

#[test]
fn a_sweep_collects_what_it_measures() {
    let folder = Folder::new("sweep");
    let scene = folder.0.join("scene.ron");
    fs::write(&scene, SCENE).unwrap();
    let plan =
        Plan::of(&Request { scene, set: vec!["solvers.plate.diffusivity=1e-4,2e-4".to_owned()] }).unwrap();
    let outcome = plan.work(&folder.0.join("sweep"), Work::default(), &Interrupt::default()).unwrap();
    let of = |k: usize| outcome.report["runs"][k]["measures"]["largest_temperature [K]"].as_f64().unwrap();
    assert!((of(1) / of(0).powi(2) - 1.0).abs() < 0.02, "{} {}", of(0), of(1));
}

#[test]
fn solvers_that_nothing_joins_run_in_folders_of_their_own_and_are_resumed() {
    let two = "solvers={ \"cold\": Heat((size: \"0.1 m\", cells: 16, diffusivity: 1e-4)), \
               \"warm\": Heat((size: \"0.1 m\", cells: 16, diffusivity: 2e-4)) }";
    let text = scene(&[two, "outputs.1.of=warm"]);
    let folder = Folder::new("several");
    let whole = done(&text, &folder.0.join("whole"));
    let of = |name: &str| whole["metrics"][name].as_f64().unwrap();
    let ratio = of("warm.largest_temperature") / of("cold.largest_temperature").powi(2);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    assert!(
        folder.0.join("whole/cold/series.csv").is_file() && folder.0.join("whole/warm/map.svg").is_file()
    );
    assert!(!folder.0.join("whole/cold/map.svg").exists());
    // Told to stop before its first step, it goes on with all parts.
    let interrupt = Interrupt::default();
    interrupt.raised.store(true, Ordering::Relaxed);
    let part = folder.0.join("part");
    assert!(matches!(run::run(&text, &part, false, true, &interrupt), Err(Failure::Interrupted { .. })));
    let resumed = run::resume(&part, true, &Interrupt::default()).unwrap();
    assert_eq!((&resumed["state_hash"], &resumed["exit"]), (&whole["state_hash"], &"done".into()));
    assert_eq!(run::plot(&part).unwrap().paths.len(), 3);
    let slash = scene(&[&two.replace("cold", "a/b"), "outputs.1.of=warm"]);
    let refused = run::run(&slash, &folder.0.join("slash"), false, true, &Interrupt::default()).unwrap_err();
    assert!(refused.to_string().contains("`a/b`"), "{refused}");
}
