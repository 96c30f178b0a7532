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
use crate::scene::{FigureSpec, Scene};
use granular_core::{ShownAs, Simulation};
use granular_io::figure::{Axis, Chart, Series, Style};
use granular_io::{Table, read_table};
use serde_json::{Map, Value, json};
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
            FigureSpec::Series { table, columns, .. } => {
                series(scene, &table_of(folder, table)?, columns).figure()
            }
            FigureSpec::Runout { table, stage, laws, .. } => {
                let table = table_of(folder, table)?;
                column::runout(scene, &table, record(records, stage)?, (column, laws)).figure()
            }
            FigureSpec::RadialProfile { fields, stage, times, laws, .. } => {
                let record = record(records, stage)?;
                let (times, column) = (times.as_slice(), (column, laws.as_slice()));
                radial::profile(scene, folder, (fields, times), record, column)?.figure()
            }
            FigureSpec::Energies { table, stage, .. } => {
                let units = units(scene, record(records, stage)?, column);
                column::energies(scene, &table_of(folder, table)?, units).figure()
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

/// What the run measured, by name.
pub(crate) fn metrics(
    scene: &Scene,
    simulation: &Simulation,
    (folder, records): (&RunFolder, &[StageRecord]),
    column: Option<ColumnSize>,
) -> Value {
    let mut metrics = Map::new();
    let mut add = |name: &str, value: Option<f64>| {
        if let Some(value) = value {
            metrics.insert(name.to_owned(), json!(value));
        }
    };
    for shown in simulation.solver().shown() {
        if shown.kind == ShownAs::Number && is_metric(&shown.name) {
            add(&shown.name, number_of(simulation, &shown.name).filter(|number| number.is_finite()));
        }
    }
    if let (Some(column), Some(release)) = (column, release_of(scene, records)) {
        add("aspect_ratio", Some(release.height / column.width));
        let front = number_of(simulation, column.front());
        add("runout", front.map(|front| (front - column.width) / column.width));
        add("final_height_over_width", number_of(simulation, "height").map(|height| height / column.width));
        add("duration_unit", gravity_time(scene, release.height));
    }
    let residual = number_of(simulation, "energy_residual").filter(|residual| residual.is_finite());
    add("energy_residual", residual);
    fluid::peaks(scene, folder, records, &mut metrics);
    impact::metrics(scene, folder, records, &mut metrics);
    Value::Object(metrics)
}

/// Whether the last value of a number that the solver shows belongs to the result.
fn is_metric(name: &str) -> bool {
    let named = ["front", "height", "largest_overlap", "unconnected", "largest_speed", "mass_excess"];
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

/// Columns of a table over time.
fn series(scene: &Scene, table: &Table, columns: &[String]) -> Chart {
    let unit = columns.first().and_then(|name| table.unit(name)).unwrap_or("-");
    let label = match columns {
        [one] => format!("{} [{unit}]", one.replace('_', " ")),
        _ => format!("[{unit}]"),
    };
    let heading = if scene.title.is_empty() { "Series over time" } else { &scene.title };
    let mut chart = Chart::new(heading, Axis::linear("time [s]"), Axis::linear(label));
    let time = table.column("time").unwrap_or_default();
    for name in columns {
        let values = table.column(name).unwrap_or_default();
        let points = time.iter().zip(values).map(|(&t, value)| [t, value]).collect();
        let label = if columns.len() > 1 { name.replace('_', " ") } else { String::new() };
        chart = chart.with(Series::new(label, points, Style::Line));
    }
    chart
}
