//! Sweeps: grids of runs that are killed, taken up again, and collected into one table.

use crate::support::{Scratch, facts, results};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

/// Four short runs of the small scene.
const SWEEP: &[&str] = &[
    "sweep",
    "small.ron",
    "--threads",
    "1",
    "--set",
    "figures=[]",
    "--set",
    "snapshot_every=20 ms",
    "--set",
    "stages.1.end=For(\"50 ms\")",
    "--set",
    "materials.glass.friction=0.3,0.5",
    "--set",
    "gravity=[0, -9.81], [0, -1.62]",
];

/// Three runs of a millisecond, of which the second is refused.
const FAILING: &[&str] = &[
    "sweep",
    "small.ron",
    "--set",
    "figures=[]",
    "--set",
    "stages.1.end=For(\"1 ms\")",
    "--set",
    "stages.0.end=For(\"1 ms\")",
    "--set",
    "solvers.grains.time_step=1e-6,1,2e-6",
];

fn table(folder: &Path) -> String {
    fs::read_to_string(folder.join("table.csv")).unwrap()
}

fn runs(report: &Value) -> &Vec<Value> {
    report["runs"].as_array().unwrap()
}

/// When each run last wrote its `run.json`.
fn times(folder: &Path) -> Vec<SystemTime> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path().join("run.json"));
    let mut times: Vec<_> = entries.filter_map(|path| fs::metadata(path).ok()?.modified().ok()).collect();
    times.sort_unstable();
    times
}

#[test]
fn a_sweep_killed_again_and_again_ends_in_the_same_table() {
    let scratch = Scratch::with_scene("sweep");
    let whole = scratch.granular(&[SWEEP, &["--out", "whole", "--json", "-q"]].concat()).expect(0).json();
    let rows = table(&scratch.path("whole"));
    let lines: Vec<&str> = rows.lines().collect();
    assert_eq!(lines.len(), 5, "{rows}");
    let head = "run,materials.glass.friction,gravity,exit,front [m],height [m],";
    assert!(lines[0].starts_with(head) && lines[0].contains(",runout [1],"), "{rows}");
    assert!(lines[0].contains(",series:time [s],series:front [m],"), "{rows}");
    assert!(lines[4].contains(",0.5,\"[0, -1.62]\",done,"), "{rows}");
    assert!(runs(&whole).iter().all(|run| run["exit"] == "done"), "{whole}");
    assert_eq!(runs(&whole)[1]["values"]["gravity"], "[0, -1.62]");

    draws_figures(&scratch);

    let seed = SystemTime::UNIX_EPOCH.elapsed().map_or(1, |since| since.as_nanos() as u64);
    println!("moments from seed {seed}");
    let mut killed = 0;
    for kill in 0..4 {
        let mut run = scratch.start(&[SWEEP, &["--out", "killed", "--jobs", "2", "-q"]].concat());
        std::thread::sleep(Duration::from_millis(30 + (seed >> (8 * kill)) % 200));
        if run.is_running() {
            killed += 1;
            run.signal("KILL");
            run.wait();
        }
    }
    println!("{killed} kills");
    scratch.granular(&[SWEEP, &["--out", "killed", "-q"]].concat()).expect(0);
    assert_eq!(table(&scratch.path("killed")), rows);
    for run in runs(&whole) {
        let folder = run["folder"].as_str().unwrap();
        let [one, other] = ["whole", "killed"].map(|sweep| scratch.path(sweep).join(folder));
        assert_eq!(facts(&one)["state_hash"], facts(&other)["state_hash"]);
        assert!(results(&one) == results(&other), "files of {folder} differ");
    }
}

/// Figures of the sweep in the folder `whole`.
fn draws_figures(scratch: &Scratch) {
    let plot = |more: &[&str]| scratch.granular(&[&["plot", "whole"], more].concat());
    fs::write(scratch.path("laws.csv"), "law,x,y\n\"Theirs, 2004\",0.3,0.4\n\"Theirs, 2004\",0.5,0.2\n")
        .unwrap();
    assert_eq!(plot(&["--reference", "laws.csv"]).expect(0).out, "whole/runout.svg, whole/runout.png\n");
    let figure = fs::read_to_string(scratch.path("whole/runout.svg")).unwrap();
    for part in [
        "materials.glass.friction",
        "runout [1]",
        "this sweep",
        "Theirs, 2004",
        "means over all values of gravity, up to 2 runs",
    ] {
        assert!(figure.contains(part), "`{part}` is not in the figure");
    }
    plot(&["--y", "series:front [m]", "--by", "gravity", "--log"]).expect(0);
    let figure = fs::read_to_string(scratch.path("whole/series_front__m.svg")).unwrap();
    assert!(figure.contains("gravity = [0, -1.62]") && !figure.contains("means over"), "{figure}");
    // Each run has its own aspect ratio: four points, no means.
    plot(&["--x", "aspect_ratio", "--y", "height"]).expect(0);
    let figure = fs::read_to_string(scratch.path("whole/height.svg")).unwrap();
    let has = |part: &str| figure.contains(part);
    assert!(has("aspect_ratio [1]") && has("height [m]") && !has("means over"), "{figure}");
    // One figure of two sweeps, which are the same here; a law through four points.
    let two = ["plot", "whole", "whole", "--x", "aspect_ratio", "--fit", "0.1..2"];
    assert_eq!(scratch.granular(&two).expect(0).out, "whole/runout.svg, whole/runout.png\n");
    let figure = fs::read_to_string(scratch.path("whole/runout.svg")).unwrap();
    assert!(figure.contains("whole: fitted ") && figure.contains("means over up to 2 runs"), "{figure}");
    scratch
        .granular(&["plot", "whole", "--fit", "2..1"])
        .expect(2)
        .says(&["the smaller first, such as 4..10"]);
    let wrong: &[(&[&str], &[&str])] = &[
        (&["--fit", "1..2"], &["--fit: `this sweep` has no three points there"]),
        (
            &["--x", "friction"],
            &["--x: `friction` is not an axis", "allowed: materials.glass.friction, gravity"],
        ),
        (&["--y", "run-out"], &["--y: no run", "number `run-out`; allowed: ", ", runout [1], "]),
        (&["--x", "gravity"], &["--x: `gravity` is `[0, -9.81]` in a run"]),
        (&["--reference", "nothing.csv"], &["nothing.csv"]),
        (&["--reference", "small.ron"], &["small.ron:2: `", "a label, x and y are expected"]),
    ];
    for (arguments, parts) in wrong {
        plot(arguments).expect(5).says(parts);
    }
    let run = fs::read_dir(scratch.path("whole")).unwrap().map(|entry| entry.unwrap().path());
    let run = run.into_iter().find(|path| path.join("run.json").is_file()).unwrap();
    let of_run = scratch.granular(&["plot", run.to_str().unwrap(), "--log"]);
    of_run.expect(5).says(&["holds no sweep", "are for sweeps"]);
}

#[test]
fn a_stopped_sweep_says_how_to_go_on_and_does_nothing_twice() {
    let scratch = Scratch::with_scene("sweep-int");
    let start = [SWEEP, &["--out", "sweep"]].concat();
    let run = scratch.start(&start);
    let folder = scratch.path("sweep");
    let begun = || {
        let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
        entries.into_iter().any(|entry| entry.path().join("snapshots").is_dir())
    };
    while !begun() {
        std::thread::sleep(Duration::from_millis(1));
    }
    run.signal("TERM");
    run.wait().expect(143).says(&["interrupted: the state is saved", "the same command"]);
    assert!(table(&folder).contains(",waiting\n"), "{}", table(&folder));
    let forecast = scratch.granular(&[&start[..], &["--dry-run"]].concat()).expect(0).out;
    assert!(forecast.contains("4 runs: 3 would start, 1 resume, 0 fail, 0 stay; at most"), "{forecast}");
    let rest = scratch.granular(&start).expect(0).says(&["[1/4] run 0 (", ": resumes", "resuming at"]);
    assert!(rest.out.contains("4 of 4 runs are done"), "{}", rest.out);
    let before = times(&folder);
    assert_eq!(before.len(), 4);
    scratch.granular(&start).expect(0).says(&["4 of 4 runs are done or failed before"]);
    assert_eq!(times(&folder), before, "runs that are done are not run again");
    // A larger grid around it has the same folders for the same scenes.
    let mut wider = start.clone();
    for word in &mut wider {
        if word.starts_with("materials") {
            *word = "materials.glass.friction=0.2,0.3,0.5";
        }
    }
    let forecast = scratch.granular(&[&wider[..], &["--dry-run"]].concat()).expect(0).out;
    assert!(forecast.contains("6 runs: 2 would start, 0 resume, 0 fail, 4 stay; at most"), "{forecast}");
}

#[test]
fn what_fails_is_reported_and_not_tried_again_unasked() {
    let scratch = Scratch::with_scene("sweep-fail");
    let start = [FAILING, &["--out", "sweep"]].concat();
    let said = ["1 of 3 runs failed", "run 1 (solvers.grains.time_step=1; ", "refused: small.ron", "--retry"];
    let forecast = scratch.granular(&[&start[..], &["--dry-run"]].concat()).expect(3).says(&said[..3]);
    assert!(forecast.out.contains("2 would start, 0 resume, 1 fail, 0 stay"), "{}", forecast.out);
    assert!(!scratch.path("sweep").exists());
    // The refused run does not keep the others from being done.
    let outcome = scratch.granular(&[&start[..], &["--json"]].concat()).expect(3).says(&said);
    let report = outcome.json();
    assert_eq!(runs(&report)[1]["exit"], "refused");
    assert!(runs(&report)[1]["reason"].as_str().unwrap().contains("allowed: at most"), "{report}");
    let rows = table(&scratch.path("sweep"));
    assert_eq!(rows.matches(",done,").count(), 2, "{rows}");
    assert_eq!(rows.matches(",refused,").count(), 1, "{rows}");
    scratch.granular(&start).expect(3).says(&said).says(&["3 of 3 runs are done or failed before"]);
    let forecast = scratch.granular(&[&start[..], &["--dry-run"]].concat()).expect(0);
    assert!(forecast.out.contains("stay: failed before (--retry tries again)"), "{}", forecast.out);
    let retried = scratch.granular(&[&start[..], &["--retry"]].concat()).expect(3).says(&said);
    retried.says(&["2 of 3 runs are done or failed before", "run 1 (solvers.grains.time_step=1; "]);
    assert_eq!(table(&scratch.path("sweep")), rows);
}

#[test]
fn a_wrong_axis_is_told_before_anything_runs() {
    let scratch = Scratch::with_scene("sweep-bad");
    let cases: &[(&[&str], &[&str])] = &[
        (&[], &["--set", "needs two values", "for example"]),
        (&["--set", "sample.seed=3"], &["nothing varies"]),
        (&["--set", "sample.seed"], &["--set sample.seed", "a path, `=` and values"]),
        (&["--set", "sample.seed=1,1"], &["`1` is given twice"]),
        (&["--set", "sample.seed=1,2", "--set", "sample.seed=3"], &["set twice", "at once"]),
        (&["--set", "sample.sead=1,2"], &["unknown key `sead`", "did you mean `seed`?"]),
        (&["--set", "sample.seed=1,x"], &["sample.seed=x"]),
        (&["--set", "snapshot_every=1 s,\"1 s\""], &["are the same run"]),
        (&["--set", "materials.glass.friction=0.1..0.5"], &["needs a count", "`0.2..1:5` for five"]),
        (&["--set", "sample.seed=1,2", "--only", "2"], &["there is no run 2; allowed: 0 to 1"]),
        (&["--set", "sample.seed=1,2", "--only", "1", "--dry-run"], &["cannot be used with"]),
    ];
    for (arguments, parts) in cases {
        let outcome = scratch.granular(&[&["sweep", "small.ron", "--out", "sweep"], *arguments].concat());
        outcome.expect(2).says(parts);
    }
    assert!(!scratch.path("sweep").exists());
    fs::create_dir(scratch.path("run")).unwrap();
    fs::write(scratch.path("run/run.json"), "{}").unwrap();
    let into_run = ["sweep", "small.ron", "--set", "sample.seed=1,2", "--out", "run"];
    scratch.granular(&into_run).expect(5).says(&["holds a run", "--out"]);
}

#[test]
fn a_slurm_script_has_a_task_per_run_and_what_it_starts_is_collected() {
    let scratch = Scratch::with_scene("sweep-slurm");
    let mut start = FAILING.to_vec();
    start.pop();
    start.extend(["solvers.grains.time_step=1e-6,2e-6", "--set", "title=it's a test"]);
    scratch.granular(&[&start[..], &["--slurm", "sweep.sh", "--threads", "1"]].concat()).expect(0);
    let script = fs::read_to_string(scratch.path("sweep.sh")).unwrap();
    let parts = [
        "#!/bin/bash\n",
        "\n#SBATCH --array=0-1\n",
        "\n#SBATCH --cpus-per-task=1\n",
        "\n#SBATCH --signal=B:TERM@120\n",
        " --set 'stages.1.end=For(\"1 ms\")' ",
        " --set solvers.grains.time_step=1e-6,2e-6 --set 'title=it'\\''s a test' --out sweeps/small \\\n",
        "--only \"$SLURM_ARRAY_TASK_ID\" --threads 1 --quiet\n",
    ];
    for part in parts {
        assert!(script.contains(part), "`{part}` is not in\n{script}");
    }
    let again = [&start[..], &["--slurm", "sweep.sh"]].concat();
    scratch.granular(&again).expect(5).says(&["sweep.sh", "name another file"]);
    // The tasks as Slurm would start them, in any order.
    for task in ["1", "0"] {
        let mut command = std::process::Command::new("bash");
        command.arg("sweep.sh").env("SLURM_ARRAY_TASK_ID", task);
        command.env("GRANULAR", env!("CARGO_BIN_EXE_granular"));
        scratch.start_command(command).wait().expect(0);
    }
    let folder = scratch.path("sweeps/small");
    assert!(!folder.join("table.csv").exists());
    let before = times(&folder);
    scratch.granular(&start).expect(0).says(&["2 of 2 runs are done or failed before"]);
    assert_eq!(times(&folder), before);
    assert_eq!(table(&folder).matches(",done,").count(), 2);
}

#[cfg(unix)]
#[test]
fn two_sweeps_in_one_folder_share_the_work() {
    let scratch = Scratch::with_scene("sweep-two");
    let start = [SWEEP, &["--out", "sweep"]].concat();
    let (one, two) = (scratch.start(&start), scratch.start(&start));
    let (one, two) = (one.wait().expect(0), two.wait().expect(0));
    let done = |outcome: &crate::support::Outcome| outcome.err.matches(": done after").count();
    assert_eq!(done(&one) + done(&two), 4, "each run was done once:\n{}\n{}", one.err, two.err);
    scratch.granular(&start).expect(0).says(&["4 of 4 runs are done"]);
    assert_eq!(table(&scratch.path("sweep")).matches(",done,").count(), 4);
}

#[test]
fn a_run_that_a_guard_stopped_starts_anew_when_it_is_tried_again() {
    let scratch = Scratch::new("sweep-guard");
    fs::write(scratch.path("flow.ron"), include_str!("flow.ron")).unwrap();
    let start = ["sweep", "flow.ron", "--set", "gravity=[20, 0], [21, 0]", "--out", "sweep"];
    let said = ["2 of 2 runs failed", "run 0 (gravity=[20, 0]; ", "stopped: ", "density over that at rest"];
    scratch.granular(&start).expect(4).says(&said);
    let rows = table(&scratch.path("sweep"));
    assert_eq!(rows.matches(",stopped\n").count(), 2, "{rows}");
    let forecast = scratch.granular(&[&start[..], &["--dry-run", "--retry"]].concat()).expect(0).out;
    assert!(forecast.contains("2 runs: 2 would start, 0 resume"), "{forecast}");
    let retried = scratch.granular(&[&start[..], &["--only", "1", "--retry"]].concat()).expect(4);
    retried.says(&["1 of 1 runs failed", "run 1 (gravity=[21, 0]; ", ": starts", "--retry"]);
    scratch
        .granular(&["plot", "sweep", "--x", "height"])
        .expect(5)
        .says(&["--x: `height` is not an axis", "gravity"]);
}
