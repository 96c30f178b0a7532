//! A measured number over an axis of a sweep, as a figure.

use crate::failure::Failure;
use crate::statistics::{PowerLaw, mean_and_error};
use granular_io::csv_rows;
use granular_io::figure::{Axis, Chart, Series, Style};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What to draw of a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// Least and largest x between which a power law is fitted to each curve; several for several laws.
    pub fits: Vec<[f64; 2]>,
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

/// Draws a measured number over an axis as `<y>.svg` and `.png` in the folder of the first of these
/// sweeps; returns the path without ending.
///
/// At each value of an axis stands the mean over the runs that are done. Where these differ in seeds only, the bar is
/// its standard error; where they differ in another axis too, they are no sample of one number, and the bar is their
/// standard deviation. A note says over what was averaged. Runs that are not done are left out, and a note says so.
///
/// # Errors
/// When a folder is none of a sweep, there is no such axis or number, or a file cannot be read or
/// written.
pub fn plot(folders: &[PathBuf], view: &View) -> Result<PathBuf, Failure> {
    let y = view.y.as_deref().unwrap_or("runout");
    let mut curves = Vec::new();
    let (mut counts, mut labels) = (Counts::default(), None);
    for folder in folders {
        let sweep = Collected::read(folder)?;
        let name = folder.file_name().filter(|_| folders.len() > 1).unwrap_or_default();
        let of_solvers = sweep.solvers_with(y);
        for (k, solver) in of_solvers.iter().enumerate() {
            // Runs count once, however many curves they have.
            let before = (counts.runs, counts.left_out);
            let name = name.to_string_lossy();
            let parts = [&*name, solver.trim_end_matches('.')];
            let label = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
            sweep.add_curves(&label, [solver, y], view, &mut curves, &mut counts)?;
            if k > 0 {
                (counts.runs, counts.left_out) = before;
            }
        }
        // One solver's number has its unit; `continuum.` is told by the label of the curve.
        let solver = of_solvers.first().copied().unwrap_or_default();
        let of_solver = |name: &str| sweep.column_of(solver, name).trim_start_matches(solver).to_owned();
        let x = sweep.along(solver, view.x.as_deref())?.trim_start_matches(solver).to_owned();
        labels.get_or_insert([x, of_solver(y)]);
    }
    let [x_label, y_label] = labels.unwrap_or_default();
    let chart = chart([&x_label, &y_label], view, curves, &counts)?;
    let place = folders.first().map_or(Path::new("."), PathBuf::as_path);
    let path = place.join(y.replace([':', ' ', '/', '[', ']'], "_").trim_end_matches('_'));
    chart.figure().save(&path)?;
    Ok(path)
}

/// What notes tell.
#[derive(Default)]
struct Counts {
    runs: usize,
    left_out: usize,
    /// Most runs of which a mean was taken.
    averaged: usize,
    /// Values of the first run of each mean, by its curve and place along x.
    first: BTreeMap<(String, u64), Value>,
    /// Axes other than seeds over which means were taken.
    mixed: BTreeSet<String>,
}

/// Whether an axis is a seed: runs along it differ by chance only.
fn is_seed(axis: &str) -> bool {
    axis.rsplit('.').next() == Some("seed")
}

/// Label of a series, and its values by x.
type Groups = (String, Vec<Group>);

fn chart([x, y]: [&str; 2], view: &View, curves: Vec<Groups>, counts: &Counts) -> Result<Chart, Failure> {
    let axis = |label: &str| if view.log { Axis::log(label) } else { Axis::linear(label) };
    let mut chart = Chart::new("", axis(x), axis(y));
    for (colour, (label, curve)) in references(view)?.into_iter().enumerate() {
        chart = chart.with(Series::new(label, curve, Style::Dashed).colour((colour + curves.len()) % 7));
    }
    for (colour, (label, groups)) in curves.into_iter().enumerate() {
        let label = if label.is_empty() { "this sweep".to_owned() } else { label };
        let series = series(label.clone(), groups, counts.mixed.is_empty()).colour(colour % 7);
        let mut before: Option<PowerLaw> = None;
        for &range in &view.fits {
            let law = power_law(&series.points, range).ok_or_else(|| {
                let [low, high] = range;
                let reason = "has no three points there, all above zero";
                Failure::io("--fit", format!("`{label}` {reason}: {low} to {high}"))
            })?;
            let meets = before.and_then(|before| before.meets(&law));
            let meets = meets.map_or(String::new(), |x| format!("; meets the one before at {x:.4}"));
            chart = chart
                .with(drawn(&law, range).colour(colour % 7))
                .note(format!("{label}: fitted {law}{meets}"));
            before = Some(law);
        }
        chart = chart.with(series);
    }
    if counts.averaged > 1 {
        let Counts { averaged, mixed, .. } = counts;
        chart = if mixed.is_empty() {
            chart.note(format!("means over up to {averaged} runs, bars: their standard error"))
        } else {
            let mixed = mixed.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
            chart
                .note(format!("means over all values of {mixed}, up to {averaged} runs: no repetitions;"))
                .note("bars: standard deviation. --by has a curve for each value")
        };
    }
    if counts.left_out > 0 {
        let Counts { runs, left_out, .. } = counts;
        chart = chart.note(format!("{left_out} of {runs} runs have no value and are left out"));
    }
    Ok(chart)
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

    /// Adds the curves of this sweep; their labels begin with its `name`.
    fn add_curves(
        &self,
        name: &str,
        [solver, y]: [&str; 2],
        view: &View,
        curves: &mut Vec<Groups>,
        counts: &mut Counts,
    ) -> Result<(), Failure> {
        let (x, y) = (self.along(solver, view.x.as_deref())?, self.column_of(solver, y));
        let by = view.by.as_deref().map(|by| self.axis(by, "--by")).transpose()?;
        let before = counts.left_out;
        for run in &self.runs {
            counts.runs += 1;
            let (Some(value), Some(at)) = (run["measures"][y].as_f64(), self.place(run, x)?) else {
                counts.left_out += 1;
                continue;
            };
            let of_axis = by.map(|by| format!("{by} = {}", text(&run["values"][by])));
            let parts = [name].into_iter().chain(of_axis.as_deref()).filter(|part| !part.is_empty());
            let label = parts.collect::<Vec<_>>().join(", ");
            // Runs of one mean that differ in more than their seeds are no repetitions.
            let values = &run["values"];
            let first = counts.first.entry((label.clone(), at.to_bits())).or_insert_with(|| values.clone());
            let differs = |axis: &&String| {
                !is_seed(axis) && *axis != x && first[axis.as_str()] != values[axis.as_str()]
            };
            counts.mixed.extend(self.axes.iter().filter(differs).cloned());
            let groups = entry(curves, label);
            match groups.iter_mut().find(|(known, _)| *known == at) {
                Some((_, values)) => {
                    values.push(value);
                    counts.averaged = counts.averaged.max(values.len());
                }
                None => groups.push((at, vec![value])),
            }
        }
        if counts.left_out - before == self.runs.len() {
            return Err(Failure::io("--y", self.no_such_number(y)));
        }
        Ok(())
    }

    /// The axis of this name.
    fn axis<'a>(&self, name: &'a str, flag: &str) -> Result<&'a str, Failure> {
        if self.axes.iter().any(|axis| axis == name) {
            return Ok(name);
        }
        let axes = self.axes.join(", ");
        Err(Failure::io(flag, format!("`{name}` is not an axis of this sweep; allowed: {axes}")))
    }

    /// What is along x: an axis, or a number that runs have measured, of a solver where each has its own.
    fn along<'a>(&'a self, solver: &str, name: Option<&'a str>) -> Result<&'a str, Failure> {
        let name = name.or(self.axes.first().map(String::as_str)).unwrap_or_default();
        let column = self.column_of(solver, name);
        if self.runs.iter().any(|run| run["measures"][column].is_number()) {
            return Ok(column);
        }
        self.axis(name, "--x").map_err(|failure| match failure {
            Failure::Io(reason) => Failure::Io(format!("{reason}, or a number as for --y")),
            other => other,
        })
    }

    fn columns(&self) -> impl Iterator<Item = &String> {
        self.runs.iter().filter_map(|run| run["measures"].as_object()).flat_map(|measures| measures.keys())
    }

    /// Solvers that have a number of this name, `grains.` and `continuum.` of scenes in which several run; one without a name
    /// where the number is nobody's, or no run has it.
    fn solvers_with(&self, name: &str) -> Vec<&str> {
        if self.columns().any(|column| is_called(column, name)) {
            return vec![""];
        }
        let of_solver = |column: &'_ String| {
            let (solver, _) = column.split_once('.')?;
            let solver = &column[..=solver.len()];
            is_called(&column[solver.len()..], name).then_some(solver.len())
        };
        let found: BTreeSet<&str> =
            self.columns().filter_map(|column| Some(&column[..of_solver(column)?])).collect();
        if found.is_empty() { vec![""] } else { found.into_iter().collect() }
    }

    /// The column of this name, which may leave its unit out (`runout` is `runout [1]`) and its solver.
    fn column_of<'a>(&'a self, solver: &str, name: &'a str) -> &'a str {
        let found = |prefix: &str| {
            self.columns()
                .find(|column| column.strip_prefix(prefix).is_some_and(|column| is_called(column, name)))
        };
        found("").or_else(|| found(solver)).map_or(name, String::as_str)
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

/// Whether a column has this name, with its unit or without.
fn is_called(column: &str, name: &str) -> bool {
    column == name || column.split_once(" [").is_some_and(|(bare, _)| bare == name)
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

/// Means with their standard errors, or where the values are no repetitions with the standard deviations.
fn series(label: String, mut groups: Vec<Group>, are_repetitions: bool) -> Series {
    groups.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut points, mut errors) = (Vec::new(), Vec::new());
    for (x, values) in groups {
        let (mean, error) = mean_and_error(&values);
        points.push([x, mean]);
        let count = values.len() as f64;
        let bar = if are_repetitions { error } else { error * count.sqrt() };
        errors.push(if values.len() > 1 { bar } else { 0.0 });
    }
    if errors.iter().all(|&error| error == 0.0) {
        return Series::new(label, points, Style::Markers);
    }
    Series::new(label, points, Style::ErrorBars(errors))
}

/// Curves of all reference files. A label may hold commas, also without quotes: the last two fields are the numbers.
fn references(view: &View) -> Result<Vec<Curve>, Failure> {
    let mut curves = Vec::new();
    for path in &view.references {
        let content = std::fs::read_to_string(path).map_err(|error| Failure::io(path.display(), error))?;
        for row in csv_rows(&content).skip(1) {
            let fields: Vec<&str> = row.fields().collect();
            let point = fields.split_last_chunk().and_then(|(label, [x, y])| {
                let point = [x.parse::<f64>().ok()?, y.parse().ok()?];
                (!label.is_empty()).then(|| (label.join(", "), point))
            });
            let (label, point) = point.ok_or_else(|| {
                let found = fields.join(",");
                let reason = format!("`{found}`: a label, x and y are expected, with commas between");
                Failure::io(format!("{}:{}", path.display(), row.line()), reason)
            })?;
            entry(&mut curves, label).push(point);
        }
    }
    Ok(curves)
}

/// The power law of the points in a range of x; none when there are fewer than three, or one is not above zero.
fn power_law(points: &[[f64; 2]], [low, high]: [f64; 2]) -> Option<PowerLaw> {
    let inside = points.iter().filter(|[x, _]| (low..=high).contains(x));
    let inside: Vec<(f64, f64)> = inside.map(|&[x, y]| (x, y)).collect();
    if inside.len() < 3 || inside.iter().any(|&(x, y)| !(x.ln().is_finite() && y.ln().is_finite())) {
        return None;
    }
    let law = PowerLaw::through(&inside);
    law.exponent.is_finite().then_some(law)
}

/// The law as a line.
fn drawn(law: &PowerLaw, [low, high]: [f64; 2]) -> Series {
    // Enough points that the curve looks smooth also on linear axes.
    let x = |k: i32| low * (high / low).powf(f64::from(k) / 40.0);
    Series::new("", (0..=40).map(|k| [x(k), law.at(x(k))]).collect(), Style::Line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found_again() {
        let points: Vec<[f64; 2]> = (1..9).map(|k| [f64::from(k), 2.7 * f64::from(k).powf(0.6)]).collect();
        let law = power_law(&points, [2.0, 8.0]).unwrap();
        assert!((law.factor - 2.7).abs() < 1e-12 && (law.exponent - 0.6).abs() < 1e-12, "{law}");
        assert!(law.error < 1e-7, "{law}");
        assert!(power_law(&points, [7.0, 8.0]).is_none());
        assert!(power_law(&[[1.0, 1.0], [2.0, 0.0], [3.0, 1.0]], [1.0, 3.0]).is_none());
        // By hand: logarithms 0, 1, 2 and 0, 2, 1 have slope 1/2, squares left 3/2, error sqrt(3/2/2).
        let e = std::f64::consts::E;
        let law = power_law(&[[1.0, 1.0], [e, e * e], [e * e, e]], [0.5, 10.0]).unwrap();
        assert!((law.exponent - 0.5).abs() < 1e-12 && (law.error - 0.75_f64.sqrt()).abs() < 1e-12, "{law}");
        assert_eq!(law.to_string(), "1.6487 x^0.500, exponent ± 0.866");
    }

    #[test]
    fn means_have_the_standard_error_of_their_values() {
        let groups = vec![(2.0, vec![1.0, 3.0]), (1.0, vec![5.0])];
        let found = series("a".to_owned(), groups.clone(), false);
        assert_eq!(found.style, Style::ErrorBars(vec![0.0, 2.0_f64.sqrt()]));
        let found = series("a".to_owned(), groups, true);
        assert_eq!(found.points, [[1.0, 5.0], [2.0, 2.0]]);
        assert_eq!(found.style, Style::ErrorBars(vec![0.0, 1.0]));
        assert_eq!(number("68 mm"), Some(68.0));
        assert_eq!(number("Ballistic"), None);
    }

    /// Scenes in which two solvers run: a curve each, over an axis or over a number of each.
    #[test]
    fn a_number_of_several_solvers_has_a_curve_of_each() {
        let run = |a: f64| {
            serde_json::json!({
                "values": { "a": a.to_string() },
                "measures": {
                    "grains.runout [1]": 2.0 * a, "continuum.runout [1]": 3.0 * a, "grains.ratio [1]": 1.1 * a,
                    "continuum.ratio [1]": a,
                },
            })
        };
        let (axes, runs) = (vec!["a".to_owned()], vec![run(1.0), run(2.0)]);
        let sweep = Collected { path: PathBuf::new(), axes, runs };
        let solvers = sweep.solvers_with("runout");
        assert_eq!(solvers, ["continuum.", "grains."]);
        let view = View { x: Some("ratio".to_owned()), ..View::default() };
        let (mut curves, mut counts) = (Vec::new(), Counts::default());
        for solver in solvers {
            sweep.add_curves(solver, [solver, "runout"], &view, &mut curves, &mut counts).unwrap();
        }
        let points: Vec<_> =
            curves.iter().map(|(label, groups)| (label.as_str(), groups[1].clone())).collect();
        assert_eq!(points, [("continuum.", (2.0, vec![6.0])), ("grains.", (2.2, vec![4.0]))]);
        assert_eq!(sweep.solvers_with("continuum.runout"), [""]);
        assert_eq!(sweep.column_of("", "continuum.runout"), "continuum.runout [1]");
        assert_eq!(sweep.solvers_with("nothing"), [""]);
    }

    #[test]
    fn a_mean_over_an_axis_is_no_standard_error() {
        let run = |a: &str, seed: &str, friction: &str, value: f64| {
            serde_json::json!({
                "values": { "a": a, "sample.seed": seed, "friction": friction }, "measures": { "runout": value },
            })
        };
        let axes = ["a", "sample.seed", "friction"].map(str::to_owned).to_vec();
        let sweep = |frictions: [&str; 2]| Collected {
            path: PathBuf::new(),
            axes: axes.clone(),
            runs: vec![
                run("1", "1", frictions[0], 2.0),
                run("1", "2", frictions[1], 4.0),
                run("2", "1", frictions[0], 5.0),
                run("2", "2", frictions[1], 5.0),
            ],
        };
        let drawn = |frictions, by: Option<&str>| {
            let view = View { by: by.map(str::to_owned), ..View::default() };
            let (mut curves, mut counts) = (Vec::new(), Counts::default());
            sweep(frictions).add_curves("", ["", "runout"], &view, &mut curves, &mut counts).unwrap();
            chart(["a", "runout"], &view, curves, &counts).unwrap()
        };
        let seeds = drawn(["0.5", "0.5"], None);
        assert_eq!(seeds.notes, ["means over up to 2 runs, bars: their standard error"]);
        assert_eq!(seeds.series[0].style, Style::ErrorBars(vec![1.0, 0.0]));
        let mixed = drawn(["0.3", "0.5"], None);
        assert!(
            mixed.notes[0].starts_with("means over all values of friction, up to 2 runs"),
            "{:?}",
            mixed.notes
        );
        assert_eq!(mixed.series[0].style, Style::ErrorBars(vec![2.0_f64.sqrt(), 0.0]));
        // A curve for each value averages over nothing.
        assert!(drawn(["0.3", "0.5"], Some("friction")).notes.is_empty());
    }
}
