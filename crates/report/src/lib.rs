//! One self-contained HTML page about one or several runs of granular simulations.
//!
//! A run folder is what `granular run` leaves: `run.json`, the scene, tables (`.csv`), fields over time (`.pvd` with its `.vtp` and
//! `.vti` files) and figures. [`write()`] reads it and writes one file that needs no network and no other file. What a folder lacks is
//! left out of the page, which says so in a sentence.
//!
//! ```no_run
//! let request = granular_report::Request::new(["runs/loose", "runs/dense"], "density.html");
//! let written = granular_report::write(&request)?;
//! println!("{} runs, {} bytes", written.runs, written.bytes);
//! # Ok::<(), granular_report::ReportError>(())
//! ```
//!
//! # How exact the page is
//!
//! Places are kept as whole numbers of 16 bits between the ends of what is seen in the whole run, so they are off by at most 1/131 070 of that. Fields have 16
//! bits too, or 8 where the page would be larger than [`Request::largest_bytes`]; if that is not enough, frames are left out evenly. The
//! page states what was taken. Tables keep all digits; of very long ones every k-th row is kept.
//!
//! # Limits
//!
//! - Of fields on a grid in space the page holds the planes through its middle.
//! - Contacts (`.vtp` files of lines) and `.vtkhdf` files are not shown.
//! - Frames are read twice, one at a time: once for the ends of their values, once to write them.

mod arrays;
mod error;
mod figures;
mod folder;
mod frame;
mod movie;
mod page;
mod quantise;
mod scene;
mod tables;

pub use error::ReportError;
pub use quantise::{Bits, Quantiser};

use std::path::{Path, PathBuf};

/// What a page is made of.
#[derive(Clone, Debug)]
pub struct Request {
    /// Run folders. One that holds several runs, as of a sweep or of a scene whose solvers nothing joins, stands for these.
    pub folders: Vec<PathBuf>,
    /// File to write.
    pub out: PathBuf,
    /// Bytes that the animations of all runs may take in the page.
    pub largest_bytes: u64,
}

impl Request {
    /// A page of at most about 56 MB about these folders.
    pub fn new<P: AsRef<Path>>(folders: impl IntoIterator<Item = P>, out: impl AsRef<Path>) -> Self {
        let folders = folders.into_iter().map(|folder| folder.as_ref().to_owned()).collect();
        Self { folders, out: out.as_ref().to_owned(), largest_bytes: 56_000_000 }
    }
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub path: PathBuf,
    /// Its size.
    pub bytes: u64,
    /// Number of runs on it.
    pub runs: usize,
    /// What was left out, in sentences that begin with the folder.
    pub left_out: Vec<String>,
}

/// Writes a page about runs.
///
/// # Errors
/// When no folder is given, one of them is no run folder, or the page cannot be written; an old file of its path stays. A single
/// file of a run that cannot be read is left out and told of in [`Written::left_out`].
pub fn write(request: &Request) -> Result<Written, ReportError> {
    if request.out.is_dir() {
        return Err(ReportError::new(
            &request.out,
            "is a folder",
            "the name of a file",
            "add one, such as report.html",
        ));
    }
    let runs = folder::open_all(&request.folders)?;
    page::write(&runs, request)
}
