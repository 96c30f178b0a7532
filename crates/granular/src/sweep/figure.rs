//! A measured number over an axis of a sweep, as a figure.

use crate::failure::Failure;
use granular_io::figure::{Axis, Chart, Series, Style};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What to draw of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct View {
    /// Axis of the sweep along x, or a number as for y, of which every run has its own; the first
    /// axis by default.
    pub x: Option<String>,
    /// Metric, or `<table>:<column>`, along y; `runout` by default.
    pub y: Option<String>,
    /// Axis of the sweep whose values have a curve each. Over all others the mean is taken.
    pub by: Option<String>,
    /// Whether both axes are logarithmic.
    pub log: bool,
    /// Files of curves from elsewhere: rows of label, x and y after a head line.
    pub references: Vec<PathBuf>,
}

/// The sweep as it was collected.
struct Collected {
    path: PathBuf,
    axes: Vec<String>,
    runs: Vec<Value>,
}

/// Values at one x on one curve.
type Group = (f64, Vec<f64>);
/// Label and points of a curve from elsewhere.
type Curve = (String, Vec<[f64; 2]>);

/// Whether a folder holds a sweep.
pub fn is_sweep(folder: &Path) -> bool {
    folder.join("sweep.json").is_file()
}

/// Draws a measured number over an axis as `<y>.svg` and `.png` in the folder of a sweep; returns the
/// path without ending.
///
/// At each value of an axis stands the mean over the runs that are done, with its standard error as a bar where
/// there are several. Runs that are not done are left out, and a note says so.
///
/// # Errors
/// When the folder is none of a sweep, there is no such axis or number, or a file cannot be read or
/// written.
pub fn plot(folder: &Path, view: &View) -> Result<PathBuf, Failure> {
    let sweep = Collected::read(folder)?;
    let x = sweep.along(view.x.as_deref())?;
    let by = view.by.as_deref().map(|by| sweep.axis(by, "--by")).transpose()?;
    let y = view.y.as_deref().unwrap_or("runout");
    let mut curves: Vec<(String, Vec<Group>)> = Vec::new();
    let (mut averaged, mut left_out) = (0, 0);
    for run in &sweep.runs {
        let (Some(value), Some(at)) = (run["measures"][y].as_f64(), sweep.place(run, x)?) else {
            left_out += 1;
            continue;
        };
        let label = by.map_or(String::new(), |by| format!("{by} = {}", text(&run["values"][by])));
        let groups = entry(&mut curves, label);
        match groups.iter_mut().find(|(known, _)| *known == at) {
            Some((_, values)) => {
                values.push(value);
                averaged = averaged.max(values.len());
            }
            None => groups.push((at, vec![value])),
        }
    }
    if curves.is_empty() {
        return Err(Failure::io("--y", sweep.no_such_number(y)));
    }
    let axis = |label: &str| if view.log { Axis::log(label) } else { Axis::linear(label) };
    let mut chart = Chart::new("", axis(x), axis(y));
    for (colour, (label, curve)) in references(view)?.into_iter().enumerate() {
        chart = chart.with(Series::new(label, curve, Style::Dashed).colour((colour + curves.len()) % 7));
    }
    for (colour, (label, groups)) in curves.into_iter().enumerate() {
        let label = if label.is_empty() { "this sweep".to_owned() } else { label };
        chart = chart.with(series(label, groups).colour(colour % 7));
    }
    if averaged > 1 {
        chart = chart.note(format!("means over up to {averaged} runs, bars: their standard error"));
    }
    if left_out > 0 {
        chart = chart.note(format!("{left_out} of {} runs have no value and are left out", sweep.runs.len()));
    }
    let path = folder.join(y.replace([':', ' ', '/', '[', ']'], "_").trim_end_matches('_'));
    chart.figure().save(&path)?;
    Ok(path)
}

impl Collected {
    fn read(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join("sweep.json");
        let text = std::fs::read_to_string(&path).map_err(|error| Failure::io(path.display(), error))?;
        let facts: Value = serde_json::from_str(&text).map_err(|error| Failure::io(path.display(), error))?;
        let list = |key: &str| facts[key].as_array().cloned().unwrap_or_default();
        let axes = list("axes").iter().filter_map(Value::as_str).map(str::to_owned).collect();
        Ok(Self { path, axes, runs: list("runs") })
    }

    /// The axis of this name.
    fn axis<'a>(&self, name: &'a str, flag: &str) -> Result<&'a str, Failure> {
        if self.axes.iter().any(|axis| axis == name) {
            return Ok(name);
        }
        let axes = self.axes.join(", ");
        Err(Failure::io(flag, format!("`{name}` is no axis of this sweep; allowed: {axes}")))
    }

    /// What is along x: an axis, or a number that runs have measured.
    fn along<'a>(&'a self, name: Option<&'a str>) -> Result<&'a str, Failure> {
        let name = name.or(self.axes.first().map(String::as_str)).unwrap_or_default();
        if self.runs.iter().any(|run| run["measures"][name].is_number()) {
            return Ok(name);
        }
        self.axis(name, "--x").map_err(|failure| match failure {
            Failure::Io(reason) => Failure::Io(format!("{reason}, or a number as for --y")),
            other => other,
        })
    }

    /// Where a run stands along x.
    fn place(&self, run: &Value, x: &str) -> Result<Option<f64>, Failure> {
        if !self.axes.iter().any(|axis| axis == x) {
            return Ok(run["measures"][x].as_f64());
        }
        let label = text(&run["values"][x]);
        let reason = || format!("`{x}` is `{label}` in a run, which begins with no number");
        number(label).map(Some).ok_or_else(|| Failure::io("--x", reason()))
    }

    fn no_such_number(&self, name: &str) -> String {
        let mut names: BTreeMap<&str, ()> = BTreeMap::new();
        for measures in self.runs.iter().filter_map(|run| run["measures"].as_object()) {
            names.extend(measures.keys().map(|name| (name.as_str(), ())));
        }
        let names: Vec<&str> = names.into_keys().collect();
        let place = self.path.display();
        if names.is_empty() {
            return format!("no run in {place} is done, so there is nothing to draw");
        }
        format!("no run in {place} has a number `{name}`; allowed: {}", names.join(", "))
    }
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// The number with which a value begins: 68 of `68 mm`.
fn number(label: &str) -> Option<f64> {
    label.split_whitespace().next()?.parse().ok()
}

fn entry<T>(list: &mut Vec<(String, Vec<T>)>, label: String) -> &mut Vec<T> {
    let at = list.iter().position(|(known, _)| *known == label).unwrap_or_else(|| {
        list.push((label, Vec::new()));
        list.len() - 1
    });
    &mut list[at].1
}

/// Means with the standard errors of them.
fn series(label: String, mut groups: Vec<Group>) -> Series {
    groups.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut points, mut errors) = (Vec::new(), Vec::new());
    for (x, values) in groups {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        points.push([x, mean]);
        errors.push(if count > 1.0 { (squares / (count - 1.0) / count).sqrt() } else { 0.0 });
    }
    if errors.iter().all(|&error| error == 0.0) {
        return Series::new(label, points, Style::Markers);
    }
    Series::new(label, points, Style::ErrorBars(errors))
}

/// Curves of all reference files. A label may hold commas: the last two fields are the numbers.
fn references(view: &View) -> Result<Vec<Curve>, Failure> {
    let mut curves = Vec::new();
    for path in &view.references {
        let content = std::fs::read_to_string(path).map_err(|error| Failure::io(path.display(), error))?;
        let rows = content.lines().enumerate().skip(1);
        for (k, row) in rows.filter(|(_, row)| !row.trim().is_empty() && !row.starts_with('#')) {
            let mut fields = row.rsplitn(3, ',');
            let (y, x, label) = (fields.next(), fields.next(), fields.next());
            let number = |field: Option<&str>| field?.trim().parse::<f64>().ok();
            let (Some(y), Some(x), Some(label)) = (number(y), number(x), label) else {
                let reason = format!("`{row}`: a label, x and y are expected, with commas between");
                return Err(Failure::io(format!("{}:{}", path.display(), k + 1), reason));
            };
            entry(&mut curves, label.trim().trim_matches('"').to_owned()).push([x, y]);
        }
    }
    Ok(curves)
}
