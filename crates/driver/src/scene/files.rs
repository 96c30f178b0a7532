//! Files that a scene reads: samples, meshes and calibrated laws.
//!
//! Their paths count from the folder of the scene. A run keeps copies in its folder, which then holds all that it needs; a
//! sweep knows a run by the contents of its files too.

use super::{Sample, Scene, WallSpec};
use crate::failure::Failure;
#[cfg(feature = "mpm")]
use crate::problems::quoted;
use crate::scene_file::{SceneProblem, SceneText};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::Xxh3;

/// Name in a run folder of the sample from a file that the run starts from.
pub(crate) const SAMPLE: &str = "initial-sample.csv";
/// Folder in a run folder of the meshes that walls are made of.
pub(crate) const MESHES: &str = "meshes";

/// Folder in a run folder of the laws that a calibration gave.
pub(crate) const CONTINUA: &str = "continua";

/// A file that a scene reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FileRead {
    /// Where the scene names it, as for `--set`.
    key: String,
    /// The file.
    path: PathBuf,
    /// Its name in a run folder.
    kept_as: String,
}

/// The contents of a file that a scene reads, and their name in a run folder.
pub(crate) type Kept = (String, Vec<u8>);

impl Scene {
    /// The scene of a text, which knows the folder that it came from.
    ///
    /// # Errors
    /// At the first place that cannot be read.
    pub(crate) fn of(text: &SceneText) -> Result<Self, SceneProblem> {
        let mut scene: Self = text.parse().map_err(crate::methods::specs::explain)?;
        scene.folder = Path::new(text.name()).parent().unwrap_or(Path::new("")).to_owned();
        Ok(scene)
    }

    /// All files that the scene reads.
    fn files(&self) -> Vec<FileRead> {
        let mut files = Vec::new();
        if let Some(Sample::File { path, .. }) = &self.sample {
            let (key, kept_as) = ("sample.path".to_owned(), SAMPLE.to_owned());
            files.push(FileRead { key, path: self.folder.join(path), kept_as });
        }
        for (k, wall) in self.walls.iter().enumerate() {
            if let WallSpec::Mesh { file, .. } = wall {
                let (key, kept_as) = (format!("walls.{k}.file"), format!("{MESHES}/{k}.stl"));
                files.push(FileRead { key, path: self.folder.join(file), kept_as });
            }
        }
        #[cfg(feature = "mpm")]
        for (k, (name, continuum)) in self.continua.iter().enumerate() {
            if let Some(calibrated) = &continuum.calibrated {
                let (key, kept_as) =
                    (format!("continua.{}.calibrated.file", quoted(name)), format!("{CONTINUA}/{k}.ron"));
                files.push(FileRead { key, path: self.folder.join(&calibrated.file), kept_as });
            }
        }
        files
    }

    /// Reads all files of the scene, and makes the text name them as they are called in a run folder.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub(crate) fn take_files(&self, text: &mut SceneText) -> Result<Vec<Kept>, Failure> {
        let mut kept = Vec::new();
        for FileRead { key, path, kept_as } in self.files() {
            let bytes = std::fs::read(&path).map_err(|error| Failure::io(path.display(), error))?;
            text.set(&format!("{key}=\"{kept_as}\""))?;
            kept.push((kept_as, bytes));
        }
        Ok(kept)
    }

    /// A hash of the text without blanks and comments, and of the contents of all files that the scene reads. A file that
    /// cannot be read counts as none: the run will say so, and is another one when the file is there.
    pub(crate) fn content_hash(&self, text: &SceneText) -> u64 {
        let files = self.files();
        if files.is_empty() {
            return text.content_hash();
        }
        let mut hash = Xxh3::new();
        hash.update(&text.content_hash().to_le_bytes());
        for file in files {
            let contents = std::fs::read(&file.path).ok();
            hash.update(&contents.as_ref().map_or(u64::MAX, |bytes| bytes.len() as u64).to_le_bytes());
            hash.update(&contents.unwrap_or_default());
        }
        hash.digest()
    }
}
