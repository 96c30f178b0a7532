//! Reading scene files: RON text with errors that show the place, and `--set` that edits it.
//!
//! ```
//! use granular_driver::scene_file::SceneText;
//!
//! #[derive(serde::Deserialize)]
//! #[serde(deny_unknown_fields)]
//! struct Material {
//!     friction: f64,
//! }
//!
//! let mut scene = SceneText::new("scene.ron", "(friction: 0.5)");
//! scene.set("friction=0.3")?;
//! assert_eq!(scene.parse::<Material>()?.friction, 0.3);
//!
//! let typo = SceneText::new("scene.ron", "(frictoin: 0.5)");
//! let problem = typo.parse::<Material>().err().expect("the key is unknown");
//! assert_eq!(problem.hint.as_deref(), Some("did you mean `friction`?"));
//! # Ok::<(), granular_driver::scene_file::SceneProblem>(())
//! ```

mod checks;
mod edit;
mod explain;
mod path;
mod problem;
mod read;
pub mod reference;
mod tokens;
mod tree;
mod words;

#[cfg(test)]
mod tests;

pub use path::split_assignment;
pub use problem::{Place, SceneProblem, Snippet};

use edit::Edit;
use path::{Found, find, parse_path};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use tree::Tree;

/// Bytes of a text.
pub type Span = std::ops::Range<usize>;

/// The text of a scene and where it came from.
///
/// Assignments edit the text, so that what is parsed and kept is always one text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneText {
    name: String,
    text: String,
    edits: Vec<Edit>,
}

impl SceneText {
    /// A text with the name that messages call it by.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), edits: Vec::new() }
    }

    /// File name, or `<stdin>`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text with all assignments made so far.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Reads the text as a `T`.
    ///
    /// `Some` may be left out. Keys that are written twice and numbers that are not finite are
    /// refused; so are unknown keys where `T` denies them.
    ///
    /// # Errors
    /// At the first place that cannot be read as a `T`.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, SceneProblem> {
        let tree = Tree::of(&self.text);
        if tree.root.is_none() {
            return Err(self.empty());
        }
        let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let mut reader = ron::Deserializer::from_str_with_options(&self.text, &options)
            .map_err(|error| explain::explain(self, &tree, &error, &[]))?;
        let value = match serde_path_to_error::deserialize(&mut reader) {
            Ok(value) => value,
            Err(error) => {
                let path = explain::segments(error.path());
                let error = reader.span_error(error.into_inner());
                return Err(explain::explain(self, &tree, &error, &path));
            }
        };
        if let Err(error) = reader.end() {
            return Err(explain::explain(self, &tree, &reader.span_error(error), &[]));
        }
        match checks::first(self, &tree) {
            Some(problem) => Err(problem),
            None => Ok(value),
        }
    }

    /// Makes one assignment such as `sample.width=68 mm` or `walls.0.material="glass"`.
    ///
    /// A path goes through keys, list indices and, if wanted, names of variants; keys with dots
    /// are put in double quotes. The value is taken as it is if it is RON, and as a text
    /// otherwise. A key that is not there yet is added to its parent.
    ///
    /// # Errors
    /// When there is no `=`, or the parent of the key is not in the text.
    pub fn set(&mut self, assignment: &str) -> Result<(), SceneProblem> {
        edit::set(self, assignment)
    }

    /// Takes the value at a path out, with its key: a path as for [`SceneText::set`]. Nothing where there is none.
    pub fn remove(&mut self, path: &str) {
        edit::remove(self, path);
    }

    /// Where the value at a path is written.
    pub fn locate(&self, path: &str) -> Option<Span> {
        let (path, rest) = parse_path(path)?;
        if !rest.is_empty() {
            return None;
        }
        let tree = Tree::of(&self.text);
        match find(&self.text, tree.root.as_ref()?, &path) {
            Found::Value { node, .. } => Some(node.span.clone()),
            Found::Missing { .. } => None,
        }
    }

    /// A hash (XXH3, 64 bits) of the text without blanks and comments.
    pub fn content_hash(&self) -> u64 {
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        for token in tokens::tokens(&self.text) {
            hash.update(&self.text.as_bytes()[token.span]);
            // A byte that no UTF-8 text holds keeps tokens apart.
            hash.update(&[0xff]);
        }
        hash.digest()
    }

    /// Line and column of a byte, from 1, in characters.
    pub fn line_and_column(&self, byte: usize) -> (usize, usize) {
        let end = (0..=byte.min(self.text.len())).rev().find(|byte| self.text.is_char_boundary(*byte));
        let before = &self.text[..end.unwrap_or(0)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (1 + before.matches('\n').count(), 1 + before[line_start..].chars().count())
    }

    /// The byte at a line and column.
    fn byte_at(&self, line: usize, column: usize) -> usize {
        let line_start = match line {
            0 | 1 => 0,
            _ => self.text.match_indices('\n').nth(line - 2).map_or(self.text.len(), |(byte, _)| byte + 1),
        };
        let rest = &self.text[line_start..];
        line_start + rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(byte, _)| byte)
    }
}
