//! The run folder: what a run leaves behind.

use crate::failure::Failure;
use crate::lock::Lock;
use crate::methods::specs;
use crate::scene::files::{CONTINUA, MESHES, SAMPLE};
use granular_io::{SnapshotStore, write_atomically};
use serde_json::{Value, json};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// File that marks a run folder.
const RUN_FILE: &str = "run.json";
const SCENE_FILE: &str = "scene.ron";
/// What is left of it by a kill within its writing.
const SCENE_TEMPORARY: &str = "scene.ron.tmp";
/// Who wrote [`RUN_FILE`].
pub(crate) const PROGRAM: &str = "granular";
const SNAPSHOTS: &str = "snapshots";
/// Whoever writes to the folder holds the lock of this empty file.
const LOCK: &str = "lock";
/// Names in a run folder that no output may take.
pub(crate) const RESERVED: [&str; 7] = [RUN_FILE, SCENE_FILE, SNAPSHOTS, LOCK, SAMPLE, MESHES, CONTINUA];

/// A folder that holds the resolved scene, `run.json`, tables, fields, figures and snapshots.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Held by the process that runs in it.
    _lock: Option<Arc<Lock>>,
}

impl RunFolder {
    /// Makes a new folder for this scene text and the files that it reads, by their names in the folder. An existing
    /// run is replaced only when `force`.
    ///
    /// # Errors
    /// When something is in the way, or the folder cannot be written.
    pub fn create(
        path: &Path,
        scene: &str,
        inputs: &[(String, Vec<u8>)],
        force: bool,
    ) -> Result<Self, Failure> {
        if path.exists() && !path.is_dir() {
            return Err(Failure::io(
                path.display(),
                "is a file; a run needs a folder: choose one with --out",
            ));
        }
        refuse_occupied(path, force)?;
        let lock = lock(path)?;
        // Another process may have been faster.
        refuse_occupied(path, force)?;
        let folder = Self { path: path.to_path_buf(), _lock: Some(lock) };
        // This file marks the folder as a run, so it comes first: what is killed from here on can
        // be resumed or replaced. A run that is being replaced is no longer done.
        folder.set_facts(&json!({ "program": PROGRAM, "exit": "running" }))?;
        empty(path).map_err(|error| Failure::io(path.display(), error))?;
        inputs.iter().try_for_each(|(name, bytes)| folder.keep(name, bytes))?;
        // With the scene the run can be resumed, so all that it reads is there before.
        folder.write(SCENE_FILE, scene)?;
        Ok(folder)
    }

    /// Opens the folder of a run.
    ///
    /// # Errors
    /// When it is none.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if path.join(RUN_FILE).is_file() && !path.join(SCENE_FILE).is_file() && is_own_run(path) {
            let force = if is_unborn(path) { "" } else { " and --force" };
            let reason = format!(
                "holds a run that was stopped before it began, so there is nothing to resume; start it again with \
                 `granular run`{force}"
            );
            return Err(Failure::io(path.display(), reason));
        }
        let lacks: Vec<&str> =
            [SCENE_FILE, RUN_FILE].into_iter().filter(|name| !path.join(name).is_file()).collect();
        match (path.is_dir(), lacks.as_slice()) {
            (true, []) => Ok(Self { path: path.to_path_buf(), _lock: None }),
            (true, _) => Err(Failure::io(
                path.display(),
                format!("is not a run folder: it lacks {}", lacks.join(" and ")),
            )),
            (false, _) if path.exists() => {
                Err(Failure::io(path.display(), "is a file; the folder of a run is expected"))
            }
            (false, _) => Err(Failure::io(path.display(), "there is no such folder")),
        }
    }

    /// Opens the folder of a run to go on with it.
    ///
    /// # Errors
    /// When it is none, or another process runs in it.
    pub fn take_up(path: &Path) -> Result<Self, Failure> {
        let mut folder = Self::open(path)?;
        folder._lock = Some(lock(path)?);
        Ok(folder)
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

    /// Keeps a file that the scene reads.
    fn keep(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.path.join(name);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
        }
        write_atomically(&path, |file| std::io::Write::write_all(file, bytes))?;
        Ok(())
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        write_atomically(&self.path.join(name), |file| std::io::Write::write_all(file, text.as_bytes()))?;
        Ok(())
    }

    /// Checksums (XXH3, 64 bits) of all files but `run.json`, the lock and snapshots, by name.
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
                } else if path.is_file() && name != RUN_FILE && name != LOCK {
                    let sum = checksum(&path).map_err(|error| Failure::io(path.display(), error))?;
                    sums.insert(name, json!(format!("{sum:016x}")));
                }
            }
        }
        Ok(Value::Object(sums.into_iter().collect()))
    }
}

/// Refuses a folder that holds something else than a run, or a run that is not to be replaced.
fn refuse_occupied(path: &Path, force: bool) -> Result<(), Failure> {
    if is_unborn(path) {
        return Ok(());
    }
    if !path.join(RUN_FILE).is_file() {
        let reason = "is not empty and holds no run (no run.json), so it is left alone, also with \
                      --force; choose another folder with --out";
        return Err(Failure::io(path.display(), reason));
    }
    if !is_own_run(path) {
        let reason = "is not empty, and its run.json was not written by this program, so it is left alone, also with \
                      --force; choose another folder with --out";
        return Err(Failure::io(path.display(), reason));
    }
    if !force {
        let reason = "holds a run already; --force replaces it, --out chooses another folder";
        return Err(Failure::io(path.display(), reason));
    }
    Ok(())
}

/// Whether a folder is empty, or holds at most what a run leaves that was killed before its scene was written.
fn is_unborn(path: &Path) -> bool {
    let Ok(entries) = fs::read_dir(path) else { return !path.exists() };
    let begun = [RUN_FILE, SAMPLE, MESHES, CONTINUA];
    let mut marked = false;
    let only_litter = entries.flatten().all(|entry| {
        let name = entry.file_name();
        marked |= begun.iter().any(|known| name == *known);
        match name.to_str() {
            // The lock is an empty file.
            Some(LOCK) => entry.metadata().is_ok_and(|data| data.is_file() && data.len() == 0),
            Some(name) => {
                begun.contains(&name.strip_suffix(".tmp").unwrap_or(name)) || name == SCENE_TEMPORARY
            }
            None => false,
        }
    });
    // Inputs without the file that marks a run are not of a run.
    only_litter && (!marked || is_own_run(path))
}

/// Whether `run.json` of a folder is one that this program wrote. Older versions did not write the name of the program, but how
/// it was built, once a run had begun.
fn is_own_run(path: &Path) -> bool {
    let text = fs::read_to_string(path.join(RUN_FILE)).unwrap_or_default();
    let facts: Value = serde_json::from_str(&text).unwrap_or_default();
    let says = |key: &str| facts.get(key).is_some_and(|value| !value.is_null());
    facts["exit"].is_string() && (facts["program"] == PROGRAM || says("built") && says("state_hash"))
}

/// Takes the lock of a folder, which is made if it is not there.
fn lock(path: &Path) -> Result<Arc<Lock>, Failure> {
    let taken = Lock::take(&path.join(LOCK))?.map(Arc::new);
    taken.ok_or_else(|| {
        let reason = "another `granular` process runs in this folder; wait until it has ended or stop it, or choose \
                      another folder with --out";
        Failure::io(path.display(), reason)
    })
}

/// Takes all out of a folder but the lock, which is held, and the file that marks it as a run. The scene goes first: a run
/// of which parts are gone cannot be resumed.
fn empty(path: &Path) -> std::io::Result<()> {
    match fs::remove_file(path.join(SCENE_FILE)) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else if entry.file_name() != LOCK && entry.file_name() != RUN_FILE {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
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

/// The commit that the program was built from.
static COMMIT: OnceLock<&'static str> = OnceLock::new();

/// Says which commit the program was built from, for [`provenance`]. The first call counts.
pub fn set_commit(commit: &'static str) {
    COMMIT.get_or_init(|| commit);
}

/// Version, commit and machine, for `run.json` and `granular info`.
pub fn provenance() -> Value {
    let cpu = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split(':').nth(1)?.trim().to_owned())
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "commit": COMMIT.get().unwrap_or(&"unknown"),
        "methods": specs::names(),
        "left_out": specs::left_out().iter().map(|(name, _)| *name).collect::<Vec<_>>(),
        "target": format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
        "cpu": cpu.unwrap_or_else(|| "unknown".to_owned()),
        "cores": std::thread::available_parallelism().map_or(1, usize::from),
        "threads": rayon::current_num_threads(),
    })
}
