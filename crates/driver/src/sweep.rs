//! A grid of runs of one scene, in folders named by what is run.
//!
//! A sweep can be stopped at any moment and taken up by the same command: a run that is done is not
//! done again, one that was interrupted goes on from its snapshot. A run that failed is reported and
//! left alone, until it is asked for. All rests on the folders: `<hash>/` holds a run as `granular run`
//! leaves it, `failures/<hash>.json` says why one failed, `table.csv` collects what was measured,
//! `sweep.json` lists the runs, and files in `locks/` keep processes from working on one run at the
//! same time.
//!
//! ```
//! use granular_driver::run::Interrupt;
//! use granular_driver::sweep::{Plan, Request, Work};
//!
//! # let folder = std::env::temp_dir().join(format!("granular-sweep-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder).unwrap();
//! # let (scene, out) = (folder.join("scene.ron"), folder.join("sweep"));
//! # let template = granular_driver::TEMPLATES.iter().find(|(name, _)| *name == "disk-on-incline").unwrap();
//! # std::fs::write(&scene, template.1).unwrap();
//! let set = vec!["materials.rock.friction=0.1,0.3".to_owned(), "stages.0.end=For(\"4 ms\")".to_owned()];
//! let plan = Plan::of(&Request { scene, set })?;
//! assert_eq!(plan.points.len(), 2);
//! let outcome = plan.work(&out, Work::default(), &Interrupt::default())?;
//! assert_eq!(outcome.report["runs"][1]["exit"], "done");
//! # std::fs::remove_dir_all(folder).unwrap();
//! # Ok::<(), granular_driver::failure::Failure>(())
//! ```

mod axis;
mod figure;
mod forecast;
mod slurm;
mod state;
mod table;
mod work;

pub use axis::Axis;
pub use figure::{View, is_sweep, plot};
pub use forecast::Forecast;
pub use slurm::array_script;
pub use state::State;
pub use work::{Outcome, Work};

use crate::failure::Failure;
use crate::lock::Lock;
use crate::scene::Scene;
use crate::scene_file::{SceneProblem, SceneText};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// What to sweep, before it is read.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Scene file, or `-` for standard input.
    pub scene: PathBuf,
    /// Changes, each `path=v1,v2,...` as [`Axis::of`] reads it, made in this order.
    pub set: Vec<String>,
}

/// One run of the grid.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its value on each axis that varies, as tables show it.
    pub labels: Vec<String>,
    /// The scene with all changes.
    pub text: SceneText,
    /// Name of the folder: a hash of what is run, the files that the scene reads included.
    pub folder: String,
}

/// All runs of a grid.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Scene that was asked for.
    pub source: PathBuf,
    /// Places of the scene that vary.
    pub axes: Vec<String>,
    /// The runs, in the order of the table: the last axis is the fastest.
    pub points: Vec<Point>,
}

impl Plan {
    /// Reads a scene and lays out the grid. Every scene of it can be read.
    ///
    /// # Errors
    /// When the file or a change is wrong, nothing varies, or two points are the same run.
    pub fn of(request: &Request) -> Result<Self, Failure> {
        let base = SceneText::read(&request.scene)?;
        let axes = request.set.iter().map(|text| Axis::of(text)).collect::<Result<Vec<_>, _>>()?;
        if !axes.iter().any(Axis::varies) {
            let problem = SceneProblem::of_file("--set", "nothing varies: a sweep needs two values at least");
            let hint = "for example `--set sample.aspect_ratio=0.4,0.8,2` or `--set sample.seed=1..5`";
            return Err(problem.with_hint(hint).into());
        }
        for (k, axis) in axes.iter().enumerate() {
            if axes[..k].iter().any(|other| other.path == axis.path) {
                let message = format!("`{}` is set twice", axis.path);
                let hint = format!("give all its values at once: `--set {}=v1,v2,...`", axis.path);
                return Err(SceneProblem::of_file("--set", message).with_hint(hint).into());
            }
        }
        axis::refuse_many(&axes, base.text().len())?;
        let points = axis::grid(&axes).into_iter().map(|values| Point::of(&base, &axes, &values));
        let points = points.collect::<Result<Vec<_>, SceneProblem>>()?;
        refuse_twins(&points)?;
        let axes = axes.into_iter().filter(Axis::varies).map(|axis| axis.path).collect();
        Ok(Self { source: request.scene.clone(), axes, points })
    }

    /// Collects what is done into `table.csv` and lists all runs in `sweep.json`; returns that list.
    ///
    /// # Errors
    /// When a file cannot be read or written.
    pub fn collect(&self, out: &Path) -> Result<Value, Failure> {
        // Sweeps that share a folder may end at the same moment.
        let _lock = Lock::wait(&lock_path(out, "table"))?;
        let mut runs = Vec::new();
        for point in &self.points {
            runs.push((point, State::of(out, &point.folder)?, table::measures(out, point)?));
        }
        let axes: Vec<&str> = self.axes.iter().map(String::as_str).collect();
        let path = out.join("table.csv");
        table::write(&path, &table::text(&axes, &runs))?;
        let mut report = self.list(runs.iter().map(|(_, state, _)| state.clone()));
        report["table"] = json!(path.display().to_string());
        for (k, (.., measures)) in runs.iter().enumerate() {
            let number = |value: &str| json!(value.parse::<f64>().ok());
            let measures = measures.iter().map(|(name, value)| (name.clone(), number(value)));
            report["runs"][k]["measures"] = Value::Object(measures.collect());
        }
        state::write_json(&out.join("sweep.json"), &report)?;
        Ok(report)
    }

    /// All runs and how far they are.
    fn list(&self, states: impl Iterator<Item = State>) -> Value {
        let runs = self.points.iter().zip(states).enumerate().map(|(index, (point, state))| {
            let values: Map<String, Value> =
                self.axes.iter().cloned().zip(point.labels.iter().map(|label| json!(label))).collect();
            let (exit, reason) = (state.name(), state.reason());
            json!({ "index": index, "folder": point.folder, "values": values, "exit": exit, "reason": reason })
        });
        let runs: Vec<Value> = runs.collect();
        json!({ "scene": self.source.display().to_string(), "axes": self.axes, "runs": runs })
    }

    /// What a run is called in messages: its number, values and folder.
    fn name(&self, index: usize) -> String {
        let point = &self.points[index];
        let values = self.axes.iter().zip(&point.labels).map(|(axis, label)| format!("{axis}={label}"));
        format!("run {index} ({}; {})", values.collect::<Vec<_>>().join(", "), point.folder)
    }
}

impl Point {
    fn of(base: &SceneText, axes: &[Axis], values: &[String]) -> Result<Self, SceneProblem> {
        let mut text = base.clone();
        for (axis, value) in axes.iter().zip(values) {
            text.set(&format!("{}={value}", axis.path))?;
        }
        let folder = format!("{:016x}", Scene::of(&text)?.content_hash(&text));
        let varying = axes.iter().zip(values).filter(|(axis, _)| axis.varies());
        Ok(Self { labels: varying.map(|(_, value)| axis::label_of(value)).collect(), text, folder })
    }
}

/// File whose lock keeps processes from working on the run in this folder, or on the table. It stands beside the
/// folders, since a refused run has none.
fn lock_path(out: &Path, name: &str) -> PathBuf {
    out.join("locks").join(name)
}

/// Values that are written differently may still be the same scene, such as `4 mm` and `"4 mm"`.
fn refuse_twins(points: &[Point]) -> Result<(), SceneProblem> {
    let mut known = std::collections::BTreeMap::new();
    for point in points {
        if let Some(twin) = known.insert(&point.folder, point) {
            let (one, other) = (twin.labels.join(", "), point.labels.join(", "));
            let message = format!("`{one}` and `{other}` are the same run; allowed: values that differ");
            return Err(SceneProblem::of_file("--set", message));
        }
    }
    Ok(())
}
