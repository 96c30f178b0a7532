//! Who works on a run or writes the table: one process at a time.

use crate::failure::Failure;
use std::fs::File;
use std::path::Path;

/// Held as long as a run is worked on or a table is written. The system lets go of it when the
/// process ends, however that comes about.
#[derive(Debug)]
pub(super) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of a run; `None` when another process holds it.
    ///
    /// Where the system or the file system knows no locks, everybody gets one.
    pub(super) fn take(out: &Path, folder: &str) -> Result<Option<Self>, Failure> {
        let file = file(out, folder)?;
        Ok(system::is_free(&file).then_some(Self { _file: file }))
    }

    /// Takes the lock of the files that collect all runs, as soon as no other process writes them.
    pub(super) fn of_table(out: &Path) -> Result<Self, Failure> {
        let file = file(out, "table")?;
        system::wait(&file);
        Ok(Self { _file: file })
    }
}

fn file(out: &Path, name: &str) -> Result<File, Failure> {
    let parent = out.join("locks");
    std::fs::create_dir_all(&parent).map_err(|error| Failure::io(parent.display(), error))?;
    let path = parent.join(name);
    File::create(&path).map_err(|error| Failure::io(path.display(), error))
}

#[cfg(unix)]
mod system {
    use rustix::fs::{FlockOperation, flock};
    use std::fs::File;

    pub(super) fn is_free(file: &File) -> bool {
        flock(file, FlockOperation::NonBlockingLockExclusive) != Err(rustix::io::Errno::WOULDBLOCK)
    }

    pub(super) fn wait(file: &File) {
        // A signal may end the wait. Any other failure is a file system without locks.
        while flock(file, FlockOperation::LockExclusive) == Err(rustix::io::Errno::INTR) {}
    }
}

#[cfg(not(unix))]
mod system {
    use std::fs::File;

    pub(super) fn is_free(_: &File) -> bool {
        true
    }

    pub(super) fn wait(_: &File) {}
}
