//! What users of the crate rely on: files that survive a resume, a kill and a full disk, and that
//! refuse what does not fit.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail like tests")]

mod files;
mod hash;
#[cfg(unix)]
mod kill;
mod places;
mod resume;

use std::path::PathBuf;

#[global_allocator]
static ALLOCATOR: granular_core::testing::CountingAllocator =
    granular_core::testing::CountingAllocator::new();

/// A folder in the build folder, empty at first.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Names of the files in a folder, sorted.
fn names(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
