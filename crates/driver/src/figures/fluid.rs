//! Profiles and spectra of a fluid, from the files of a run.

use super::frames::{choose, left_out};
use super::spectrum::{Spectrum, spectrum};
use super::{Metric, Units, seen_by, table_of, title, with_references};
use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::records::{RecordedStage, StageRecord};
use crate::scene::fluid::ReferenceSpec;
use crate::scene::{FigureSpec, Scene};
use granular_io::Table;
use granular_io::figure::{Axis, Chart, Series, Style};

/// Points of a curve that are drawn at most.
const DRAWN: usize = 2000;

/// What a figure of profiles shows.
pub(super) struct ProfileFigure<'a> {
    /// Path of the output.
    pub(super) profile: &'a str,
    pub(super) column: &'a str,
    pub(super) times: &'a [f64],
    /// What distances \[m\] and values are divided by.
    pub(super) length: Option<f64>,
    pub(super) scale: Option<f64>,
    pub(super) references: &'a [crate::scene::ReferenceCurve],
}

/// A column over the distance along its line at several times, with curves from elsewhere.
pub(super) fn profile(
    scene: &Scene,
    table: &Table,
    record: &StageRecord,
    spec: &ProfileFigure<'_>,
) -> (Chart, Option<String>) {
    let unit = table.unit(spec.column).unwrap_or("-");
    let name = spec.column.replace('_', " ");
    let (x, y) = match (spec.length, spec.scale) {
        (Some(_), Some(_)) => {
            ("distance over its length [-]".to_owned(), format!("{name} over its scale [-]"))
        }
        (Some(_), None) => ("distance over its length [-]".to_owned(), format!("{name} [{unit}]")),
        (None, Some(_)) => ("distance [m]".to_owned(), format!("{name} over its scale [-]")),
        (None, None) => ("distance [m]".to_owned(), format!("{name} [{unit}]")),
    };
    let heading = title(scene, &format!("{name} along a line"));
    let mut chart = Chart::new(heading, Axis::linear(x), Axis::linear(y));
    let column = |name| table.column(name).unwrap_or_default();
    let (time, distance, values) = (column("time"), column("distance"), column(spec.column));
    let (length, scale) = (spec.length.unwrap_or(1.0), spec.scale.unwrap_or(1.0));
    let units = Units { start: record.start, time: 1.0, scaled: false };
    let mut available = time.clone();
    available.dedup();
    let choices = choose(&available, spec.times, units);
    for number in choices.iter().filter_map(|choice| choice.frame()) {
        let shown = available[number];
        let at_time = (0..time.len()).filter(|row| time[*row] == shown);
        let points: Vec<[f64; 2]> =
            at_time.map(|row| [distance[row] / length, values[row] / scale]).collect();
        chart = chart.with(Series::new(units.label(shown), points, Style::Line));
    }
    let left_out = left_out(&choices, (&available, spec.profile), spec.times, units);
    (with_references(chart, spec.references), left_out)
}

/// The spectrum of a column from the start of a stage on.
fn spectrum_of(table: &Table, column: &str, record: &StageRecord) -> Option<Spectrum> {
    let (time, values) = (table.column("time")?, table.column(column)?);
    let from = time.iter().position(|time| *time >= record.start)?;
    spectrum(&time[from..], &values[from..])
}

/// A spectrum as a chart, over the Strouhal number with a reference.
pub(super) fn spectrum_chart(
    scene: &Scene,
    table: &Table,
    (column, record): (&str, &StageRecord),
    reference: Option<ReferenceSpec>,
) -> Result<Chart, Failure> {
    let found = spectrum_of(table, column, record).ok_or_else(|| {
        Failure::Io(format!(
            "the series of `{column}` from stage `{}` on is too short for a spectrum",
            record.name
        ))
    })?;
    let unit = table.unit(column).unwrap_or("-");
    let factor = reference.map_or(1.0, |reference| reference.length.value() / reference.speed.value());
    let label = if reference.is_some() { "Strouhal number f L / U [-]" } else { "frequency [1/s]" };
    let name = column.replace('_', " ");
    let highest = found.points.iter().map(|point| point[1]).fold(0.0, f64::max);
    // Beyond the last frequency with a thousandth of the peak, and beyond ten times it, there is little to see.
    let last = found.points.iter().rposition(|point| point[1] > 1e-3 * highest).unwrap_or(0);
    let tenfold = found.peak.and_then(|peak| found.points.iter().position(|point| point[0] > 10.0 * peak));
    let end = (2 * last + 2).min(tenfold.unwrap_or(usize::MAX)).clamp(2, found.points.len());
    let shown = &found.points[1..end];
    let thinned = shown.iter().step_by(shown.len().div_ceil(DRAWN)).map(|[f, a]| [f * factor, *a]);
    let axes = (Axis::linear(label), Axis::log(format!("amplitude of the {name} [{unit}]")));
    let heading = title(scene, &format!("spectrum of the {name}"));
    let mut chart = Chart::new(heading, axes.0, axes.1).with(Series::new("", thinned.collect(), Style::Line));
    if let Some(peak) = found.peak {
        chart = chart.note(format!("highest peak at {:.4}", peak * factor));
    }
    Ok(chart)
}

/// Peaks of all spectra of a scene.
pub(super) fn peaks(scene: &Scene, folder: &RunFolder, records: &[RecordedStage]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for figure in &scene.figures {
        let FigureSpec::Spectrum { table, column, stage, reference, .. } = figure else { continue };
        let records = seen_by(scene, records, figure);
        let record = records.iter().find(|record| record.name == *stage);
        let (Some(record), Ok(table)) = (record, table_of(folder, table)) else { continue };
        let Some(peak) = spectrum_of(&table, column, record).and_then(|found| found.peak) else { continue };
        metrics.push(Metric { name: format!("frequency_of_{column}"), unit: "1/s", value: peak });
        if let Some(reference) = reference {
            let value = peak * reference.length.value() / reference.speed.value();
            metrics.push(Metric { name: format!("strouhal_of_{column}"), unit: "1", value });
        }
    }
    metrics
}
