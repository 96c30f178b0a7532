//! Files that are either old or new, never half written.

use crate::error::IoError;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a file so that at any moment, also after a crash or a power cut, `path` holds either
/// all of the old or all of the new contents.
///
/// The new contents go to `<name>.tmp` in the same folder, reach the disk, and are then renamed.
/// A `.tmp` file that a killed process left behind is overwritten by the next call. Only one
/// writer at a time may write the same path.
///
/// # Errors
/// When `write` fails or the system refuses; the temporary file is removed and the old file is
/// untouched.
pub fn write_atomically<T>(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> Result<T, IoError> {
    let temporary = temporary_path(path);
    let written = write_and_rename(path, &temporary, write);
    if written.is_err() {
        // The first error is the one to report; a temporary file that stays is only litter.
        let _ = fs::remove_file(&temporary);
    }
    written.map_err(IoError::on("write", path))
}

fn write_and_rename<T>(
    path: &Path,
    temporary: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> io::Result<T> {
    let mut buffered = BufWriter::with_capacity(1 << 16, File::create(temporary)?);
    let result = write(&mut buffered)?;
    let file = buffered.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.sync_all()?;
    drop(file);
    fs::rename(temporary, path)?;
    sync_folder(path)?;
    Ok(result)
}

/// The rename itself must reach the disk too. Only Unix can sync a folder.
fn sync_folder(path: &Path) -> io::Result<()> {
    if cfg!(unix) {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        File::open(folder.unwrap_or(Path::new(".")))?.sync_all()?;
    }
    Ok(())
}

/// `<name>.tmp` next to `path`.
pub(crate) fn temporary_path(path: &Path) -> PathBuf {
    let mut name: OsString = path.as_os_str().to_owned();
    name.push(".tmp");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Scratch;

    #[test]
    fn a_failing_write_leaves_the_old_file_and_no_litter() {
        let folder = Scratch::new("atomic");
        let path = folder.path("a.txt");
        write_atomically(&path, |to| to.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |to| {
            to.write_all(&[7; 100_000])?;
            Err::<(), _>(io::Error::other("the solver broke"))
        });
        let text = error.unwrap_err().to_string();
        assert!(
            text.starts_with("could not write `") && text.ends_with("a.txt`: the solver broke"),
            "{text}"
        );
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(folder.names(), ["a.txt"]);
        write_atomically(&path, |to| to.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_leaves_the_old_file() {
        let folder = Scratch::new("full");
        let path = folder.path("a.txt");
        write_atomically(&path, |to| to.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |to| {
            to.write_all(b"half")?;
            fs::OpenOptions::new().write(true).open("/dev/full")?.write_all(b"rest")
        });
        assert!(error.unwrap_err().reason.contains("No space left"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn a_missing_folder_is_named() {
        let folder = Scratch::new("missing");
        let error = write_atomically(&folder.path("no/such.txt"), |_| Ok(())).unwrap_err();
        assert!(error.to_string().contains("no/such.txt"));
    }
}
