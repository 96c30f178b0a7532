//! `granular sweep`.

use super::{Common, default_folder, interrupt, show};
use clap::Args;
use granular_driver::failure::Failure;
use granular_driver::sweep::{Plan, Request, Work, array_script};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  granular sweep scene.ron --set sample.aspect_ratio=0.4,0.8,2 --set sample.seed=1..5 --dry-run
  granular sweep scene.ron --set materials.glass.friction=0.1..0.5:5 --jobs 2
  granular sweep scene.ron --set sample.aspect_ratio=0.2..10:log12 --slurm sweep.sh --threads 4

Values: v1,v2,...  a range 1..5 of whole numbers (both ends), 0.2..1:5 (five values in even steps),
0.1..10:log5 (five in even ratios), 10..30:3 mm (with a unit). Commas within brackets and double
quotes belong to a value: 'gravity=[0,-9.81],[0,-1.62]'. A --set of one value holds for all runs.

The folder of the sweep holds one run folder per scene, named by a hash of the scene with all
changes, so that no scene is run twice; table.csv with the values, final metrics and last rows of
the tables of each run; sweep.json with the state of each; failures/ with reasons.

Exit code: that of the first run that failed, 0 when none did, 130 or 143 when interrupted.";

/// What `granular sweep` takes.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Sweep {
    /// Scene file, or - for standard input.
    scene: PathBuf,
    /// A value of the scene to vary, and its values; several make a grid, in which the last one varies fastest.
    #[arg(long, value_name = "PATH=VALUES")]
    set: Vec<String>,
    /// Folder of the sweep; `sweeps/<name of the scene>` by default.
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Number of runs at the same time; each gets its share of the threads.
    #[arg(long, value_name = "N", default_value_t = 1)]
    jobs: usize,
    /// Repeat runs that failed before.
    #[arg(long)]
    retry: bool,
    /// Check all runs and show what would be done with each and how long it would take, without running anything.
    #[arg(long, conflicts_with_all = ["slurm", "only"])]
    dry_run: bool,
    /// Work on this run only, counted from 0, and collect no table.
    #[arg(long, value_name = "INDEX", conflicts_with = "slurm")]
    only: Option<usize>,
    /// Write the script of a Slurm array job with one task per run, and run nothing.
    #[arg(long, value_name = "FILE")]
    slurm: Option<PathBuf>,
}

impl Sweep {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let out = self.out.unwrap_or_else(|| folder_of(&self.scene));
        let request = Request { scene: self.scene, set: self.set };
        let plan = Plan::of(&request)?;
        if let Some(file) = &self.slurm {
            return write_script(common, &plan, &request, &out, file);
        }
        if self.dry_run {
            let forecast = plan.forecast(&out, self.retry)?;
            show(common, &forecast.to_json(), || forecast.to_string());
            return forecast.failure().map_or(Ok(()), Err);
        }
        let work = Work { jobs: self.jobs, retry: self.retry, only: self.only, quiet: common.quiet };
        let outcome = plan.work(&out, work, &interrupt(common, &out)?)?;
        show(common, &outcome.report, || summary(&outcome.report));
        outcome.failure.map_or(Ok(()), Err)
    }
}

fn write_script(
    common: &Common,
    plan: &Plan,
    request: &Request,
    out: &Path,
    file: &Path,
) -> Result<(), Failure> {
    if request.scene == Path::new("-") {
        return Err(Failure::io("--slurm", "the tasks need a scene file; standard input is gone by then"));
    }
    if file.exists() {
        return Err(Failure::io(file.display(), "is there already; name another file"));
    }
    let script = array_script(plan, request, out, common.threads.unwrap_or(1));
    std::fs::write(file, script).map_err(|error| Failure::io(file.display(), error))?;
    let (path, tasks) = (file.display(), plan.points.len());
    show(common, &json!({ "script": path.to_string(), "tasks": tasks }), || {
        format!("{path}: {tasks} tasks; submit it with sbatch\n")
    });
    Ok(())
}

/// `sweeps/<name>`, of the name that a run would have.
fn folder_of(scene: &Path) -> PathBuf {
    let run = default_folder(scene);
    Path::new("sweeps").join(run.file_name().unwrap_or_default())
}

fn summary(report: &Value) -> String {
    let runs = report["runs"].as_array().map_or(&[][..], Vec::as_slice);
    let done = runs.iter().filter(|run| run["exit"] == "done").count();
    let table =
        report["table"].as_str().map_or(String::new(), |table| format!("  {:<26} {table}\n", "table"));
    format!("{done} of {} runs are done\n{table}", runs.len())
}
