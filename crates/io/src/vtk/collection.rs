//! The list of files of a run over time, `.pvd`.

use super::element::elements;
use super::xml::escaped;
use crate::atomic::write_atomically;
use crate::error::IoError;
use crate::table::shortest;
use std::fs;
use std::path::{Path, PathBuf};

/// A `.pvd` file: which file belongs to which time. It is rewritten whole and atomically with
/// each file, so a run can be looked at while it goes on.
#[derive(Clone, Debug)]
pub struct Collection {
    path: PathBuf,
    entries: Vec<(f64, String)>,
}

impl Collection {
    /// Writes an empty collection; an old file of this path is replaced.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, IoError> {
        let collection = Self { path: path.to_path_buf(), entries: Vec::new() };
        collection.save()?;
        Ok(collection)
    }

    /// Reads a collection that was written here.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        let fail = IoError::on("read", path);
        let text = fs::read_to_string(path).map_err(|error| fail(error.to_string()))?;
        let elements = elements(&text).map_err(|error| fail(error.to_string()))?;
        let mut entries = Vec::new();
        for data_set in elements.iter().filter(|element| element.name == "DataSet") {
            let entry = data_set.number("timestep").zip(data_set.attribute("file").map(str::to_owned));
            let number = entries.len() + 1;
            entries.push(entry.ok_or_else(|| fail(format!("data set {number} has no time or file")))?);
        }
        Ok(Self { path: path.to_path_buf(), entries })
    }

    /// Reads a collection and keeps its first `count` files, as at the time of a snapshot.
    ///
    /// # Errors
    /// When the file cannot be read or holds fewer.
    pub fn reopen_at(path: &Path, count: usize) -> Result<Self, IoError> {
        let mut collection = Self::open(path)?;
        if collection.len() < count {
            let reason = format!("it lists {} files where {count} are expected", collection.len());
            return Err(IoError::new("reopen", path, reason));
        }
        collection.entries.truncate(count);
        collection.save()?;
        Ok(collection)
    }

    /// Adds a file, given relative to the folder of the collection, at a time \[s\].
    ///
    /// # Errors
    /// When the collection cannot be written; then it is as before.
    pub fn push(&mut self, time: f64, file: &str) -> Result<(), IoError> {
        self.entries.push((time, file.to_owned()));
        self.save().inspect_err(|_| {
            self.entries.pop();
        })
    }

    /// Number of files, for [`Collection::reopen_at`].
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether it lists no file.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Times \[s\] and files.
    pub fn entries(&self) -> &[(f64, String)] {
        &self.entries
    }

    fn save(&self) -> Result<(), IoError> {
        write_atomically(&self.path, |to| {
            to.write_all(b"<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n")?;
            to.write_all(b"<Collection>\n")?;
            for (time, file) in &self.entries {
                let (time, file) = (shortest(*time), escaped(file));
                writeln!(to, "<DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>")?;
            }
            to.write_all(b"</Collection>\n</VTKFile>\n")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Scratch;

    #[test]
    fn a_resumed_collection_drops_what_came_after() {
        let folder = Scratch::new("pvd");
        let path = folder.path("run.pvd");
        let mut collection = Collection::create(&path).unwrap();
        for (time, file) in [(0.0, "a & b.vtp"), (0.1 + 0.2, "1.vtp"), (1e-9, "2.vtp")] {
            collection.push(time, file).unwrap();
        }
        let mut again = Collection::reopen_at(&path, 2).unwrap();
        assert_eq!(again.entries(), &collection.entries()[..2]);
        again.push(0.4, "2.vtp").unwrap();
        assert_eq!(Collection::reopen_at(&path, 3).unwrap().entries()[2], (0.4, "2.vtp".to_owned()));
        let short = Collection::reopen_at(&path, 4).unwrap_err().to_string();
        assert!(short.contains("lists 3 files where 4 are expected"), "{short}");
        let text = fs::read_to_string(&path).unwrap();
        // As another program might lay it out: all on one line, the attributes in another order.
        let other = text.replace('\n', " ").replace("timestep=\"0\" part=\"0\"", "part='0'  timestep='0'");
        fs::write(&path, other).unwrap();
        assert_eq!(Collection::open(&path).unwrap().entries()[..2], collection.entries()[..2]);
        fs::write(&path, text.replacen("timestep", "time", 1)).unwrap();
        let wrong = Collection::open(&path).unwrap_err().to_string();
        assert!(wrong.contains("data set 1 has no time or file"), "{wrong}");
        fs::write(&path, text.replacen("<DataSet", "<DataSet <", 1)).unwrap();
        assert!(Collection::open(&path).is_err());
    }
}
