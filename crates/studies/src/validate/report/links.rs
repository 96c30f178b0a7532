//! Links from the page to files of the source tree.

use std::path::Path;

/// A file in the tree by which its root is known.
const ROOT: &str = "validation/src/lib.rs";

/// Where the tree lies, as seen from the page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Links {
    /// What takes the reader from the page to the root; none where the page lies outside of the tree.
    up: Option<String>,
}

impl Links {
    /// As seen from this file.
    pub(super) fn from(page: &Path) -> Self {
        let page = std::path::absolute(page).unwrap_or_else(|_| page.to_owned());
        let folders = page.ancestors().skip(1);
        let up = folders.enumerate().find(|(_, folder)| folder.join(ROOT).is_file());
        Self { up: up.map(|(depth, _)| "../".repeat(depth)) }
    }

    /// The link to a file of the tree; none where there is no tree.
    pub(super) fn to(&self, file: &str) -> Option<String> {
        self.up.as_ref().map(|up| format!("{up}{file}"))
    }
}
