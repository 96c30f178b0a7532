//! `granular plot`.

use super::{Common, show};
use clap::Args;
use granular::failure::Failure;
use granular::{run, sweep};
use serde_json::json;
use std::path::PathBuf;

/// What `granular plot` takes.
#[derive(Args, Debug)]
pub(super) struct Plot {
    /// Folder of a run or of a sweep.
    folder: PathBuf,
    /// Of a sweep: the axis along x, its first one by default; or a column of its table, of which each run has its own value.
    #[arg(long, value_name = "AXIS")]
    x: Option<String>,
    /// Of a sweep: the number along y, a column of its table; `runout` by default.
    #[arg(long, value_name = "COLUMN")]
    y: Option<String>,
    /// Of a sweep: the axis whose values have a curve each. Over all others the mean is taken.
    #[arg(long, value_name = "AXIS")]
    by: Option<String>,
    /// Of a sweep: logarithmic axes.
    #[arg(long)]
    log: bool,
    /// Of a sweep: a CSV file of curves from elsewhere, with rows of label, x and y under a head line.
    #[arg(long = "reference", value_name = "FILE")]
    references: Vec<PathBuf>,
}

impl Plot {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Self { folder, x, y, by, log, references } = self;
        let view = sweep::View { x, y, by, log, references };
        let paths = if sweep::is_sweep(&folder) {
            vec![sweep::plot(&folder, &view)?]
        } else if view == sweep::View::default() {
            run::plot(&folder)?
        } else {
            let reason =
                "holds no sweep (no sweep.json); --x, --y, --by, --log and --reference are for sweeps";
            return Err(Failure::io(folder.display(), reason));
        };
        let lines: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        show(common, &json!(lines), || {
            lines.iter().map(|path| format!("{path}.svg, {path}.png\n")).collect()
        });
        Ok(())
    }
}
