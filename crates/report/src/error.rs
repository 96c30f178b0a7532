//! Why a page could not be written.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why a page could not be written: the file or folder, what is wrong with it, what is allowed, and what helps.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReportError {
    /// File or folder.
    pub path: PathBuf,
    /// What is wrong, with the place within a file.
    pub reason: String,
    /// What is allowed.
    pub allowed: String,
    /// What helps.
    pub fix: String,
}

impl ReportError {
    pub(crate) fn new(
        path: &Path,
        reason: impl fmt::Display,
        allowed: impl fmt::Display,
        fix: impl fmt::Display,
    ) -> Self {
        let [reason, allowed, fix] = [reason.to_string(), allowed.to_string(), fix.to_string()];
        Self { path: path.to_path_buf(), reason, allowed, fix }
    }
}

impl fmt::Display for ReportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, reason, allowed, fix } = self;
        write!(f, "`{}`: {reason}; allowed: {allowed}; {fix}", path.display())
    }
}

impl std::error::Error for ReportError {}
