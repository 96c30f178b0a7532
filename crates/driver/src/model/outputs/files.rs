//! Which files outputs and figures write, and whether they get in each other's way.

use super::Problems;
use crate::folder::RESERVED;
use std::path::{Component, Path};

/// Longest name of a file or folder, in bytes: file systems take 255, and endings and numbers are added.
const LONGEST_NAME: usize = 200;
/// Longest path within the run folder, in bytes.
const LONGEST_PATH: usize = 1000;
/// Files are called so while they are written.
const UNDER_WAY: &str = ".tmp";

/// Files that something writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Files {
    /// One of this path.
    One(String),
    /// One per frame: `<stem>_000000<ending>` and so on.
    Frames(String, &'static str),
}

/// The last part of the path of files.
#[derive(Clone, Copy, Debug)]
enum Name<'a> {
    One(&'a str),
    Frames(&'a str, &'static str),
}

impl Files {
    /// The folders and the name of these files.
    fn parts(&self) -> (Vec<&str>, Name<'_>) {
        let (path, ending) = match self {
            Self::One(path) => (path, None),
            Self::Frames(stem, ending) => (stem, Some(*ending)),
        };
        let mut folders: Vec<&str> = path.split('/').collect();
        let last = folders.pop().unwrap_or_default();
        (folders, ending.map_or(Name::One(last), |ending| Name::Frames(last, ending)))
    }

    /// Whether some of these files are some of those, or lie below them as if they were folders.
    fn meet(&self, other: &Self) -> bool {
        let ((own, name), (others, its_name)) = (self.parts(), other.parts());
        let shared = own.len().min(others.len());
        if own[..shared] != others[..shared] {
            return false;
        }
        match (own.get(shared), others.get(shared)) {
            (Some(folder), None) => its_name.meets(Name::One(folder)),
            (None, Some(folder)) => name.meets(Name::One(folder)),
            _ => name.meets(its_name),
        }
    }
}

impl Name<'_> {
    fn meets(self, other: Self) -> bool {
        match (self, other) {
            (Self::One(a), Self::One(b)) => a == b,
            (Self::Frames(a, ending), Self::Frames(b, other)) => (a, ending) == (b, other),
            (Self::Frames(stem, ending), Self::One(name)) | (Self::One(name), Self::Frames(stem, ending)) => {
                let number = name.strip_prefix(stem).and_then(|rest| rest.strip_prefix('_'));
                let number = number.and_then(|rest| rest.strip_suffix(ending));
                number.is_some_and(|digits| digits.len() >= 6 && digits.bytes().all(|b| b.is_ascii_digit()))
            }
        }
    }
}

/// The one spelling of a path that is compared: no doubled `/`, no `/./`, and small letters, since some file systems do not
/// tell cases apart.
pub(super) fn spelled(path: &str) -> String {
    let parts = Path::new(path).components().filter_map(|part| match part {
        Component::Normal(name) => Some(name.to_string_lossy().to_lowercase()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

/// Files that are taken, with the scene path of what writes them.
#[derive(Debug, Default)]
pub(super) struct Taken(Vec<(String, Files)>);

impl Taken {
    /// Takes files for what stands at `place` in the scene with this `path`, unless they meet others.
    pub(super) fn claim(&mut self, place: &str, path: &str, files: Vec<Files>, problems: &mut Problems) {
        let meets = |(_, other): &&(String, Files)| files.iter().any(|own| own.meet(other));
        if let Some((by, other)) = self.0.iter().find(meets) {
            let hint = match other {
                Files::One(_) => format!("`{by}` writes it, or a file where it needs a folder"),
                Files::Frames(stem, ending) => {
                    format!("`{by}` writes {stem}_000000{ending} and so on")
                }
            };
            problems.add(place, format!("`{path}` again"), "a file of its own", hint);
        }
        self.0.extend(files.into_iter().map(|files| (place.to_owned(), files)));
    }
}

/// Whether a path may be written to.
pub(super) fn check_path(place: &str, path: &str, problems: &mut Problems) -> bool {
    let mut parts = Path::new(path).components();
    let inside = !path.is_empty() && parts.all(|part| matches!(part, Component::Normal(_)));
    if !inside || path.ends_with('/') || path.contains(char::is_control) {
        let allowed = "a relative path inside the run folder, such as `series.csv` or `frames/grains`";
        problems.add(place, format!("`{path}`"), allowed, "");
        return false;
    }
    let longest = path.split('/').map(str::len).max().unwrap_or_default();
    if longest > LONGEST_NAME || path.len() > LONGEST_PATH {
        let start: String = path.chars().take(40).collect();
        let value = format!("`{start}...`, {} bytes long", path.len());
        let allowed = format!("names of at most {LONGEST_NAME} bytes, and {LONGEST_PATH} in all");
        problems.add(place, value, allowed, "");
        return false;
    }
    if spelled(path).ends_with(UNDER_WAY) {
        let value = format!("`{path}`, as files are called while they are written");
        problems.add(place, value, format!("a name that does not end with `{UNDER_WAY}`"), "");
        return false;
    }
    let spelled = spelled(path);
    let first = spelled.split('/').next().unwrap_or_default();
    if RESERVED.contains(&first) {
        let value = format!("`{path}`, which the run itself writes");
        problems.add(place, value, format!("any name but {}", RESERVED.join(", ")), "");
        return false;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meet(a: &Files, b: &Files) -> bool {
        assert_eq!(a.meet(b), b.meet(a), "{a:?} {b:?}");
        a.meet(b)
    }

    #[test]
    fn files_meet_when_one_is_the_other_or_would_be_its_folder() {
        let one = |path: &str| Files::One(spelled(path));
        let frames = |stem: &str| Files::Frames(spelled(stem), ".vtp");
        for (a, b) in
            [("a/t.csv", "a//t.csv"), ("a/t.csv", "a/./t.csv"), ("T.csv", "t.csv"), ("a", "a/t.csv")]
        {
            assert!(meet(&one(a), &one(b)), "{a} {b}");
        }
        for (a, b) in [("a/t.csv", "t.csv"), ("a", "ab/t.csv"), ("a/b", "a/c/d")] {
            assert!(!meet(&one(a), &one(b)), "{a} {b}");
        }
        for path in
            ["grains_000003.vtp", "grains_1000000.vtp", "grains_000003.vtp/t.csv", "Grains_000000.vtp"]
        {
            assert!(meet(&frames("grains"), &one(path)), "{path}");
        }
        for path in ["grains_03.vtp", "grains_000003.csv", "grains", "grains/t.csv", "more_grains_000003.vtp"]
        {
            assert!(!meet(&frames("grains"), &one(path)), "{path}");
        }
        assert!(meet(&frames("a"), &frames("a")) && !meet(&frames("a"), &frames("a_000000")));
        assert!(meet(&frames("a/b"), &one("a")) && !meet(&frames("a/b"), &one("b")));
    }

    #[test]
    fn paths_that_cannot_be_written_are_refused() {
        let refused = |path: &str| {
            let mut problems = Problems::default();
            assert_eq!(check_path("outputs.0.write.path", path, &mut problems), problems.0.is_empty());
            !problems.0.is_empty()
        };
        let long = "n".repeat(201);
        for path in
            ["", "/t.csv", "../t.csv", "a/", "t\n.csv", "run.json", "Snapshots//t.csv", "t.csv.tmp", &long]
        {
            assert!(refused(path), "{path}");
        }
        for path in ["t.csv", "a//t.csv", "a.b/c", "tmp", "runs"] {
            assert!(!refused(path), "{path}");
        }
    }
}
