//! Disks that are full, and files that may not grow: an error that names the file, a folder that
//! can be resumed when there is room again.

use crate::support::{Outcome, Scratch, assert_same_run, facts, snapshots};
use std::path::Path;
use std::process::{Command, Stdio};

const RUN: &[&str] =
    &["run", "small.ron", "--set", "stages.1.end=For(\"50 ms\")", "--set", "figures.2.times=[0]"];

/// A file system of a fixed size, as far as this machine lets us mount one.
struct SmallDisk<'a>(&'a Path);

impl<'a> SmallDisk<'a> {
    fn mount(folder: &'a Path, size: &str) -> Option<Self> {
        std::fs::create_dir(folder).unwrap();
        Self::call(folder, &["mount", "-t", "tmpfs", "-o", size, "tmpfs"]).then_some(Self(folder))
    }

    fn grow(&self, size: &str) {
        assert!(Self::call(self.0, &["mount", "-o", &format!("remount,{size}")]));
    }

    fn call(folder: &Path, words: &[&str]) -> bool {
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).arg(folder).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    }
}

impl Drop for SmallDisk<'_> {
    fn drop(&mut self) {
        Self::call(self.0, &["umount"]);
    }
}

fn whole(scratch: &Scratch) {
    scratch.granular(&[RUN, &["--quiet", "--out", "whole"]].concat()).expect(0);
}

/// Every snapshot that is there can be read, and the run is not said to be done.
fn assert_resumable(folder: &Path) {
    for snapshot in snapshots(folder) {
        granular_io::read_snapshot(&snapshot).unwrap();
    }
    assert_ne!(facts(folder)["exit"], "done");
}

#[test]
fn a_full_disk_stops_the_run_and_room_lets_it_go_on() {
    let scratch = Scratch::with_scene("full");
    let folder = scratch.path("disk");
    let Some(disk) = SmallDisk::mount(&folder, "size=200k") else {
        println!("this user may not mount a small disk; the test of the largest file stands in");
        return;
    };
    whole(&scratch);
    let full = scratch.granular(&[RUN, &["--out", "disk/run"]].concat()).expect(5);
    println!("{}", full.err);
    full.says(&["disk/run/", "could not write: No space left", "granular resume disk/run"]);
    let run = folder.join("run");
    assert!(!snapshots(&run).is_empty());
    assert_resumable(&run);
    // As long as nothing changed it fails again, and harms nothing.
    scratch.granular(&["resume", "disk/run"]).expect(5).says(&["No space left"]);
    assert_resumable(&run);
    disk.grow("size=20m");
    scratch.granular(&["resume", "disk/run"]).expect(0);
    assert_same_run(&scratch.path("whole"), &run);
}

/// Runs with a limit on the size of files, in KiB.
fn limited(scratch: &Scratch, kib: u32, arguments: &str) -> Outcome {
    let program = env!("CARGO_BIN_EXE_granular");
    let mut shell = Command::new("bash");
    shell.args(["-c", &format!("ulimit -f {kib}; exec {program} {arguments}")]);
    scratch.start_command(shell).wait()
}

#[test]
fn a_file_that_may_not_grow_stops_the_run_at_any_place() {
    let scratch = Scratch::with_scene("limit");
    whole(&scratch);
    let words: Vec<String> = RUN.iter().map(|word| format!("'{word}'")).collect();
    let run = |out: &str| format!("{} --out {out}", words.join(" "));
    // The scene itself, the first snapshot, a figure.
    for (kib, file) in [(1, "scene.ron"), (4, "snapshot-"), (40, "runout.")] {
        let out = format!("limit{kib}");
        let stopped = limited(&scratch, kib, &run(&out)).expect(5);
        println!("{kib} KiB: {}", stopped.err);
        stopped.says(&[file, "File too large"]);
        let folder = scratch.path(&out);
        if folder.join("scene.ron").exists() {
            assert_resumable(&folder);
            scratch.granular(&["resume", &out]).expect(0);
        } else {
            scratch.granular(&[RUN, &["--force", "--out", &out]].concat()).expect(0);
        }
        assert_same_run(&scratch.path("whole"), &folder);
    }
}

#[test]
fn results_that_cannot_be_printed_are_a_failure() {
    let scratch = Scratch::with_scene("print");
    let program = env!("CARGO_BIN_EXE_granular");
    let mut shell = Command::new("bash");
    shell.args(["-c", &format!("exec {program} new column-collapse > /dev/full")]);
    scratch.start_command(shell).wait().expect(5).says(&["standard output: No space left"]);
}
