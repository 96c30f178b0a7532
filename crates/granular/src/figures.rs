//! Figures and metrics of a run, made from the files of its folder.

mod column;
mod flow;
mod fluid;
mod frames;
pub(crate) mod impact;
mod initial;
mod map;
mod radial;
mod series;
pub(crate) mod spectrum;
mod voronoi;
mod walls;

use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::model::ColumnSize;
use crate::observers::number_of;
use crate::run::StageRecord;
use crate::scene::{Change, FigureSpec, Scene, Stage, WallSpec};
pub(crate) use column::running_median;
use frames::Frames;
use granular_core::{ShownAs, Simulation};
use granular_io::{Figure, Table, read_table};
pub(crate) use initial::{Extents, draw as draw_initial, ends_of_walls};
use serde_json::{Value, json};
use series::with_references;
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

/// Draws all figures of a scene. A figure that cannot be drawn does not keep the others from it.
pub fn draw(scene: &Scene, folder: &RunFolder, records: &[StageRecord], column: Option<ColumnSize>) -> Drawn {
    let run = Run { scene, folder, records, column };
    let mut drawn = Drawn::default();
    for (k, spec) in scene.figures.iter().enumerate() {
        let (place, name) = (format!("figures.{k}"), spec.path());
        match run.save(spec) {
            Ok((path, left_out)) => {
                drawn.paths.push(path);
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
    drawn
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
    /// Draws and saves a figure.
    fn save(&self, spec: &FigureSpec) -> Result<(PathBuf, Option<String>), Failure> {
        let path = self.folder.path().join(spec.path());
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
        }
        let (figure, left_out) = self.figure(spec)?;
        figure.save(&path)?;
        Ok((path, left_out))
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
            FigureSpec::Map { fields, color, diverging, range, stage, times, .. } => {
                let units = Units { start: self.record(stage)?.start, time: 1.0, scaled: false };
                let frames = frames(fields, times, units)?;
                let (range, diverging) = (pair(range), *diverging);
                let spec = map::MapSpec { files: &frames.files, color, diverging, range };
                Ok((map::map(scene, units, &spec)?.figure(), frames.left_out))
            }
            _ => self.of_table(spec),
        }
    }

    fn record(&self, name: &str) -> Result<&StageRecord, Failure> {
        let found = self.records.iter().find(|record| record.name == name);
        let reason = || format!("stage `{name}` was not run yet, so there is no figure of it");
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
    if let (Some(column), Some(release)) = (column.filter(|_| spreads(scene)), release_of(scene, records)) {
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

/// Whether the sample is a column that spreads: behind a gate, or with nothing at its right. In a silo lengths over the
/// width of the column and times over sqrt(H/g) mean nothing.
fn spreads(scene: &Scene) -> bool {
    let is_asked =
        |figure: &FigureSpec| matches!(figure, FigureSpec::Runout { .. } | FigureSpec::RadialProfile { .. });
    let is_released = |stage: &Stage| {
        stage.changes.iter().any(|change| matches!(change, Change::Open(name) if name == "right"))
    };
    let beside = |wall: &WallSpec| {
        matches!(wall, WallSpec::Floor { .. } | WallSpec::Left { .. } | WallSpec::Sides { .. })
    };
    let is_gate = |wall: &WallSpec| matches!(wall, WallSpec::Gate { .. });
    let comes_and_goes = !(scene.inlets.is_empty() && scene.outlets.is_empty() && scene.cell.is_none());
    scene.figures.iter().any(is_asked)
        || scene.walls.iter().any(is_gate)
        || scene.stages.iter().any(is_released)
        || (!comes_and_goes && scene.walls.iter().all(beside))
}

/// Share of the height of a column as it is built that it has at least when it is released.
const SETTLED: f64 = 0.5;

/// Times of figures that come after the longest that a run can last.
pub(crate) fn times_beyond(scene: &Scene, column: Option<ColumnSize>) -> Vec<String> {
    let mut found = Vec::new();
    for (k, figure) in scene.figures.iter().enumerate() {
        let stage = figure.needs("front").stage;
        let first = scene.stages.iter().position(|other| stage == Some(other.name.as_str()));
        let Some(first) = first else { continue };
        let longest: f64 = scene.stages[first..].iter().map(|stage| stage.end.longest()).sum();
        let of_column = column.filter(|_| figure.is_scaled() && spreads(scene));
        let unit = of_column.and_then(|column| gravity_time(scene, SETTLED * column.height));
        let (unit, units) = unit.map_or((1.0, "s"), |unit| (unit, "√(H₀/g)"));
        let beyond = figure.times().iter().filter(|time| **time * unit > longest * (1.0 + 1e-9));
        let beyond: Vec<String> = beyond.map(|time| format!("{time} {units}")).collect();
        if !beyond.is_empty() {
            found.push(format!(
                "figures.{k} `{}`: the run ends before {}; from the start of `{}` on it lasts at most {longest} s",
                figure.path(),
                beyond.join(", "),
                scene.stages[first].name,
            ));
        }
    }
    found
}

fn units(scene: &Scene, record: &StageRecord, column: Option<ColumnSize>) -> Units {
    let time = column.filter(|_| spreads(scene)).and_then(|_| gravity_time(scene, record.height));
    Units { start: record.start, time: time.unwrap_or(1.0), scaled: time.is_some() }
}

impl Units {
    fn time_label(&self) -> &'static str {
        match (self.scaled, self.start > 0.0) {
            (true, _) => "time after release, t / √(H₀/g) [-]",
            (false, true) => "time since the stage began [s]",
            (false, false) => "time [s]",
        }
    }

    /// How a time in these units is written.
    fn name_of(&self, time: f64) -> String {
        if self.scaled { format!("t = {time} √(H₀/g)") } else { format!("t = {time} s") }
    }

    /// How a simulated time \[s\] is written.
    fn label(&self, simulated: f64) -> String {
        let since = simulated - self.start;
        // Differences of round-off are none.
        let since = if since.abs() <= 1e-12 * simulated.abs() { 0.0 } else { since / self.time };
        let rounded = if self.scaled { (100.0 * since).round() / 100.0 } else { four_digits(since) };
        // Zero has no sign.
        self.name_of(rounded + 0.0)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::SceneText;

    fn template(edits: &[&str]) -> Scene {
        let (name, text) = crate::TEMPLATES.iter().find(|(name, _)| *name == "sample").unwrap();
        let mut text = SceneText::new(*name, *text);
        edits.iter().for_each(|edit| text.set(edit).unwrap());
        text.parse().unwrap()
    }

    #[test]
    fn a_column_that_is_held_in_a_silo_has_seconds_and_one_that_spreads_its_own_time() {
        let silo = template(&[]);
        assert!(silo.walls.iter().any(|wall| matches!(wall, WallSpec::Right { .. })));
        let record: StageRecord = serde_json::from_value(
            json!({ "name": "settle", "start": 0.5, "dt": 1e-5, "front": 0.05, "height": 0.0981 }),
        )
        .unwrap();
        let column = Some(ColumnSize { width: 0.05, height: 0.1, depth: None, round: None });
        let found = units(&silo, &record, column);
        assert_eq!(
            (found.scaled, found.time, found.time_label()),
            (false, 1.0, "time since the stage began [s]")
        );
        let spread = template(&["walls=[Floor(material: \"wall\"), Left(material: \"wall\")]"]);
        assert!(spreads(&spread));
        let gate = "walls=[Right(material: \"wall\"), Gate(material: \"wall\", opens: \"settle\")]";
        let found = units(&template(&[gate]), &record, column);
        assert!(found.scaled && (found.time - 0.1).abs() < 1e-12, "{found:?}");
        // Without a column there is no such time.
        assert!(!units(&spread, &record, None).scaled);
    }

    #[test]
    fn times_are_written_with_the_digits_that_they_have() {
        let seconds = Units { start: 0.3, time: 1.0, scaled: false };
        assert_eq!(seconds.label(0.1 + 0.2), "t = 0 s");
        assert_eq!(seconds.label(0.304), "t = 0.004 s");
        let scaled = Units { start: 0.3, time: 0.1, scaled: true };
        assert_eq!(
            (scaled.label(0.2999), scaled.label(0.27)),
            ("t = 0 √(H₀/g)".to_owned(), "t = -0.3 √(H₀/g)".to_owned())
        );
    }
}
