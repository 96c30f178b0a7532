//! Runs that are interrupted or killed, and taken up again: the same bits as without.

use crate::support::{Scratch, assert_same_run, facts, snapshots};
use crate::{command_boundaries, command_sample};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

/// A run of about a second with many snapshots.
const RUN: &[&str] = &[
    "run",
    "small.ron",
    "--quiet",
    "--set",
    "snapshot_every=50 ms",
    "--set",
    "stages.1.end=For(\"0.4 s\")",
    "--set",
    "figures.2.times=[0]",
];

/// Random moments, from the clock: each run of the tests tries others. The seed is printed.
struct Moments(u64);

impl Moments {
    fn new() -> Self {
        let seed = SystemTime::UNIX_EPOCH.elapsed().map_or(1, |since| since.as_nanos() as u64 | 1);
        println!("moments from seed {seed}");
        Self(seed)
    }

    fn between(&mut self, low: u64, high: u64) -> Duration {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        Duration::from_millis(low + self.0 % (high - low))
    }
}

fn uninterrupted(scratch: &Scratch) {
    scratch.granular(&[RUN, &["--out", "whole"]].concat()).expect(0);
}

#[test]
fn an_interrupted_run_is_resumed_to_the_same_bits() {
    let scratch = Scratch::with_scene("interrupt");
    uninterrupted(&scratch);
    let mut moments = Moments::new();
    for (signal, code, threads) in [("INT", 130, "1"), ("TERM", 143, "3")] {
        let run = scratch.start(&[RUN, &["--json", "--out", signal]].concat());
        // Signals before the handlers are in place end the process as they always do.
        while snapshots(&scratch.path(signal)).is_empty() {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(moments.between(0, 150));
        run.signal(signal);
        let outcome = run.wait().expect(code);
        let help = format!("continue with `granular resume {signal}`");
        let outcome = outcome.says(&["interrupted: the state is saved", &help]);
        assert_eq!(outcome.json()["exit"], code);
        assert_eq!(facts(&scratch.path(signal))["exit"], "interrupted");
        // Also with another number of threads than before.
        let resumed = scratch.granular(&["resume", signal, "--threads", threads]).expect(0);
        resumed.says(&["resuming at", "collapse: "]);
        assert_same_run(&scratch.path("whole"), &scratch.path(signal));
    }
}

/// Scenes that are killed, with all files that they read: grains from the start, none at the start and walls from a mesh, and
/// grains from a sample.
fn killed_scenes(scratch: &Scratch) -> Vec<Vec<&'static str>> {
    fs::write(scratch.path("pyramid.ron"), command_boundaries::SPACE).unwrap();
    fs::write(scratch.path("pyramid.stl"), command_boundaries::PYRAMID).unwrap();
    fs::write(scratch.path("prepare.ron"), command_sample::PREPARE).unwrap();
    fs::write(scratch.path("from-sample.ron"), command_sample::COLLAPSE).unwrap();
    scratch.granular(&["run", "prepare.ron", "--quiet", "--out", "prepared", "--threads", "1"]).expect(0);
    let often = ["--quiet", "--set", "snapshot_every=20 ms"];
    let from_sample = ["--set", "stages.1.end=For(\"0.2 s\")", "--set", "outputs.0.every=Time(\"1 ms\")"];
    vec![
        RUN.to_vec(),
        [&["run", "pyramid.ron"], &often[..]].concat(),
        [&["run", "from-sample.ron"], &often[..], &from_sample].concat(),
    ]
}

/// Kills a run at a random moment, takes it up again, kills that, and so on. `GRANULAR_KILLS` is
/// the number of kills, 12 by default; `scripts/kills` makes a long trial. A third of the kills fall into the first moments of a
/// process, in which the folder of the run is made and its files are read.
#[test]
fn a_run_killed_again_and_again_ends_in_the_same_bits() {
    let kills = std::env::var("GRANULAR_KILLS").map_or(12, |count| count.parse().expect("a number of kills"));
    let scratch = Scratch::with_scene("kill");
    let scenes = killed_scenes(&scratch);
    let mut moments = Moments::new();
    let mut counts = Kills::default();
    for (k, scene) in scenes.iter().enumerate() {
        let whole = format!("whole{k}");
        let begun = Instant::now();
        scratch.granular(&[&scene[..], &["--out", &whole]].concat()).expect(0);
        // Half the time of a whole run at most, so that runs get to their end also on a busy machine.
        let latest = begun.elapsed().as_millis().max(200) as u64 / 2;
        let share = (k + 1) * kills / scenes.len();
        while counts.killed < share || counts.runs <= k {
            killed_to_the_end(&scratch, scene, (share, latest), &mut moments, &mut counts);
            assert_same_run(&scratch.path(&whole), &scratch.path("killed"));
            fs::remove_dir_all(scratch.path("killed")).unwrap();
        }
    }
    let Kills { killed, early, unborn, runs } = counts;
    println!(
        "{killed} kills, {early} of them before the first snapshot, {unborn} before the scene was in its folder; {runs} runs, all \
         ended in the same bits"
    );
}

/// What was killed so far.
#[derive(Default)]
struct Kills {
    killed: usize,
    /// Before the first snapshot.
    early: usize,
    /// Before there was anything to resume.
    unborn: usize,
    runs: usize,
}

/// Runs a scene to its end in the folder `killed`, with kills on the way until there were `most` in all.
fn killed_to_the_end(
    scratch: &Scratch,
    scene: &[&str],
    (most, latest): (usize, u64),
    moments: &mut Moments,
    counts: &mut Kills,
) {
    let folder = scratch.path("killed");
    let start = [scene, &["--out", "killed"]].concat();
    let mut run = scratch.start(&start);
    counts.runs += 1;
    loop {
        let latest = if moments.between(0, 3).is_zero() { 40 } else { latest };
        std::thread::sleep(moments.between(0, latest));
        if counts.killed >= most || !run.is_running() {
            run.wait().expect(0);
            return;
        }
        run.signal("KILL");
        let code = run.wait().code;
        if code == Some(0) {
            // It had just ended.
            return;
        }
        assert_eq!(code, None, "the signal ended it");
        counts.killed += 1;
        counts.early += usize::from(snapshots(&folder).is_empty());
        // The scene comes last: with it there is all that the run needs, without it the same command starts anew.
        let begun = folder.join("scene.ron").is_file();
        counts.unborn += usize::from(!begun);
        if begun && facts(&folder)["exit"] == "done" {
            return;
        }
        run = scratch.start(if begun { &["resume", "killed", "--quiet"] } else { &start });
    }
}

/// What a kill leaves between the mark of a run and its scene: the inputs, and no way to resume, but none in the way either.
#[test]
fn a_run_that_was_killed_before_its_scene_starts_again() {
    let scratch = Scratch::with_scene("unborn");
    let folder = scratch.path("unborn");
    let short = ["--set", "stages.0.end=For(\"5 ms\")", "--set", "stages.1.end=For(\"5 ms\")"];
    let run = |more: &[&str]| {
        scratch.granular(&[&["run", "small.ron", "-q", "--out", "unborn"], &short[..], more].concat())
    };
    fs::create_dir_all(folder.join("meshes")).unwrap();
    fs::write(folder.join("meshes/0.stl"), "half of it").unwrap();
    fs::write(folder.join("initial-sample.csv.tmp"), "half of it").unwrap();
    // Without the mark of this program these files are somebody's.
    for foreign in [
        None,
        Some("{}"),
        Some("{ \"exit\": 0 }"),
        Some("{ \"exit\": \"done\", \"model\": \"mine\" }"),
        Some("what"),
    ] {
        if let Some(facts) = foreign {
            fs::write(folder.join("run.json"), facts).unwrap();
        }
        for force in [&[][..], &["--force"]] {
            run(force).expect(5).says(&["unborn: is not empty", "left alone, also with"]);
        }
        assert!(folder.join("meshes/0.stl").is_file());
    }
    fs::write(folder.join("run.json"), "{ \"program\": \"granular\", \"exit\": \"running\" }").unwrap();
    let resumed = scratch.granular(&["resume", "unborn"]).expect(5);
    resumed.says(&["stopped before it began", "start it again with `granular run`"]);
    run(&[]).expect(0);
    assert!(!folder.join("meshes").exists());
    // A run whose scene is gone may hold results: it is replaced when that is asked for.
    fs::remove_file(folder.join("scene.ron")).unwrap();
    run(&[]).expect(5).says(&["holds a run already"]);
    scratch.granular(&["resume", "unborn"]).expect(5).says(&["`granular run` and --force"]);
    run(&["--force"]).expect(0);
}

/// A signal ends the command within a second also while a sample is built; without, it waits for the first step.
#[test]
fn a_signal_ends_the_building_of_a_sample() {
    let scratch = Scratch::with_scene("building");
    // Half a minute of building: disks of very different sizes in one pile.
    let large = ["--set", "sample.extent=Grains(400000)", "--set", "sample.packing=Ballistic", "--set"];
    let wide = "sample.grading=EqualMass(min: \"0.1 mm\", max: \"60 mm\")";
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let run = scratch.start(
            &[&["run", "small.ron", "--json", "--threads", "1", "--out", "out"], &large[..], &[wide]]
                .concat(),
        );
        std::thread::sleep(Duration::from_millis(1500));
        let sent = Instant::now();
        run.signal(signal);
        let outcome = run
            .wait()
            .expect(code)
            .says(&["interrupted: there was nothing to save", "the same command again"]);
        assert!(sent.elapsed() < Duration::from_secs(5), "{:?}", sent.elapsed());
        assert_eq!(outcome.json()["exit"], code);
        assert!(!scratch.path("out").exists());
    }
}

/// What a kill within a write leaves: part of a temporary file, and perhaps (on file systems that
/// order a rename before its data) a truncated file in place of a whole one.
#[test]
fn half_written_files_do_not_matter() {
    let scratch = Scratch::with_scene("half");
    uninterrupted(&scratch);
    let run = scratch.start(&[RUN, &["--out", "half"]].concat());
    let folder = scratch.path("half");
    while snapshots(&folder).len() < 2 {
        std::thread::sleep(Duration::from_millis(1));
    }
    run.signal("TERM");
    run.wait().expect(143);
    let newest = snapshots(&folder).pop().unwrap();
    let bytes = fs::read(&newest).unwrap();
    let temporary = |path: &Path| format!("{}.tmp", path.display());
    fs::write(temporary(&newest), &bytes[..bytes.len() / 3]).unwrap();
    fs::write(temporary(&folder.join("run.json")), "{ \"exit\":").unwrap();
    fs::write(&newest, &bytes[..bytes.len() / 2]).unwrap();
    // A row and a frame that were under way belong to what is done again.
    let mut table = fs::read(folder.join("series.csv")).unwrap();
    table.extend_from_slice(b"0.1,0.2");
    fs::write(folder.join("series.csv"), table).unwrap();
    let resumed = scratch.granular(&["resume", "half"]).expect(0);
    resumed.says(&["warning: snapshot file", "it is damaged", "an older snapshot is used"]);
    assert_same_run(&scratch.path("whole"), &folder);
}

/// A run that was killed before its first snapshot starts again.
#[test]
fn a_run_without_snapshots_starts_again() {
    let scratch = Scratch::with_scene("early");
    let short = ["--set", "stages.0.end=For(\"5 ms\")", "--set", "stages.1.end=For(\"5 ms\")"];
    let run = |out| scratch.granular(&[&["run", "small.ron", "-q", "--out", out], &short[..]].concat());
    run("whole").expect(0);
    run("early").expect(0);
    let folder = scratch.path("early");
    for entry in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
        let keep = ["scene.ron", "run.json"].iter().any(|name| entry.ends_with(name));
        if entry.is_dir() {
            fs::remove_dir_all(entry).unwrap();
        } else if !keep {
            fs::remove_file(entry).unwrap();
        }
    }
    fs::write(folder.join("run.json"), "{ \"exit\": \"running\" }").unwrap();
    let resumed = scratch.granular(&["resume", "early"]).expect(0);
    resumed.says(&["no snapshot was taken yet: the run starts again"]);
    assert_same_run(&scratch.path("whole"), &folder);
}

/// How often the wall clock asks for snapshots changes nothing, however short the interval: it
/// once moved the end of a stage that waits for rest, and stopped the run loop for ever.
#[test]
fn the_interval_of_snapshots_does_not_matter() {
    let scratch = Scratch::with_scene("interval");
    let run = |out: &str, interval: &str, settle: &str| {
        let (every, settle) = (format!("snapshot_every={interval}"), format!("stages.0.end={settle}"));
        let edits = ["--set", &every, "--set", &settle, "--set", "stages.1.end=For(\"1 ms\")"];
        let start = ["run", "small.ron", "-q", "--set", "figures=[]", "--out", out];
        scratch.granular(&[&start[..], &edits].concat()).expect(0);
        let facts = facts(&scratch.path(out));
        (facts["stages"].clone(), facts["state_hash"].clone())
    };
    let rest = "Quiet(kinetic_over_potential: 1e-4, within: \"0.05 s\")";
    let never = run("never", "1e30 s", rest);
    assert_eq!(never.0[0]["ended"], "at rest");
    assert_eq!(run("often", "3 ms", rest), never);
    let short = "For(\"1 ms\")";
    assert_eq!(run("always", "1e-12 s", short), run("seldom", "1 min", short));
}
