//! How far a run of a sweep is, from its folder.

use crate::failure::Failure;
use crate::folder::RunFolder;
use granular_io::write_atomically;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// How far a run is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// Not begun, or killed before it could be resumed.
    Waiting,
    /// Begun, and under way in another process or to be resumed.
    Unfinished,
    /// Done.
    Done,
    /// Failed: exit code and reason.
    Failed {
        /// Exit code of a run alone.
        code: u8,
        /// What the run said.
        reason: String,
    },
}

impl State {
    pub(super) fn of(out: &Path, folder: &str) -> Result<Self, Failure> {
        let path = failure_path(out, folder);
        if path.is_file() {
            let text = std::fs::read_to_string(&path).map_err(|error| Failure::io(path.display(), error))?;
            let record: Value =
                serde_json::from_str(&text).map_err(|error| Failure::io(path.display(), error))?;
            let code = record["code"].as_u64().and_then(|code| u8::try_from(code).ok()).unwrap_or(4);
            return Ok(Self::Failed { code, reason: record["reason"].as_str().unwrap_or("").to_owned() });
        }
        let Ok(run) = RunFolder::open(&out.join(folder)) else { return Ok(Self::Waiting) };
        let facts = run.facts()?;
        Ok(match facts["exit"].as_str() {
            Some("done") => Self::Done,
            // Killed between the failure and the record of its reason.
            Some("failed") => {
                Self::Failed { code: 4, reason: format!("{} says so", run.path().join("run.json").display()) }
            }
            _ => Self::Unfinished,
        })
    }

    /// One word for the table.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Unfinished => "unfinished",
            Self::Done => "done",
            Self::Failed { code: 2, .. } => "wrong scene",
            Self::Failed { code: 3, .. } => "refused",
            Self::Failed { code: 4, .. } => "stopped",
            Self::Failed { .. } => "failed",
        }
    }

    /// Why it failed.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Failed { reason, .. } => Some(reason),
            _ => None,
        }
    }

    /// Whether a sweep works on it.
    pub(super) fn is_to_run(&self, retry: bool) -> bool {
        match self {
            Self::Done => false,
            Self::Failed { .. } => retry,
            Self::Waiting | Self::Unfinished => true,
        }
    }

    /// What a sweep would do with it.
    pub(super) fn outlook(&self, retry: bool) -> &'static str {
        match self {
            Self::Done => "stay: done",
            Self::Failed { .. } if !retry => "stay: failed before (--retry tries again)",
            state if state.can_resume() => "resume",
            _ => "start",
        }
    }

    /// Whether it goes on from where it was. A run that a guard stopped would meet the same guard
    /// again: it starts anew. One that could not write goes on.
    pub(super) fn can_resume(&self) -> bool {
        matches!(self, Self::Unfinished | Self::Failed { code: 5, .. })
    }
}

fn failure_path(out: &Path, folder: &str) -> PathBuf {
    out.join("failures").join(format!("{folder}.json"))
}

/// Writes down why a run failed.
pub(super) fn write_failure(out: &Path, folder: &str, failure: &Failure) -> Result<(), Failure> {
    let path = failure_path(out, folder);
    let parent = out.join("failures");
    std::fs::create_dir_all(&parent).map_err(|error| Failure::io(parent.display(), error))?;
    write_json(&path, &json!({ "code": failure.code(), "reason": failure.to_string() }))
}

/// Forgets that a run failed, before it is tried again.
pub(super) fn forget_failure(out: &Path, folder: &str) -> Result<(), Failure> {
    let path = failure_path(out, folder);
    match std::fs::remove_file(&path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(Failure::io(path.display(), error)),
        _ => Ok(()),
    }
}

pub(super) fn write_json(path: &Path, value: &Value) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).expect("a JSON value can be written") + "\n";
    write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}
