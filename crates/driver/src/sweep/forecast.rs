//! What a sweep would do, and how long it would take.

use super::work::failed_runs;
use super::{Plan, State};
use crate::check;
use crate::failure::Failure;
use crate::parts::{self, Part};
use crate::progress::duration;
use crate::scene_file::SceneText;
use serde_json::{Value, json};
use std::fmt;
use std::path::Path;

/// What a sweep would do, run by run.
#[derive(Clone, Debug)]
pub struct Forecast {
    runs: Vec<Expected>,
    axes: Vec<String>,
}

/// What would come of one run.
#[derive(Clone, Debug)]
struct Expected {
    folder: String,
    labels: Vec<String>,
    would: &'static str,
    /// Longest run time \[s\], for runs that would be run; of all of a run, also where it goes on.
    seconds: f64,
    /// Exit code and reason, when it cannot be run.
    trouble: Option<(u8, String)>,
}

impl Plan {
    /// Checks all runs that [`Plan::work`] would run and measures their speed; runs nothing.
    ///
    /// # Errors
    /// When the folder is none of a sweep or cannot be read.
    pub fn forecast(&self, out: &Path, retry: bool) -> Result<Forecast, Failure> {
        self.refuse_folder(out)?;
        let mut runs = Vec::new();
        for (index, point) in self.points.iter().enumerate() {
            let state = State::of(out, &point.folder)?;
            let mut expected = Expected {
                folder: point.folder.clone(),
                labels: point.labels.clone(),
                would: state.outlook(retry),
                seconds: 0.0,
                trouble: None,
            };
            if state.is_to_run(retry) {
                match seconds_of(&point.text) {
                    Ok(seconds) => expected.seconds = seconds,
                    Err(failure) => {
                        expected.would = "fail";
                        expected.trouble = Some((failure.code(), format!("{}: {failure}", self.name(index))));
                    }
                }
            }
            runs.push(expected);
        }
        Ok(Forecast { runs, axes: self.axes.clone() })
    }
}

/// How long a scene takes at most \[s\], all its parts together.
fn seconds_of(text: &SceneText) -> Result<f64, Failure> {
    let seconds = |part: Part| {
        let report = check::check(&part.text)?;
        if report.problems.is_empty() { Ok(report.estimated_seconds) } else { Err(report.refusal()) }
    };
    parts::of(text)?.into_iter().map(seconds).sum()
}

impl Forecast {
    /// Longest time of all that would be run, one after the other, with the present number of threads \[s\].
    pub fn seconds(&self) -> f64 {
        self.runs.iter().map(|run| run.seconds).sum()
    }

    /// The runs that cannot be run, as one failure.
    pub fn failure(&self) -> Option<Failure> {
        let troubles: Vec<(u8, String)> = self.runs.iter().filter_map(|run| run.trouble.clone()).collect();
        let help = "a sweep would run the others and report these";
        (!troubles.is_empty()).then(|| failed_runs(&troubles, self.runs.len(), help))
    }

    /// For scripts.
    pub fn to_json(&self) -> Value {
        let runs = self.runs.iter().enumerate().map(|(index, run)| {
            let values: serde_json::Map<String, Value> =
                self.axes.iter().cloned().zip(run.labels.iter().map(|label| json!(label))).collect();
            json!({
                "index": index,
                "folder": run.folder,
                "values": values,
                "would": run.would,
                "estimated_seconds": run.seconds,
                "reason": run.trouble.as_ref().map(|(_, reason)| reason),
            })
        });
        let runs: Vec<Value> = runs.collect();
        json!({ "axes": self.axes, "runs": runs, "estimated_seconds": self.seconds() })
    }
}

impl fmt::Display for Forecast {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = ["run", "folder"].into_iter().chain(self.axes.iter().map(String::as_str));
        let mut rows = vec![head.chain(["would"]).map(str::to_owned).collect::<Vec<_>>()];
        for (index, run) in self.runs.iter().enumerate() {
            let mut row = vec![index.to_string(), run.folder.clone()];
            row.extend(run.labels.iter().cloned());
            row.push(match run.seconds {
                0.0 => run.would.to_owned(),
                seconds => format!("{}, at most {}", run.would, duration(seconds)),
            });
            rows.push(row);
        }
        let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
        for row in &rows {
            let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}"));
            writeln!(f, "{}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
        }
        let count = |what: &str| self.runs.iter().filter(|run| run.would == what).count();
        let stay = self.runs.len() - count("start") - count("resume") - count("fail");
        writeln!(
            f,
            "{} runs: {} would start, {} resume, {} fail, {stay} stay; at most {} with {} threads, one after the other",
            self.runs.len(),
            count("start"),
            count("resume"),
            count("fail"),
            duration(self.seconds()),
            rayon::current_num_threads()
        )
    }
}
