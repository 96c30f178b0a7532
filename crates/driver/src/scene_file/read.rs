//! Texts from disk.

use super::SceneText;
use super::problem::SceneProblem;
use super::words::nearest;
use crate::machine::{self, in_words};
use std::io::{ErrorKind, Read};
use std::path::Path;

/// Memory that a byte of a text takes, with its tokens and the scene \[bytes\].
const BYTES_PER_BYTE: f64 = 100.0;

impl SceneText {
    /// Reads a file, or standard input for `-`.
    ///
    /// # Errors
    /// When there is no such file, or it is a folder, not text, or empty.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneProblem> {
        let path = path.as_ref();
        let mut bytes = Vec::new();
        let most = machine::most(BYTES_PER_BYTE);
        let (name, outcome) = if path == Path::new("-") {
            ("<stdin>".to_owned(), std::io::stdin().lock().take(most as u64 + 1).read_to_end(&mut bytes))
        } else if path.is_dir() {
            return Err(folder(path));
        } else {
            let file = std::fs::File::open(path);
            (
                path.display().to_string(),
                file.and_then(|file| file.take(most as u64 + 1).read_to_end(&mut bytes)),
            )
        };
        match outcome {
            Ok(length) if length as f64 > most => {
                let reason =
                    format!("it is longer than {}, for which this machine has memory", in_words(most));
                Err(SceneProblem::of_file(name, format!("cannot be read: {reason}")))
            }
            Ok(_) => Self::from_bytes(name, bytes),
            Err(error) if error.kind() == ErrorKind::NotFound => Err(missing(path)),
            Err(error) => Err(SceneProblem::of_file(name, format!("cannot be read: {error}"))),
        }
    }

    /// A text from bytes; a byte order mark in front is left out.
    ///
    /// # Errors
    /// When the bytes are not text, or there are none but blanks and comments.
    pub fn from_bytes(name: impl Into<String>, bytes: Vec<u8>) -> Result<Self, SceneProblem> {
        let name = name.into();
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            let byte = error.as_bytes().get(at).copied().unwrap_or_default();
            let message = format!("this is not a text: byte {at} (0x{byte:02x}) is not UTF-8");
            SceneProblem::of_file(name.clone(), message)
                .with_hint("a scene is a text file in RON, saved as UTF-8")
        })?;
        let text = text.strip_prefix('\u{FEFF}').map(str::to_owned).unwrap_or(text);
        let scene = Self::new(name, text);
        if super::tokens::tokens(&scene.text).is_empty() { Err(scene.empty()) } else { Ok(scene) }
    }

    pub(super) fn empty(&self) -> SceneProblem {
        let message = if self.text.is_empty() { "the file is empty" } else { "the file holds no scene" };
        SceneProblem::of_file(self.name.clone(), message)
            .with_hint("a scene begins with `Scene(`; the folder `examples` has some to copy")
    }
}

fn folder(path: &Path) -> SceneProblem {
    let problem = SceneProblem::of_file(path.display().to_string(), "this is a folder, not a scene file");
    let scene = path.join("scene.ron");
    if scene.is_file() { problem.with_hint(format!("did you mean `{}`?", scene.display())) } else { problem }
}

fn missing(path: &Path) -> SceneProblem {
    let problem = SceneProblem::of_file(path.display().to_string(), "there is no such file");
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = folder.read_dir() else {
        return problem.with_hint(format!("there is no folder `{}` either", folder.display()));
    };
    let names: Vec<String> =
        entries.flatten().take(1000).map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    let wanted = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    match nearest(&wanted, &names) {
        Some(name) => problem.with_hint(format!("did you mean `{}`?", path.with_file_name(name).display())),
        None => problem,
    }
}
