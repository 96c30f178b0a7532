//! Who works on a run: one process at a time.

use crate::failure::Failure;
use std::fs::File;
use std::path::Path;

/// Held as long as a run is worked on. The system lets go of it when the process ends, however
/// that comes about.
#[derive(Debug)]
pub(super) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of a run; `None` when another process holds it.
    ///
    /// Where the system or the file system knows no locks, everybody gets one.
    pub(super) fn take(out: &Path, folder: &str) -> Result<Option<Self>, Failure> {
        let parent = out.join("locks");
        std::fs::create_dir_all(&parent).map_err(|error| Failure::io(parent.display(), error))?;
        let path = parent.join(folder);
        let file = File::create(&path).map_err(|error| Failure::io(path.display(), error))?;
        Ok(is_free(&file).then_some(Self { _file: file }))
    }
}

#[cfg(unix)]
fn is_free(file: &File) -> bool {
    use rustix::fs::{FlockOperation, flock};
    flock(file, FlockOperation::NonBlockingLockExclusive) != Err(rustix::io::Errno::WOULDBLOCK)
}

#[cfg(not(unix))]
fn is_free(_: &File) -> bool {
    true
}
