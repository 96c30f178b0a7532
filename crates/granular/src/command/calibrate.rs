//! `granular calibrate`.

use super::{Common, Edits, read, show};
use granular::calibrate::{self, Plan};
use granular::failure::Failure;
use granular::scene::Scene;
use granular::validate::Effort;
use serde_json::json;
use std::path::PathBuf;

/// What is calibrated.
#[derive(clap::Subcommand, Debug)]
pub(super) enum Calibrate {
    /// Friction, dilation, solid fraction and stiffness, from shear of the grains of a scene in a periodic cell; about a
    /// minute. Writes a material for continuum solvers.
    Friction {
        /// Scene file, or - for standard input; its grading, material and dimension count.
        scene: PathBuf,
        #[command(flatten)]
        edits: Edits,
        /// More and larger samples and slower shear; takes hours.
        #[arg(long)]
        full: bool,
        /// File for the material, which must not be there yet; printed only by default.
        #[arg(short, long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
}

impl Calibrate {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Self::Friction { scene, edits, full, out } = self;
        let text = read(&scene, &edits)?;
        let scene: Scene = text.parse().map_err(|problem| Failure::Scene(vec![problem]))?;
        if let Some(path) = out.as_ref().filter(|path| path.exists()) {
            return Err(Failure::io(path.display(), "is there already; name another file"));
        }
        let plan = Plan::of(if full { Effort::Full } else { Effort::Quick });
        let file = calibrate::friction(&scene, &plan)?;
        if let Some(path) = &out {
            std::fs::write(path, file.to_ron()?).map_err(|error| Failure::io(path.display(), error))?;
        }
        show(common, &json!(file), || calibrate::table(&file));
        Ok(())
    }
}
