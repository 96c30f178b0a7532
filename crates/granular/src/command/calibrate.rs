//! `granular calibrate`.

use super::{Common, Edits, read, show};
use granular_driver::Effort;
use granular_driver::calibrate::{self, Plan};
use granular_driver::failure::Failure;
use granular_driver::scene::Scene;
use serde_json::json;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// How often it is told how many runs are done.
const SAYS_EVERY: Duration = Duration::from_secs(10);

/// What is calibrated.
#[derive(clap::Subcommand, Debug)]
pub(super) enum Calibrate {
    /// Friction, dilation, solid fraction and stiffness, from shear of the grains of a scene in a periodic cell; takes
    /// about a minute. Writes a material for continuum solvers, and a figure.
    Friction {
        /// Scene file, or - for standard input; its grading, material and dimension are used.
        scene: PathBuf,
        #[command(flatten)]
        edits: Edits,
        /// More and larger samples and slower shear; takes hours.
        #[arg(long)]
        full: bool,
        /// Grains in a sample; 200 by default, 1000 with --full.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(20..=1_000_000))]
        grains: Option<u64>,
        /// Samples per flow; 3 by default, 6 with --full.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
        seeds: Option<u64>,
        /// File for the material, such as glass.ron, which must not exist yet; the figure is written next to it as .svg
        /// and .png. By default the material is only printed.
        #[arg(short, long, value_name = "FILE", value_parser = material_file)]
        out: Option<PathBuf>,
    },
}

impl Calibrate {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Self::Friction { scene, edits, full, grains, seeds, out } = self;
        let text = read(&scene, &edits)?;
        let scene: Scene = text.parse().map_err(|problem| Failure::Scene(vec![problem]))?;
        if let Some(path) = out.as_ref().filter(|path| path.exists()) {
            return Err(Failure::io(path.display(), "is there already; name another file"));
        }
        let mut plan = Plan::of(if full { Effort::Full } else { Effort::Quick });
        plan.grains = grains.map_or(plan.grains, |grains| grains as usize);
        plan.seeds = seeds.unwrap_or(plan.seeds);
        let said = Mutex::new(Instant::now());
        let file = calibrate::friction(&scene, &plan, &|done, of| {
            let mut said = said.lock().expect("no holder panics");
            if !common.quiet && said.elapsed() > SAYS_EVERY {
                *said = Instant::now();
                // A courtesy: nobody may be listening.
                let _ = writeln!(std::io::stderr(), "{done} of {of} runs are done");
            }
        })?;
        let mut files = String::new();
        if let Some(path) = &out {
            std::fs::write(path, file.to_ron()?).map_err(|error| Failure::io(path.display(), error))?;
            let figure = calibrate::plot(path)?;
            files = format!("\nwritten: {}, {1}.svg, {1}.png\n", path.display(), figure.display());
        }
        show(common, &json!(file), || calibrate::table(&file) + &files);
        Ok(())
    }
}

/// A path that has an ending, which the figures beside it replace by theirs.
fn material_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(ending) if ending != "svg" && ending != "png" => Ok(path),
        _ => Err("a file name with an ending such as .ron is expected".to_owned()),
    }
}
