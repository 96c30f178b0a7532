//! `granular report`.

use super::{Common, show};
use clap::Args;
use granular_driver::failure::Failure;
use granular_report::Request;
use serde_json::json;
use std::path::PathBuf;

/// What `granular report` takes.
#[derive(Args, Debug)]
pub(super) struct Report {
    /// Run folders, and folders that hold several runs, such as those of a sweep. Several runs stand side by side.
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// File to write; `report.html` in the folder, or here for several folders, by default.
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Megabytes that the animations of all runs may take. Where they need more, fields keep 8 bits instead of 16, then frames are left
    /// out evenly.
    #[arg(long, value_name = "MB", default_value_t = 56, value_parser = clap::value_parser!(u64).range(1..=2000))]
    largest: u64,
}

impl Report {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Self { folders, out, largest } = self;
        let out = out.unwrap_or_else(|| match folders.as_slice() {
            [one] => one.join("report.html"),
            _ => PathBuf::from("report.html"),
        });
        let request = Request { largest_bytes: largest * 1_000_000, ..Request::new(folders, out) };
        let written = granular_report::write(&request).map_err(|error| Failure::Io(error.to_string()))?;
        if !common.quiet && !common.json {
            written.left_out.iter().for_each(|said| eprintln!("left out: {said}"));
        }
        let path = written.path.display().to_string();
        let value = json!({ "file": path, "bytes": written.bytes, "runs": written.runs, "left_out": written.left_out });
        show(common, &value, || format!("{path} ({:.1} MB)\n", written.bytes as f64 / 1e6));
        Ok(())
    }
}
