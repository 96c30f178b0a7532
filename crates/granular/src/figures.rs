//! Figures and metrics of a run, made from the files of its folder.

mod column;
mod flow;
mod fluid;
pub(crate) mod impact;
mod map;
mod radial;
pub(crate) mod spectrum;
mod voronoi;

use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::model::ColumnSize;
use crate::observers::number_of;
use crate::run::StageRecord;
use crate::scene::{FigureSpec, ReferenceCurve, Scene};
pub(crate) use column::running_median;
use granular_core::{ShownAs, Simulation};
use granular_io::figure::{Axis, Chart, Series, Style};
use granular_io::{Table, read_table};
use std::path::PathBuf;

/// Lengths and times that a figure is drawn in.
#[derive(Clone, Copy, Debug)]
struct Units {
    /// Simulated time from which the figure counts \[s\].
    start: f64,
    /// Time of the axis \[s\]: sqrt(H/g) of a column, else one second.
    time: f64,
    /// Whether `time` is sqrt(H/g).
    scaled: bool,
}

/// Draws all figures of a scene. Returns their paths without ending.
///
/// # Errors
/// When a file of the run cannot be read, or a figure cannot be written.
pub fn draw(
    scene: &Scene,
    folder: &RunFolder,
    records: &[StageRecord],
    column: Option<ColumnSize>,
) -> Result<Vec<PathBuf>, Failure> {
    let mut paths = Vec::new();
    for spec in &scene.figures {
        let path = folder.path().join(spec.path());
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
        }
        let figure = match spec {
            FigureSpec::Series { table, columns, stage, references, .. } => {
                let stage = stage.as_ref().map(|stage| record(records, stage)).transpose()?;
                let units = stage.map(|stage| units(scene, stage, column));
                let chart = series(scene, &table_of(folder, table)?, columns, units);
                with_references(chart, references).figure()
            }
            FigureSpec::Runout { table, stage, laws, references, .. } => {
                let table = table_of(folder, table)?;
                let drawn = column::Compared { column, laws, references };
                column::runout(scene, &table, record(records, stage)?, drawn).figure()
            }
            FigureSpec::RadialProfile { fields, stage, times, laws, .. } => {
                let record = record(records, stage)?;
                let (times, column) = (times.as_slice(), (column, laws.as_slice()));
                radial::profile(scene, folder, (fields, times), record, column)?.figure()
            }
            FigureSpec::Energies { table, stage, references, .. } => {
                let units = units(scene, record(records, stage)?, column);
                let chart = column::energies(scene, &table_of(folder, table)?, units);
                with_references(chart, references).figure()
            }
            FigureSpec::Flow { fields, color, stage, times, .. } => {
                let units = units(scene, record(records, stage)?, column);
                flow::grains(scene, folder, (fields.as_str(), color.as_str()), times, units)?.figure()
            }
            FigureSpec::Cells { fields, range, stage, times, .. } => {
                let units = units(scene, record(records, stage)?, column);
                let range = range.as_deref().and_then(|range| <[f64; 2]>::try_from(range).ok());
                voronoi::cells(scene, folder, (fields, range), times, units)?.figure()
            }
            FigureSpec::ForceChains { contacts, stage, time, .. } => {
                let units = units(scene, record(records, stage)?, column);
                flow::chains(scene, folder, contacts, *time, units)?.figure()
            }
            FigureSpec::Map { fields, color, diverging, range, stage, times, .. } => {
                let range = range.as_deref().and_then(|range| <[f64; 2]>::try_from(range).ok());
                let spec = map::MapSpec { fields, color, diverging: *diverging, range, times };
                map::map(scene, folder, record(records, stage)?, &spec)?.figure()
            }
            FigureSpec::Profile { profile, column, stage, times, length, scale, references, .. } => {
                let spec = fluid::ProfileFigure {
                    column,
                    times,
                    length: length.map(|length| length.value()),
                    scale: *scale,
                    references,
                };
                fluid::profile(scene, &table_of(folder, profile)?, record(records, stage)?, &spec).figure()
            }
            FigureSpec::Impact { table, stage, transient, .. } => {
                let table = table_of(folder, table)?;
                impact::panels(scene, &table, record(records, stage)?, *transient)?.figure()
            }
            FigureSpec::Spectrum { table, column, stage, reference, .. } => {
                let record = record(records, stage)?;
                fluid::spectrum_chart(scene, &table_of(folder, table)?, (column, record), *reference)?
                    .figure()
            }
        };
        figure.save(&path)?;
        paths.push(path);
    }
    Ok(paths)
}

/// A number that a run measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Metric {
    pub(crate) name: String,
    /// `1` for a plain number.
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
}

/// What the run measured.
pub(crate) fn metrics(
    scene: &Scene,
    simulation: &Simulation,
    (folder, records): (&RunFolder, &[StageRecord]),
    column: Option<ColumnSize>,
) -> Vec<Metric> {
    let mut metrics = Vec::new();
    let mut add = |name: &str, unit, value: Option<f64>| {
        metrics.extend(value.map(|value| Metric { name: name.to_owned(), unit, value }));
    };
    for shown in simulation.solver().shown() {
        if shown.kind == ShownAs::Number && is_metric(&shown.name) {
            let number = number_of(simulation, &shown.name).filter(|number| number.is_finite());
            add(&shown.name, shown.unit, number);
        }
    }
    if let (Some(column), Some(release)) = (column, release_of(scene, records)) {
        add("aspect_ratio", "1", Some(release.height / column.width));
        let front = number_of(simulation, column.front());
        add("runout", "1", front.map(|front| (front - column.width) / column.width));
        let height = number_of(simulation, "height");
        add("final_height_over_width", "1", height.map(|height| height / column.width));
        add("duration_unit", "s", gravity_time(scene, release.height));
    }
    metrics.extend(fluid::peaks(scene, folder, records));
    metrics.extend(impact::metrics(scene, folder, records));
    metrics
}

/// Whether the last value of a number that the solver shows belongs to the result.
fn is_metric(name: &str) -> bool {
    let named = [
        "front",
        "height",
        "largest_overlap",
        "unconnected",
        "largest_speed",
        "mass_excess",
        "energy_residual",
    ];
    let begins = ["drag_coefficient_of_", "lift_coefficient_of_", "pressure_at_", "velocity_at_"];
    named.contains(&name) || begins.iter().any(|begin| name.starts_with(begin))
}

/// The stage at whose start a gate opens, or the last one.
pub(crate) fn release_of<'a>(scene: &Scene, records: &'a [StageRecord]) -> Option<&'a StageRecord> {
    let opens = scene.walls.iter().find_map(|wall| match wall {
        crate::scene::WallSpec::Gate { opens, .. } => Some(opens),
        _ => None,
    });
    match opens {
        Some(stage) => records.iter().find(|record| record.name == *stage),
        None => records.last(),
    }
}

/// sqrt(H/g) \[s\].
fn gravity_time(scene: &Scene, height: f64) -> Option<f64> {
    let gravity = scene.gravity.iter().map(|g| g.value() * g.value()).sum::<f64>().sqrt();
    (gravity > 0.0 && height > 0.0).then(|| (height / gravity).sqrt())
}

fn units(scene: &Scene, record: &StageRecord, column: Option<ColumnSize>) -> Units {
    let time = column.and_then(|_| gravity_time(scene, record.height));
    Units { start: record.start, time: time.unwrap_or(1.0), scaled: time.is_some() }
}

impl Units {
    fn time_label(&self) -> &'static str {
        if self.scaled { "time after release, t / √(H₀/g) [-]" } else { "time [s]" }
    }

    fn name_of(&self, time: f64) -> String {
        if self.scaled { format!("t = {time} √(H₀/g)") } else { format!("t = {time} s") }
    }
}

fn record<'a>(records: &'a [StageRecord], name: &str) -> Result<&'a StageRecord, Failure> {
    let found = records.iter().find(|record| record.name == name);
    found.ok_or_else(|| Failure::Io(format!("stage `{name}` was not run yet, so there is no figure of it")))
}

fn table_of(folder: &RunFolder, name: &str) -> Result<Table, Failure> {
    Ok(read_table(&folder.path().join(name))?)
}

/// A time rounded to four digits: output times are those of the first step at or after the one asked for.
fn four_digits(time: f64) -> f64 {
    if time == 0.0 {
        return 0.0;
    }
    let unit = 10.0_f64.powi(time.abs().log10().floor() as i32 - 3);
    // Divided by a whole number where there is one, so that the result prints short.
    if unit < 1.0 { (time / unit).round() / (1.0 / unit).round() } else { (time / unit).round() * unit }
}

fn title(scene: &Scene, what: &str) -> String {
    if scene.title.is_empty() { what.to_owned() } else { format!("{}: {what}", scene.title) }
}

/// Columns of a table over time: all of it over seconds, or from a stage on in its units.
fn series(scene: &Scene, table: &Table, columns: &[String], units: Option<Units>) -> Chart {
    let unit = columns.first().and_then(|name| table.unit(name)).unwrap_or("-");
    let label = match columns {
        [one] => format!("{} [{unit}]", one.replace('_', " ")),
        _ => format!("[{unit}]"),
    };
    let heading = if scene.title.is_empty() { "Series over time" } else { &scene.title };
    let time_label = units.map_or("time [s]", |units| units.time_label());
    let Units { start, time: scale, .. } =
        units.unwrap_or(Units { start: f64::NEG_INFINITY, time: 1.0, scaled: false });
    let mut chart = Chart::new(heading, Axis::linear(time_label), Axis::linear(label));
    let time = table.column("time").unwrap_or_default();
    let since = |t: f64| if start.is_finite() { (t - start) / scale } else { t };
    for name in columns {
        let values = table.column(name).unwrap_or_default();
        let rows = time.iter().zip(values).filter(|(t, _)| **t >= start);
        let points = rows.map(|(&t, value)| [since(t), value]).collect();
        let label = if columns.len() > 1 { name.replace('_', " ") } else { String::new() };
        chart = chart.with(Series::new(label, points, Style::Line));
    }
    chart
}

/// A chart with curves from elsewhere, beside which a curve without a label is this run.
fn with_references(mut chart: Chart, references: &[ReferenceCurve]) -> Chart {
    if !references.is_empty() {
        let unnamed = chart.series.iter_mut().filter(|series| series.label.is_empty());
        unnamed.for_each(|series| series.label = "this run".to_owned());
    }
    for reference in references {
        let points = reference.points.iter().map(|(x, y)| [*x, *y]).collect();
        let style = if reference.line { Style::Dashed } else { Style::Markers };
        chart = chart.with(Series::new(reference.label.clone(), points, style));
    }
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns = ["time", "bulk_density"].map(|name| (name.to_owned(), "1".to_owned())).to_vec();
        Table { columns, rows: vec![vec![0.0, 0.7], vec![1.0, 0.8], vec![2.0, 0.9]] }
    }

    fn scene() -> Scene {
        let (name, text) = crate::TEMPLATES[2];
        crate::scene_file::SceneText::new(name, text).parse().unwrap()
    }

    #[test]
    fn a_series_from_a_stage_on_counts_in_its_unit() {
        let names = ["bulk_density".to_owned()];
        let all = series(&scene(), &table(), &names, None);
        assert_eq!(all.series[0].points, [[0.0, 0.7], [1.0, 0.8], [2.0, 0.9]]);
        let units = Units { start: 1.0, time: 0.5, scaled: true };
        let part = series(&scene(), &table(), &names, Some(units));
        assert_eq!(part.series[0].points, [[0.0, 0.8], [2.0, 0.9]]);
    }

    #[test]
    fn curves_from_elsewhere_lie_beside_this_run() {
        let bare = series(&scene(), &table(), &["bulk_density".to_owned()], None);
        assert_eq!(with_references(bare.clone(), &[]), bare);
        let reference = ReferenceCurve { label: "thesis".to_owned(), points: vec![(0.0, 0.75)], line: true };
        let beside = with_references(bare, &[reference]);
        let labels: Vec<&str> = beside.series.iter().map(|series| series.label.as_str()).collect();
        assert_eq!(labels, ["this run", "thesis"]);
        assert_eq!(
            (&beside.series[1].points[..], &beside.series[1].style),
            (&[[0.0, 0.75]][..], &Style::Dashed)
        );
    }
}
