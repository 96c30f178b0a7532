//! The two newest snapshots of a run.

use super::{read_snapshot, write_snapshot};
use crate::error::IoError;
use granular_core::{Section, SnapshotError};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder with the newest snapshots of one run, `snapshot-<step>.bin`.
#[derive(Clone, Debug)]
pub struct SnapshotStore {
    folder: PathBuf,
}

/// The newest snapshot that can be read.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Latest {
    /// Its file.
    pub path: PathBuf,
    /// The step at which it was taken.
    pub step: u64,
    /// What it holds.
    pub sections: Vec<Section>,
    /// Newer snapshots that could not be read, and why; to be shown to the user.
    pub warnings: Vec<String>,
}

impl SnapshotStore {
    /// The store in this folder, which must exist when something is saved.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Writes the state after `step` steps, and only then removes what is no longer needed: all
    /// but this one and the newest before it. Snapshots of later steps belong to a run that was
    /// taken up again before them, so they go too.
    ///
    /// # Errors
    /// When the snapshot cannot be written; all old ones stay.
    pub fn save(&self, step: u64, sections: &[Section]) -> Result<PathBuf, SnapshotError> {
        let path = self.folder.join(format!("snapshot-{step:012}.bin"));
        write_snapshot(&path, sections)?;
        let taken = self.taken()?;
        let before = taken.iter().rev().find(|(other, _)| *other < step).map(|(other, _)| *other);
        for (other, old) in &taken {
            if *other != step && Some(*other) != before {
                fs::remove_file(old).map_err(IoError::on("remove", old))?;
            }
        }
        self.remove_litter();
        Ok(path)
    }

    /// The newest snapshot that can be read.
    ///
    /// # Errors
    /// When there is none.
    pub fn latest(&self) -> Result<Latest, SnapshotError> {
        let mut warnings = Vec::new();
        for (step, path) in self.taken()?.into_iter().rev() {
            match read_snapshot(&path) {
                Ok(sections) => return Ok(Latest { path, step, sections, warnings }),
                Err(error) => warnings.push(error.to_string()),
            }
        }
        let reason = if warnings.is_empty() {
            "the folder holds no snapshot".to_owned()
        } else {
            format!("no snapshot can be read: {}", warnings.join("; "))
        };
        Err(SnapshotError::File { place: self.folder.display().to_string(), reason })
    }

    /// Steps and files of all snapshots, the oldest first.
    fn taken(&self) -> Result<Vec<(u64, PathBuf)>, IoError> {
        let fail = IoError::on("read", &self.folder);
        let mut found = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(&fail)? {
            let path = entry.map_err(&fail)?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            let step = name.strip_prefix("snapshot-").and_then(|rest| rest.strip_suffix(".bin"));
            if let Some(step) = step.and_then(|digits| digits.parse().ok()) {
                found.push((step, path));
            }
        }
        found.sort();
        Ok(found)
    }

    /// Half files that killed processes left; that they stay harms nobody.
    fn remove_litter(&self) {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        for path in entries.map(|entry| entry.path()) {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if name.starts_with("snapshot-") && name.ends_with(".bin.tmp") {
                let _ = fs::remove_file(&path);
            }
        }
    }
}
