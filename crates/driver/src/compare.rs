//! Runs side by side: series, profiles and grids of run folders and of tables from elsewhere, overlaid and differenced.
//!
//! Whatever two sources hold under the same name, over the same axis, is one quantity: a chart with a curve of each source, and
//! rows of a table that say how far they are from the first.

mod difference;
mod maps;
mod source;

use crate::failure::Failure;
use difference::Difference;
use granular_io::figure::{Axis, Chart, Panels, Series, Style};
use granular_io::{csv_row, write_atomically};
use maps::Maps;
use serde::Serialize;
use source::{Curve, Grid, Source};
use std::fmt;
use std::path::{Path, PathBuf};

/// Most charts of a figure.
const MOST_CHARTS: usize = 24;

/// What is compared.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Run folders, folders of several runs, and CSV files whose first column is what the others are over.
    pub sources: Vec<PathBuf>,
    /// Names of the quantities; all that two sources share by default.
    pub columns: Vec<String>,
    /// Stage from whose start time counts.
    pub stage: Option<String>,
}

/// What came of it.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// One row for each source of each quantity.
    pub rows: Vec<Row>,
    /// What is not drawn, and why.
    pub left_out: Vec<String>,
    #[serde(skip)]
    charts: Vec<Chart>,
    #[serde(skip)]
    maps: Vec<Maps>,
}

/// A source of a quantity beside the first source of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Quantity.
    pub quantity: String,
    /// Unit.
    pub unit: String,
    /// What it is over.
    pub over: String,
    /// Source.
    pub source: String,
    /// Last value; none of a grid.
    pub last: Option<f64>,
    /// The rest of the numbers; none of the first source.
    pub difference: Option<Difference>,
}

/// Compares sources.
///
/// # Errors
/// When a source cannot be read, or no two share a quantity.
pub fn compare(request: &Request) -> Result<Comparison, Failure> {
    let mut sources = Vec::new();
    for path in &request.sources {
        sources.extend(source::read(path, request.stage.as_deref())?);
    }
    if sources.len() < 2 {
        let reason = "a comparison needs two runs or tables at least";
        return Err(Failure::Io(format!("{reason}; `granular compare A B ...`")));
    }
    source::shorten(&mut sources);
    let mut comparison =
        Comparison { rows: Vec::new(), left_out: Vec::new(), charts: Vec::new(), maps: Vec::new() };
    for key in shared(&sources, &request.columns) {
        comparison.add_curves(&sources, &key);
    }
    comparison.add_grids(&sources, &request.columns);
    if comparison.rows.is_empty() {
        let all: Vec<String> = sources.iter().map(|source| source.describe()).collect();
        let wanted = match request.columns.as_slice() {
            [] => "no two of them share a quantity".to_owned(),
            names => format!("no two of them share {}", names.join(", ")),
        };
        return Err(Failure::Io(format!("{wanted}; they hold\n  {}", all.join("\n  "))));
    }
    Ok(comparison)
}

/// What a curve is over, and its name.
type Key = (String, String);

/// Quantities that two sources hold, in the order in which they are met.
fn shared(sources: &[Source], wanted: &[String]) -> Vec<Key> {
    let mut keys: Vec<Key> = Vec::new();
    for curve in sources.iter().flat_map(|source| &source.curves) {
        let key = curve.key();
        let held = sources.iter().filter(|source| source.curve(&key).is_some()).count();
        let is_wanted = wanted.is_empty() || wanted.contains(&curve.name);
        if held > 1 && is_wanted && !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

impl Comparison {
    /// A quantity over time or along a line.
    fn add_curves(&mut self, sources: &[Source], key: &Key) {
        let found: Vec<(&Source, &Curve)> =
            sources.iter().filter_map(|source| Some((source, source.curve(key)?))).collect();
        let Some((_, first)) = found.first() else { return };
        let words = |name: &str| name.replace('_', " ");
        let label = |name: &str, unit: &str| {
            if unit.is_empty() { words(name) } else { format!("{} [{unit}]", words(name)) }
        };
        let (x, y) = (label(&first.over, &first.over_unit), label(&first.name, &first.unit));
        let mut chart = Chart::new("", Axis::linear(x), Axis::linear(y));
        for (source, curve) in &found {
            let style = if source.is_table { Style::Markers } else { Style::Line };
            chart = chart.with(Series::new(source.label.clone(), curve.points.clone(), style));
            let is_first = std::ptr::eq(*curve, *first);
            self.rows.push(Row {
                quantity: curve.name.clone(),
                unit: curve.unit.clone(),
                over: curve.over.clone(),
                source: source.label.clone(),
                last: curve.points.last().map(|point| point[1]),
                difference: (!is_first).then(|| Difference::of(&curve.points, &first.points)).flatten(),
            });
        }
        if self.charts.len() < MOST_CHARTS {
            self.charts.push(chart);
        } else {
            self.left_out.push(format!("`{}` is in the table only: {MOST_CHARTS} charts are drawn", key.1));
        }
    }

    /// Fields on the same cells, as they are last.
    fn add_grids(&mut self, sources: &[Source], wanted: &[String]) {
        let all = || sources.iter().flat_map(|source| source.grids.iter().map(move |grid| (source, grid)));
        for (at, (source, grid)) in all().enumerate() {
            let is_wanted = wanted.is_empty() || wanted.contains(&grid.name);
            let is_same = |(_, other): &(&Source, &Grid)| grid.is_like(other);
            let is_known = all().take(at).any(|pair| is_same(&pair));
            let others: Vec<_> = all().skip(at + 1).filter(is_same).collect();
            if !is_wanted || is_known || others.is_empty() {
                continue;
            }
            let row = |source: &Source, difference| Row {
                quantity: grid.name.clone(),
                unit: String::new(),
                over: "cells".to_owned(),
                source: source.label.clone(),
                last: None,
                difference,
            };
            self.rows.push(row(source, None));
            let rows = others
                .iter()
                .map(|(other, field)| row(other, Difference::of_cells(&field.values, &grid.values)));
            self.rows.extend(rows);
            let fields = std::iter::once((source, grid)).chain(others);
            let fields = fields.map(|(source, grid)| (source.label.clone(), grid.clone())).collect();
            self.maps.push(Maps::new(grid.name.clone(), fields));
        }
    }

    /// Writes `compare.csv`, the curves as `compare.svg` and `compare.png`, and each field on cells as `compare_FIELD` and
    /// `compare_FIELD_difference`; returns their paths.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn save(&self, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
        std::fs::create_dir_all(folder).map_err(|error| Failure::io(folder.display(), error))?;
        let table = folder.join("compare.csv");
        write_atomically(&table, |file| file.write_all(self.table().as_bytes()))?;
        let mut paths = vec![table];
        if !self.charts.is_empty() {
            let columns = if self.charts.len() > 4 { 3 } else { 2.min(self.charts.len()) };
            let panels = Panels::new("Side by side", columns, self.charts.clone());
            paths.extend(panels.figure().save(&folder.join("compare"))?);
        }
        for maps in &self.maps {
            let stem = format!("compare_{}", maps.quantity);
            let named = [(maps.overlay(), stem.clone()), (maps.differences(), format!("{stem}_difference"))];
            for (figure, stem) in named {
                if let Some(figure) = figure {
                    paths.extend(figure.save(&folder.join(stem))?);
                }
            }
        }
        Ok(paths)
    }

    /// The rows as CSV.
    fn table(&self) -> String {
        let head = [
            "quantity",
            "unit",
            "over",
            "source",
            "last",
            "last_less_first",
            "root_mean_square_difference",
            "largest_difference",
            "at",
        ];
        let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let mut text = csv_row(head);
        for row in &self.rows {
            let of = |value: fn(&Difference) -> f64| number(row.difference.as_ref().map(value));
            text += &csv_row([
                row.quantity.as_str(),
                &row.unit,
                &row.over,
                &row.source,
                &number(row.last),
                &of(|difference| difference.last),
                &of(|difference| difference.root_mean_square),
                &of(|difference| difference.largest),
                &of(|difference| difference.at),
            ]);
        }
        text
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quantity = |row: &Row| {
            let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
            format!("{}{unit} over {}", row.quantity, row.over)
        };
        let width = self.rows.iter().map(|row| row.source.chars().count()).max().unwrap_or(0);
        let mut before = String::new();
        for row in &self.rows {
            let now = quantity(row);
            if now != before {
                writeln!(f, "{now}")?;
                before = now;
            }
            let last = row.last.map_or(String::new(), |last| format!("last {last:.6}"));
            let difference =
                row.difference.as_ref().map_or("the others are compared with it".to_owned(), |found| {
                    format!(
                        "root mean square difference {:.3e}, largest {:.3e} at {:.4}",
                        found.root_mean_square, found.largest, found.at
                    )
                });
            writeln!(f, "  {:<width$}  {last:<20}  {difference}", row.source)?;
        }
        self.left_out.iter().try_for_each(|said| writeln!(f, "{said}"))
    }
}
