//! Why a file could not be read or written.

use granular_core::{ObserverError, SnapshotError};
use std::fmt;
use std::path::{Path, PathBuf};

/// Why a file could not be read or written: the file, what was tried, and what stopped it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct IoError {
    /// File or folder.
    pub path: PathBuf,
    /// What was tried, as a verb: "write", "read", "reopen".
    pub action: &'static str,
    /// Message of the system, or what is wrong with the contents.
    pub reason: String,
}

impl IoError {
    /// An error for this file.
    pub(crate) fn new(action: &'static str, path: &Path, reason: impl fmt::Display) -> Self {
        Self { path: path.to_path_buf(), action, reason: reason.to_string() }
    }

    /// Turns any error into one for this file.
    pub(crate) fn on<E: fmt::Display>(action: &'static str, path: &Path) -> impl Fn(E) -> Self {
        move |reason| Self::new(action, path, reason)
    }
}

impl fmt::Display for IoError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "could not {} `{}`: {}", self.action, self.path.display(), self.reason)
    }
}

impl std::error::Error for IoError {}

impl From<IoError> for SnapshotError {
    fn from(error: IoError) -> Self {
        Self::File {
            place: error.path.display().to_string(),
            reason: format!("could not {}: {}", error.action, error.reason),
        }
    }
}

impl From<IoError> for ObserverError {
    fn from(error: IoError) -> Self {
        Self {
            place: error.path.display().to_string(),
            reason: format!("could not {}: {}", error.action, error.reason),
        }
    }
}
