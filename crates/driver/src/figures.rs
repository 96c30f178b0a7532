//! Figures and metrics of a run, made from the files of its folder.

mod column;
mod flow;
mod fluid;
mod frames;
pub mod impact;
mod initial;
mod map;
mod radial;
mod series;
pub mod spectrum;
mod units;
mod voronoi;
mod walls;

use crate::column::ColumnSize;
use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::methods::member::Member;
use crate::model::Model;
use crate::records::{RecordedStage, StageRecord};
use crate::scene::{FigureSpec, Scene};
pub use column::running_median;
use frames::Frames;
use granular_core::ShownAs;
use granular_io::{Figure, Table, read_table};
pub(crate) use initial::{Extents, draw as draw_initial, ends_of_walls};
use serde_json::{Value, json};
use series::with_references;
use std::path::PathBuf;
pub(crate) use units::times_beyond;
use units::{Units, gravity_time, spreads, units};

/// What came of the figures of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Paths of those that were drawn, without ending.
    pub paths: Vec<PathBuf>,
    /// Which could not be drawn, and why.
    pub failed: Vec<String>,
    /// What those that were drawn leave out, and why.
    pub left_out: Vec<String>,
}

impl Drawn {
    /// What `run.json` says of them.
    pub(crate) fn to_json(&self) -> Value {
        json!({ "drawn": self.paths.len(), "failed": self.failed, "left_out": self.left_out })
    }
}

/// Draws all figures of a scene. What has nothing to show, such as the spectrum of a short series, is told and does not keep
/// the others from it.
///
/// # Errors
/// When a figure cannot be written, which may be put right.
pub fn draw(
    scene: &Scene,
    folder: &RunFolder,
    records: &[RecordedStage],
    column: Option<ColumnSize>,
) -> Result<Drawn, Failure> {
    let mut drawn = Drawn::default();
    for (k, spec) in scene.figures.iter().enumerate() {
        let records = &seen_by(scene, records, spec);
        let run = Run { scene, folder, records, column };
        let (place, name) = (format!("figures.{k}"), spec.path());
        match run.figure(spec) {
            Ok((figure, left_out)) => {
                drawn.paths.push(run.save(&figure, name)?);
                drawn.left_out.extend(left_out.map(|left_out| format!("{place} `{name}`: {left_out}")));
            }
            Err(failure) => {
                let reason = match failure {
                    Failure::Io(reason) => reason,
                    other => other.to_string(),
                };
                drawn.failed.push(format!("{place} `{name}` was not drawn: {reason}"));
            }
        }
    }
    Ok(drawn)
}

/// Stages as the solver saw them whose output a figure draws.
fn seen_by(scene: &Scene, records: &[RecordedStage], spec: &FigureSpec) -> Vec<StageRecord> {
    let path = spec.needs("front").output;
    let output = scene.outputs.iter().find(|output| output.write.path() == path);
    let of = output.and_then(|output| output.of.as_ref()).or_else(|| scene.solvers.keys().next());
    records.iter().map(|record| record.of(of.map_or("", String::as_str))).collect()
}

/// A run whose figures are drawn.
#[derive(Clone, Copy)]
struct Run<'a> {
    scene: &'a Scene,
    folder: &'a RunFolder,
    records: &'a [StageRecord],
    column: Option<ColumnSize>,
}

/// A figure, and what it leaves out.
type Made = (Figure, Option<String>);

impl Run<'_> {
    /// Writes a figure of this name; returns its path without ending.
    fn save(&self, figure: &Figure, name: &str) -> Result<PathBuf, Failure> {
        let path = self.folder.path().join(name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
        }
        figure.save(&path)?;
        Ok(path)
    }

    fn figure(&self, spec: &FigureSpec) -> Result<Made, Failure> {
        match spec {
            FigureSpec::Flow { .. }
            | FigureSpec::Cells { .. }
            | FigureSpec::ForceChains { .. }
            | FigureSpec::RadialProfile { .. }
            | FigureSpec::Map { .. } => self.of_frames(spec),
            _ => self.of_table(spec),
        }
    }

    /// A figure of the rows of a table.
    fn of_table(&self, spec: &FigureSpec) -> Result<Made, Failure> {
        let Self { scene, folder, column, .. } = *self;
        let figure = match spec {
            FigureSpec::Series { table, columns: names, stage, references, .. } => {
                let units = self.units_of(stage.as_deref())?;
                let columns = series::Columns { names, over: None, units, references };
                series::panels(scene, &table_of(folder, table)?, &columns).figure()
            }
            FigureSpec::Curve { table, x, columns: names, stage, references, .. } => {
                let (units, over) = (self.units_of(stage.as_deref())?, Some(x.as_str()));
                let columns = series::Columns { names, over, units, references };
                series::panels(scene, &table_of(folder, table)?, &columns).figure()
            }
            FigureSpec::Runout { table, stage, laws, references, .. } => {
                let table = table_of(folder, table)?;
                let drawn = column::Compared { column, laws, references };
                column::runout(scene, &table, self.record(stage)?, drawn).figure()
            }
            FigureSpec::Energies { table, stage, references, .. } => {
                let units = units(scene, self.record(stage)?, column);
                let chart = column::energies(scene, &table_of(folder, table)?, units);
                with_references(chart, references).figure()
            }
            FigureSpec::Profile { profile, column, stage, times, length, scale, references, .. } => {
                let spec = fluid::ProfileFigure {
                    profile,
                    column,
                    times,
                    length: length.map(|length| length.value()),
                    scale: *scale,
                    references,
                };
                let (chart, left_out) =
                    fluid::profile(scene, &table_of(folder, profile)?, self.record(stage)?, &spec);
                return Ok((chart.figure(), left_out));
            }
            FigureSpec::Impact { table, stage, transient, .. } => {
                let table = table_of(folder, table)?;
                impact::panels(scene, &table, self.record(stage)?, *transient)?.figure()
            }
            FigureSpec::Spectrum { table, column, stage, reference, .. } => {
                let record = self.record(stage)?;
                fluid::spectrum_chart(scene, &table_of(folder, table)?, (column, record), *reference)?
                    .figure()
            }
            _ => return self.of_frames(spec),
        };
        Ok((figure, None))
    }

    /// A figure of files of grains, contacts or cells at some times.
    fn of_frames(&self, spec: &FigureSpec) -> Result<Made, Failure> {
        let Self { scene, folder, records, column } = *self;
        let walls = walls::Walls { scene, column, records };
        let frames = |output: &str, times: &[f64], units| Frames::of(folder, output, times, units);
        let of_stage = |stage: &str| Ok::<_, Failure>(units(scene, self.record(stage)?, column));
        let pair =
            |range: &Option<Vec<f64>>| range.as_deref().and_then(|range| <[f64; 2]>::try_from(range).ok());
        match spec {
            FigureSpec::RadialProfile { fields, stage, times, laws, .. } => {
                let (record, units) = (self.record(stage)?, of_stage(stage)?);
                let frames = frames(fields, times, units)?;
                let chart = radial::profile(scene, &frames.files, record, (column, laws), units)?;
                Ok((chart.figure(), frames.left_out))
            }
            FigureSpec::Flow { fields, color, stage, times, .. } => {
                let units = of_stage(stage)?;
                let frames = frames(fields, times, units)?;
                Ok((flow::grains(&walls, &frames.files, color, units)?.figure(), frames.left_out))
            }
            FigureSpec::Cells { fields, range, stage, times, .. } => {
                let units = of_stage(stage)?;
                let frames = frames(fields, times, units)?;
                Ok((voronoi::cells(&walls, &frames.files, pair(range), units)?.figure(), frames.left_out))
            }
            FigureSpec::ForceChains { contacts, stage, time, .. } => {
                let units = of_stage(stage)?;
                let frames = frames(contacts, &[*time], units)?;
                Ok((flow::chains(&walls, &frames.files, units)?.figure(), frames.left_out))
            }
            FigureSpec::Map { fields, grains, color, diverging, range, stage, times, .. } => {
                let units = Units { start: self.record(stage)?.start, time: 1.0, scaled: false };
                let drawn = grains.as_ref().map(|grains| frames(grains, times, units)).transpose()?;
                let grains = drawn.map_or_else(Vec::new, |drawn| drawn.files);
                let frames = frames(fields, times, units)?;
                if !grains.is_empty() && grains.len() != frames.files.len() {
                    return Err(Failure::Io(format!("grains were not written at the times of `{fields}`")));
                }
                let (range, diverging) = (pair(range), *diverging);
                let spec = map::MapSpec { files: &frames.files, grains: &grains, color, diverging, range };
                Ok((map::map(scene, units, &spec)?.figure(), frames.left_out))
            }
            _ => self.of_table(spec),
        }
    }

    fn record(&self, name: &str) -> Result<&StageRecord, Failure> {
        let found = self.records.iter().find(|record| record.name == name);
        let reason = || format!("stage `{name}` was not run yet, so it has no figure");
        found.ok_or_else(|| Failure::Io(reason()))
    }

    fn units_of(&self, stage: Option<&str>) -> Result<Option<Units>, Failure> {
        let record = stage.map(|stage| self.record(stage)).transpose()?;
        Ok(record.map(|record| units(self.scene, record, self.column)))
    }
}

/// A number that a run measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Metric {
    pub(crate) name: String,
    /// `1` for a plain number.
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
}

/// What the run measured. Among several solvers, numbers of each have its name in front: `grains.front`.
pub(crate) fn metrics(
    scene: &Scene,
    model: &Model,
    (folder, records): (&RunFolder, &[RecordedStage]),
) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for member in &model.members {
        let own = of_member(scene, (model, &**member), records);
        let name =
            |name: String| if model.members.len() > 1 { format!("{}.{name}", member.name()) } else { name };
        metrics.extend(own.into_iter().map(|metric| Metric { name: name(metric.name), ..metric }));
    }
    metrics.extend(fluid::peaks(scene, folder, records));
    metrics.extend(impact::metrics(scene, folder, records));
    metrics
}

/// What the run measured of one solver.
fn of_member(
    scene: &Scene,
    (model, member): (&Model, &dyn Member),
    records: &[RecordedStage],
) -> Vec<Metric> {
    let number = |name: &str| member.number(&model.simulation, name);
    let mut metrics = Vec::new();
    let mut add = |name: &str, unit, value: Option<f64>| {
        metrics.extend(value.map(|value| Metric { name: name.to_owned(), unit, value }));
    };
    for shown in member.solver(&model.simulation).shown() {
        if shown.kind == ShownAs::Number && member.is_metric(&shown.name) {
            add(&shown.name, shown.unit, number(&shown.name).filter(|number| number.is_finite()));
        }
    }
    let records: Vec<StageRecord> = records.iter().map(|record| record.of(member.name())).collect();
    let column = member.column().filter(|_| spreads(scene));
    if let (Some(column), Some(release)) = (column, release_of(scene, &records)) {
        add("aspect_ratio", "1", Some(release.height / column.width));
        let spread = |front: &str| number(front).map(|front| (front - column.width) / column.width);
        add("runout", "1", spread(column.front()));
        add("runout_99", "1", spread(column.front_99()));
        add("final_height_over_width", "1", number("height").map(|height| height / column.width));
        add("duration_unit", "s", gravity_time(scene, release.height));
    }
    metrics
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

fn table_of(folder: &RunFolder, name: &str) -> Result<Table, Failure> {
    Ok(read_table(&folder.path().join(name))?)
}

fn title(scene: &Scene, what: &str) -> String {
    if scene.title.is_empty() { what.to_owned() } else { format!("{}: {what}", scene.title) }
}
