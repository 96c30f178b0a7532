//! `granular validate`.

use super::{Common, show};
use granular::failure::Failure;
use granular::validate::{self, Effort};
use serde_json::json;

/// Flags of `granular validate`.
#[derive(clap::Args, Debug)]
pub(super) struct Validate {
    /// Only cases whose name contains this.
    filter: Option<String>,
    /// Everything, not only what takes a few seconds.
    #[arg(long)]
    full: bool,
}

impl Validate {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let effort = if self.full { Effort::Full } else { Effort::Quick };
        let mut rows = Vec::new();
        for case in validate::find(self.filter.as_deref())? {
            if !common.quiet {
                eprintln!("{}: {}", case.name, case.about);
            }
            rows.extend(case.run(effort));
        }
        show(common, &json!(rows), || validate::table(&rows));
        validate::verdict(&rows)
    }
}
