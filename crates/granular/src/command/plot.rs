//! `granular plot`.

use super::{Common, show};
use clap::Args;
#[cfg(feature = "dem")]
use granular_driver::calibrate;
use granular_driver::failure::Failure;
use granular_driver::{run, sweep};
use serde_json::json;
use std::path::PathBuf;

/// What `granular plot` takes.
#[derive(Args, Debug)]
pub(super) struct Plot {
    /// Folder of a run or of a sweep; several sweeps are drawn in one figure, in the folder of the first. Or a material
    /// file of `granular calibrate`; the figure is written next to it.
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// For a sweep: the axis along x, the first one by default; or a column of its table, with a point for each run.
    #[arg(long, value_name = "AXIS")]
    x: Option<String>,
    /// For a sweep: the number along y, a column of its table; `runout` by default.
    #[arg(long, value_name = "COLUMN")]
    y: Option<String>,
    /// For a sweep: the axis with one curve per value. Values are averaged over all other axes.
    #[arg(long, value_name = "AXIS")]
    by: Option<String>,
    /// For a sweep: logarithmic axes.
    #[arg(long)]
    log: bool,
    /// For a sweep: fit a power law to each curve between these x, such as 4..10; may be repeated.
    #[arg(long = "fit", value_name = "LOW..HIGH", value_parser = range)]
    fits: Vec<[f64; 2]>,
    /// For a sweep: a CSV file with curves from elsewhere, with a header and the columns label, x and y.
    #[arg(long = "reference", value_name = "FILE")]
    references: Vec<PathBuf>,
}

impl Plot {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Self { folders, x, y, by, log, fits, references } = self;
        let view = sweep::View { x, y, by, log, fits, references };
        let runs: Vec<&PathBuf> = folders.iter().filter(|folder| !sweep::is_sweep(folder)).collect();
        let mut failed = Vec::new();
        let paths = match runs.first() {
            None => vec![sweep::plot(&folders, &view)?],
            #[cfg(feature = "dem")]
            Some(file) if folders.len() == 1 && view == sweep::View::default() && file.is_file() => {
                vec![calibrate::plot(file)?]
            }
            Some(run) if folders.len() == 1 && view == sweep::View::default() => {
                let drawn = run::plot(run)?;
                drawn.left_out.iter().for_each(|said| eprintln!("warning: {said}"));
                failed = drawn.failed;
                drawn.paths
            }
            Some(run) => {
                let reason = "holds no sweep (no sweep.json); several folders, --x, --y, --by, --log, --fit and \
                              --reference are for sweeps";
                return Err(Failure::io(run.display(), reason));
            }
        };
        let lines: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        // One JSON value: the failure, if there is one.
        if failed.is_empty() || !common.json {
            show(common, &json!(lines), || {
                lines.iter().map(|path| format!("{path}.svg, {path}.png\n")).collect()
            });
        }
        // Those that can be drawn are drawn.
        if failed.is_empty() { Ok(()) } else { Err(Failure::Io(failed.join("\nerror: "))) }
    }
}

/// Reads `4..10`.
fn range(text: &str) -> Result<[f64; 2], String> {
    let ends = text.split_once("..").and_then(|(low, high)| Some([low.parse().ok()?, high.parse().ok()?]));
    let ends = ends.filter(|[low, high]: &[f64; 2]| *low > 0.0 && low < high && high.is_finite());
    ends.ok_or_else(|| "two numbers above zero are expected, the smaller first, such as 4..10".to_owned())
}
