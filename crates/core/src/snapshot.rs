//! Named arrays that hold the state of a solver, a coupling or an observer.
//!
//! A [`Section`] is a small map from names to little-endian arrays. It knows nothing of files;
//! `granular-io` writes sections with checksums. What a section holds is what matters for the
//! rest of a run: lists and scratch that can be rebuilt do not belong here.

mod section;
mod stored;

pub use section::{EntrySink, Section, check_entry};
pub use stored::Stored;

use std::fmt;

/// Why a state could not be saved or restored.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotError {
    /// The section or entry is not there.
    Missing {
        /// Section and entry.
        place: String,
    },
    /// The section or entry does not hold what is expected there.
    Damaged {
        /// Section and entry.
        place: String,
        /// What was found instead.
        found: String,
    },
    /// The file could not be read or written.
    File {
        /// File.
        place: String,
        /// Message of the system.
        reason: String,
    },
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { place } => write!(f, "the snapshot has no section `{place}`"),
            Self::Damaged { place, found } => {
                write!(f, "section `{place}` of the snapshot is damaged: {found}")
            }
            Self::File { place, reason } => write!(f, "snapshot file `{place}`: {reason}"),
        }
    }
}

impl std::error::Error for SnapshotError {}
