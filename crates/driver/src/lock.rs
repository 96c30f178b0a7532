//! Who works on a run or writes a table: one process at a time.

use crate::failure::Failure;
use std::fs::File;
use std::path::Path;

/// Held as long as something is worked on. The system lets go of it when the process ends, however
/// that comes about.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of this empty file, which is made if it is not there; `None` when another process holds it.
    ///
    /// Where the system or the file system knows no locks, everybody gets one.
    pub(crate) fn take(path: &Path) -> Result<Option<Self>, Failure> {
        let file = file(path)?;
        Ok(system::is_free(&file).then_some(Self { _file: file }))
    }

    /// Takes it as soon as no other process holds it.
    pub(crate) fn wait(path: &Path) -> Result<Self, Failure> {
        let file = file(path)?;
        system::wait(&file);
        Ok(Self { _file: file })
    }
}

fn file(path: &Path) -> Result<File, Failure> {
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
    }
    File::create(path).map_err(|error| Failure::io(path.display(), error))
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

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_lock_is_held_by_one_until_it_is_dropped() {
        let folder = std::env::temp_dir().join(format!("granular-lock-{}", std::process::id()));
        let path = folder.join("some/lock");
        let held = Lock::take(&path).unwrap();
        assert!(held.is_some());
        assert!(Lock::take(&path).unwrap().is_none());
        // Another file is another lock.
        assert!(Lock::take(&folder.join("some/other")).unwrap().is_some());
        drop(held);
        assert!(Lock::take(&path).unwrap().is_some());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
