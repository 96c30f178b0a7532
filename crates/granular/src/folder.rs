//! The run folder: what a run leaves behind.

use crate::failure::Failure;
use granular_io::{SnapshotStore, write_atomically};
use serde_json::{Value, json};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// File that marks a run folder.
const RUN_FILE: &str = "run.json";
const SCENE_FILE: &str = "scene.ron";
const SNAPSHOTS: &str = "snapshots";
/// Names in a run folder that no output may take.
pub(crate) const RESERVED: [&str; 4] = [RUN_FILE, SCENE_FILE, SNAPSHOTS, SAMPLE_FILE];
/// The sample from a file that a run started from.
pub(crate) const SAMPLE_FILE: &str = "initial-sample.csv";

/// A folder that holds the resolved scene, `run.json`, tables, fields, figures and snapshots.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// Makes a new folder for this scene text. An existing run is replaced only when `force`.
    ///
    /// # Errors
    /// When something is in the way, or the folder cannot be written.
    pub fn create(path: &Path, scene: &str, force: bool) -> Result<Self, Failure> {
        if path.exists() && !path.is_dir() {
            return Err(Failure::io(
                path.display(),
                "is a file; a run needs a folder: choose one with --out",
            ));
        }
        // A run that was killed before it wrote its first file leaves a part of that.
        let litter = format!("{RUN_FILE}.tmp");
        let entries = fs::read_dir(path).into_iter().flatten().flatten();
        let occupied = entries.into_iter().any(|entry| entry.file_name() != litter.as_str());
        if occupied {
            let is_run = path.join(RUN_FILE).is_file();
            if !is_run {
                let reason = "is not empty and holds no run (no run.json), so it is left alone, also with \
                              --force; choose another folder with --out";
                return Err(Failure::io(path.display(), reason));
            }
            if !force {
                let reason = "holds a run already; --force replaces it, --out chooses another folder";
                return Err(Failure::io(path.display(), reason));
            }
            fs::remove_dir_all(path).map_err(|error| Failure::io(path.display(), error))?;
        }
        fs::create_dir_all(path).map_err(|error| Failure::io(path.display(), error))?;
        let folder = Self { path: path.to_path_buf() };
        // This file marks the folder as a run, so it comes first: what is killed from here on can
        // be resumed or replaced.
        folder.set_facts(&json!({ "exit": "running" }))?;
        folder.write(SCENE_FILE, scene)?;
        Ok(folder)
    }

    /// Opens the folder of a run.
    ///
    /// # Errors
    /// When it is none.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let lacks: Vec<&str> =
            [SCENE_FILE, RUN_FILE].into_iter().filter(|name| !path.join(name).is_file()).collect();
        match (path.is_dir(), lacks.as_slice()) {
            (true, []) => Ok(Self { path: path.to_path_buf() }),
            (true, _) => Err(Failure::io(
                path.display(),
                format!("is no run folder: it lacks {}", lacks.join(" and ")),
            )),
            (false, _) if path.exists() => {
                Err(Failure::io(path.display(), "is a file; the folder of a run is expected"))
            }
            (false, _) => Err(Failure::io(path.display(), "there is no such folder")),
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The scene as it was run.
    pub fn scene_path(&self) -> PathBuf {
        self.path.join(SCENE_FILE)
    }

    /// Where snapshots are kept.
    pub fn snapshots(&self) -> SnapshotStore {
        SnapshotStore::new(self.path.join(SNAPSHOTS))
    }

    /// Whether any snapshot was taken, readable or not.
    pub fn has_snapshots(&self) -> bool {
        let names = fs::read_dir(self.path.join(SNAPSHOTS)).into_iter().flatten().flatten();
        names.into_iter().any(|entry| entry.file_name().to_string_lossy().ends_with(".bin"))
    }

    /// What is known of the run.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn facts(&self) -> Result<Value, Failure> {
        let path = self.path.join(RUN_FILE);
        let text = fs::read_to_string(&path).map_err(|error| Failure::io(path.display(), error))?;
        serde_json::from_str(&text).map_err(|error| Failure::io(path.display(), error))
    }

    /// Replaces what is known of the run.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn set_facts(&self, facts: &Value) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(facts).expect("a JSON value can be written");
        self.write(RUN_FILE, &(text + "\n"))
    }

    /// Keeps the sample that the run starts from.
    pub(crate) fn write_sample(&self, bytes: &[u8]) -> Result<(), Failure> {
        write_atomically(&self.path.join(SAMPLE_FILE), |file| std::io::Write::write_all(file, bytes))?;
        Ok(())
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        write_atomically(&self.path.join(name), |file| std::io::Write::write_all(file, text.as_bytes()))?;
        Ok(())
    }

    /// Checksums (XXH3, 64 bits) of all files but `run.json` and snapshots, by name.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn checksums(&self) -> Result<Value, Failure> {
        let mut sums = std::collections::BTreeMap::new();
        let mut folders = vec![self.path.clone()];
        while let Some(folder) = folders.pop() {
            let entries = fs::read_dir(&folder).map_err(|error| Failure::io(folder.display(), error))?;
            for path in entries.filter_map(|entry| entry.ok().map(|entry| entry.path())) {
                let name = path.strip_prefix(&self.path).unwrap_or(&path).display().to_string();
                if path.is_dir() && name != SNAPSHOTS {
                    folders.push(path);
                } else if path.is_file() && name != RUN_FILE {
                    let sum = checksum(&path).map_err(|error| Failure::io(path.display(), error))?;
                    sums.insert(name, json!(format!("{sum:016x}")));
                }
            }
        }
        Ok(Value::Object(sums.into_iter().collect()))
    }
}

fn checksum(path: &Path) -> std::io::Result<u64> {
    let mut file = fs::File::open(path)?;
    let mut hash = xxhash_rust::xxh3::Xxh3::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hash.digest()),
            count => hash.update(&buffer[..count]),
        }
    }
}

/// Version, commit and machine, for `run.json` and `granular info`.
pub fn provenance() -> Value {
    let cpu = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split(':').nth(1)?.trim().to_owned())
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "commit": option_env!("GRANULAR_COMMIT").unwrap_or("unknown"),
        "target": format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
        "cpu": cpu.unwrap_or_else(|| "unknown".to_owned()),
        "cores": std::thread::available_parallelism().map_or(1, usize::from),
        "threads": rayon::current_num_threads(),
    })
}
