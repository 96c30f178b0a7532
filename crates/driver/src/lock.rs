//! Who works on a run or writes a table: one process at a time.

use crate::failure::Failure;
use std::fs::{File, TryLockError};
use std::io::ErrorKind;
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
    /// Where the system or the file system has no locks, everybody gets one.
    pub(crate) fn take(path: &Path) -> Result<Option<Self>, Failure> {
        let file = file(path)?;
        let is_held = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        Ok((!is_held).then_some(Self { _file: file }))
    }

    /// Takes it as soon as no other process holds it.
    pub(crate) fn wait(path: &Path) -> Result<Self, Failure> {
        let file = file(path)?;
        // A signal may end the wait. Any other failure means a file system without locks.
        while file.lock().is_err_and(|error| error.kind() == ErrorKind::Interrupted) {}
        Ok(Self { _file: file })
    }
}

fn file(path: &Path) -> Result<File, Failure> {
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
    }
    File::create(path).map_err(|error| Failure::io(path.display(), error))
}

#[cfg(test)]
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
        // One that waits gets it when it is let go.
        let waiting = std::thread::spawn({
            let path = path.clone();
            move || Lock::wait(&path).unwrap()
        });
        std::thread::sleep(std::time::Duration::from_millis(50));
        assert!(!waiting.is_finished());
        drop(held);
        let held = waiting.join().unwrap();
        assert!(Lock::take(&path).unwrap().is_none());
        drop(held);
        assert!(Lock::take(&path).unwrap().is_some());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
