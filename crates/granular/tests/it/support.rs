//! Runs the built command on small scenes in folders that are removed at the end.

// Each test uses its part of this.
#![allow(dead_code)]

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A command that takes longer hangs. The longest takes seconds; a machine that others load may be slow.
const HANG: Duration = Duration::from_secs(900);

/// A column of 120 disks that collapses: all kinds of outputs and figures, about half a second.
pub(crate) const SMALL: &str = include_str!("small.ron");

/// The whole workspace.
pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace is there")
}

/// A temporary folder that goes when it is dropped.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("granular-test-{name}-{}-{number}", std::process::id()));
        fs::create_dir_all(&path).expect("the temporary folder can be written");
        Self(path)
    }

    /// A folder with the small scene in it, as `small.ron`.
    pub(crate) fn with_scene(name: &str) -> Self {
        let scratch = Self::new(name);
        fs::write(scratch.path("small.ron"), SMALL).unwrap();
        scratch
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Runs the command in this folder and waits for its end.
    pub(crate) fn granular(&self, arguments: &[&str]) -> Outcome {
        self.start(arguments).wait()
    }

    /// Starts the command in this folder.
    pub(crate) fn start(&self, arguments: &[&str]) -> Running {
        let mut command = Command::new(env!("CARGO_BIN_EXE_granular"));
        command.args(arguments);
        self.start_command(command)
    }

    /// Starts any command in this folder.
    pub(crate) fn start_command(&self, mut command: Command) -> Running {
        // Files instead of pipes: no reader is needed, and nothing blocks.
        let texts = Scratch::new("texts");
        let file = |name: &str| Stdio::from(File::create(texts.path(name)).unwrap());
        command.current_dir(&self.0).stdin(Stdio::null()).stdout(file("out")).stderr(file("err"));
        command.env_remove("RUST_BACKTRACE");
        Running { child: command.spawn().expect("the command starts"), texts }
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A command under way.
pub(crate) struct Running {
    child: Child,
    texts: Scratch,
}

impl Running {
    /// Sends a signal by its name, such as `INT`. The command may have ended already.
    pub(crate) fn signal(&self, name: &str) {
        let process = self.child.id().to_string();
        let _ = Command::new("kill").args(["-s", name, &process]).stderr(Stdio::null()).status();
    }

    pub(crate) fn is_running(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }

    /// Interrupts the command once it is `ready`, or has ended before, and waits for its end.
    pub(crate) fn interrupt_when(mut self, ready: impl Fn() -> bool) -> Outcome {
        while !ready() && self.is_running() {
            std::thread::sleep(Duration::from_millis(1));
        }
        self.signal("INT");
        self.wait()
    }

    /// Waits for the end; a hang is a failure of the test.
    pub(crate) fn wait(mut self) -> Outcome {
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            if begun.elapsed() > HANG {
                self.child.kill().unwrap();
                panic!("the command hangs; it said {}", self.text("err"));
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        Outcome { code: status.code(), out: self.text("out"), err: self.text("err") }
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(fs::read(self.texts.path(name)).unwrap()).expect("messages are UTF-8")
    }
}

/// What a command said, and its exit code unless a signal ended it.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Outcome {
    /// Asserts the exit code and that there was no panic.
    #[track_caller]
    pub(crate) fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}\n{}", self.err, self.out);
        assert!(!self.err.contains("panicked"), "{}", self.err);
        self
    }

    /// Asserts that the error message holds all these parts.
    #[track_caller]
    pub(crate) fn says(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(self.err.contains(part), "`{part}` is not in:\n{}", self.err);
        }
        self
    }

    /// The one JSON value on standard output.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error} in:\n{}", self.out))
    }
}

/// Names, relative to the folder, and contents of all files in it.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for path in fs::read_dir(&next).into_iter().flatten().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// All files of a run but `run.json` and snapshots: what must not depend on how it was run.
pub(crate) fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = files(folder);
    found.retain(|name, _| name != "run.json" && !name.starts_with("snapshots/"));
    found
}

/// Snapshots of a run, the oldest first.
pub(crate) fn snapshots(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join("snapshots")).into_iter().flatten();
    let mut found: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.extension().is_some_and(|ending| ending == "bin"));
    found.sort();
    found
}

/// What `run.json` says.
pub(crate) fn facts(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("run.json")).unwrap()).unwrap()
}

/// Asserts that two runs left the same bits: results, facts but those of the wall clock, and the
/// newest snapshot.
#[track_caller]
pub(crate) fn assert_same_run(one: &Path, other: &Path) {
    let (a, b) = (results(one), results(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&a), names(&b), "the folders hold other files");
    for (name, bytes) in &a {
        assert!(bytes == &b[name], "{name} differs");
    }
    let (a, b) = (facts(one), facts(other));
    let same =
        ["solver", "exit", "simulated_seconds", "steps", "state_hash", "metrics", "stages", "checksums"];
    for key in same {
        assert_eq!(a[key], b[key], "`{key}` of run.json differs");
    }
    let newest = |folder| fs::read(snapshots(folder).pop().expect("a run leaves a snapshot")).unwrap();
    assert!(newest(one) == newest(other), "the newest snapshots differ");
}

/// Copies a folder.
pub(crate) fn copy(from: &Path, to: &Path) {
    for (name, bytes) in files(from) {
        let path = to.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}
