//! `granular compare`.

use super::{Common, show};
use clap::Args;
use granular_driver::compare::{self, Request};
use granular_driver::failure::Failure;
use serde_json::json;
use std::path::PathBuf;

/// What `granular compare` takes.
#[derive(Args, Debug)]
pub(super) struct Compare {
    /// Run folders, folders of several runs, and CSV files from elsewhere, whose first column is what the others are over, such
    /// as `time [s]`. The first one is what the others are compared with.
    #[arg(required = true, value_name = "FOLDER or FILE")]
    sources: Vec<PathBuf>,
    /// Names of what is compared, such as front,height; all that two of them share by default.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    columns: Vec<String>,
    /// Stage from whose start times count.
    #[arg(long, value_name = "STAGE")]
    stage: Option<String>,
    /// Folder for the figure and the table.
    #[arg(short, long, value_name = "FOLDER", default_value = "compare")]
    out: PathBuf,
}

impl Compare {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Self { sources, columns, stage, out } = self;
        let found = compare::compare(&Request { sources, columns, stage })?;
        let paths = found.save(&out)?;
        let paths: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        show(common, &json!({ "rows": found.rows, "left_out": found.left_out, "files": paths }), || {
            format!("{found}{}\n", paths.join(", "))
        });
        Ok(())
    }
}
