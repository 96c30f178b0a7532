//! Runs that are interrupted or killed, and taken up again: the same bits as without.

use crate::support::{Scratch, assert_same_run, facts, snapshots};
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
        let help = format!("go on with `granular resume {signal}`");
        let outcome = outcome.says(&["interrupted: the state is saved", &help]);
        assert_eq!(outcome.json()["exit"], code);
        assert_eq!(facts(&scratch.path(signal))["exit"], "interrupted");
        // Also with another number of threads than before.
        let resumed = scratch.granular(&["resume", signal, "--threads", threads]).expect(0);
        resumed.says(&["resuming at", "collapse: "]);
        assert_same_run(&scratch.path("whole"), &scratch.path(signal));
    }
}

/// Kills a run at a random moment, takes it up again, kills that, and so on. `GRANULAR_KILLS` is
/// the number of kills, 8 by default; `scripts/kills` makes a long trial.
#[test]
fn a_run_killed_again_and_again_ends_in_the_same_bits() {
    let kills = std::env::var("GRANULAR_KILLS").map_or(8, |count| count.parse().expect("a number of kills"));
    let scratch = Scratch::with_scene("kill");
    let begun = Instant::now();
    uninterrupted(&scratch);
    // Half the time of a whole run at most, so that runs get to their end also on a busy machine.
    let latest = begun.elapsed().as_millis().max(200) as u64 / 2;
    let folder = scratch.path("killed");
    let mut moments = Moments::new();
    let (mut killed, mut early, mut runs) = (0, 0, 0);
    while killed < kills || runs == 0 {
        runs += 1;
        let start = [RUN, &["--out", "killed"]].concat();
        let mut run = scratch.start(&start);
        loop {
            std::thread::sleep(moments.between(0, latest));
            if killed == kills || !run.is_running() {
                run.wait().expect(0);
                break;
            }
            run.signal("KILL");
            let code = run.wait().code;
            if code == Some(0) {
                // It had just ended.
                break;
            }
            assert_eq!(code, None, "the signal ended it");
            killed += 1;
            early += usize::from(snapshots(&folder).is_empty());
            // Killed before it began, the folder holds no run yet.
            let begun = folder.join("run.json").is_file() && folder.join("scene.ron").is_file();
            if begun && facts(&folder)["exit"] == "done" {
                break;
            }
            let again = [&start[..], &["--force"]].concat();
            run = scratch.start(if begun { &["resume", "killed", "--quiet"] } else { &again });
        }
        assert_same_run(&scratch.path("whole"), &folder);
        fs::remove_dir_all(&folder).unwrap();
    }
    println!(
        "{killed} kills, {early} of them before the first snapshot; {runs} runs, all ended in the same bits"
    );
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
