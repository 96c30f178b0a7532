//! What grains do after a push: run-out, duration, and the decay of motion. `docs/impacts.md` explains the numbers.

use super::column::running_median;
use super::{Metric, seen_by, table_of, title};
use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::records::PushRecord;
use crate::records::{RecordedStage, StageRecord};
use crate::scene::{FigureSpec, Scene};
use granular_io::Table;
use granular_io::figure::{Axis, Chart, Panels, Series, Style};

/// Share of the energy given below which motion is over.
const STILL: f64 = 0.01;
/// Share of its peak below which energy across is over.
const FADED: f64 = 0.1;
/// Last rows whose median is the final front.
const LAST_ROWS: usize = 9;

/// A number over time.
type Curve = Vec<[f64; 2]>;

/// A flow after a push, in units of the grains: lengths by the mean diameter d, times by sqrt(d/g), energies by m g d for each
/// grain.
#[derive(Clone, Debug)]
pub struct Impact {
    push: PushRecord,
    /// Height at the push.
    height: f64,
    /// Front at the push.
    front: f64,
    /// Front at the end.
    last_front: f64,
    /// Fronts over time.
    fronts: Curve,
    /// Energy of all motion over time.
    energy: Curve,
    /// Energy of motion along x.
    along: Curve,
    /// Energy of motion across it.
    across: Curve,
    /// When the transient is over.
    transient: f64,
}

impl Impact {
    /// From a table and the stage that begins with the push; none when it pushed nothing, without gravity, and as long as the
    /// table has no rows of the stage.
    pub fn of(table: &Table, record: &StageRecord, transient: f64) -> Option<Self> {
        let push = record.push.filter(|push| push.mass > 0.0 && push.gravity > 0.0)?;
        let second = (push.diameter / push.gravity).sqrt();
        let time = table.column("time")?;
        // A row at the time of the push itself may be of the state before it.
        let first = time.iter().position(|&time| time > record.start + 1e-6 * second)?;
        let over_time = |name: &str, unit: f64| -> Option<Curve> {
            let values = table.column(name)?;
            let rows = time.iter().zip(&values).skip(first);
            Some(rows.map(|(t, value)| [(t - record.start) / second, value / unit]).collect())
        };
        let unit = push.mass * push.gravity * push.diameter;
        let [energy, along] = [over_time("kinetic_energy", unit)?, over_time("kinetic_energy_x", unit)?];
        let fronts = over_time("front", push.diameter)?;
        let mut last: Vec<f64> = fronts.iter().rev().take(LAST_ROWS).map(|point| point[1]).collect();
        last.sort_unstable_by(f64::total_cmp);
        let height = record.height / push.diameter;
        Some(Self {
            push,
            height,
            front: record.front / push.diameter,
            last_front: *last.get(last.len() / 2)?,
            fronts: running_median(&fronts),
            across: energy.iter().zip(&along).map(|(all, along)| [all[0], all[1] - along[1]]).collect(),
            energy,
            along,
            transient: transient * height.sqrt(),
        })
    }

    /// Energy given.
    pub fn given(&self) -> f64 {
        self.push.energy / (self.push.mass * self.push.gravity * self.push.diameter)
    }

    /// `L_f / L_0`.
    pub fn length_ratio(&self) -> f64 {
        self.last_front / self.front
    }

    /// Time after which the front stays within a mean diameter of its final place.
    pub fn duration(&self) -> f64 {
        last_beyond(&self.fronts, |front| (front - self.last_front).abs() > 1.0)
    }

    /// sqrt(H/g).
    pub fn fall(&self) -> f64 {
        self.height.sqrt()
    }

    /// The duration in units of sqrt(H/g).
    pub fn duration_over_fall(&self) -> f64 {
        self.duration() / self.fall()
    }

    /// The duration from the end of the transient on.
    pub fn duration_left(&self) -> f64 {
        self.duration() - self.transient
    }

    /// Time after which the energy of motion stays below a hundredth of that given.
    pub fn motion_ends(&self) -> f64 {
        let limit = STILL * self.given();
        last_beyond(&self.energy, |energy| energy > limit)
    }

    /// When the energy across is highest, and when it has fallen to a tenth of that; with its height.
    pub fn rise(&self) -> Option<[f64; 3]> {
        let (at, peak) = self.across.iter().enumerate().max_by(|a, b| a.1[1].total_cmp(&b.1[1]))?;
        let end = crossing(&self.across[at..], FADED * peak[1])?;
        Some([peak[0], end, peak[1]])
    }

    /// Energy along x that is left when the transient is over.
    pub fn energy_left(&self) -> Option<f64> {
        value_at(&self.along, self.transient)
    }

    /// Time from the end of the transient on after which half of that is left.
    pub fn half_life(&self) -> Option<f64> {
        let left = self.energy_left()?;
        let after = self.along.iter().position(|point| point[0] >= self.transient)?;
        // The row before may lie above or below: the search begins at the end of the transient itself.
        let from = [[self.transient, left]];
        let rest: Curve = from.iter().chain(&self.along[after..]).copied().collect();
        Some(crossing(&rest, 0.5 * left)? - self.transient)
    }

    /// All numbers by name.
    fn numbers(&self) -> Vec<(&'static str, &'static str, Option<f64>)> {
        let (duration, fall) = (self.duration(), self.fall());
        let run_out = self.last_front - self.front;
        let rise = self.rise();
        vec![
            ("impact_energy", "J", Some(self.push.energy)),
            ("impact_momentum", "N s", Some(self.push.momentum)),
            ("impact_energy_per_grain", "1", Some(self.given())),
            ("impact_energy_over_potential", "1", Some(self.push.energy / self.push.potential)),
            ("impact_height_over_diameter", "1", Some(self.height)),
            ("impact_length_ratio", "1", Some(self.length_ratio())),
            ("impact_runout", "1", Some(run_out / self.front)),
            ("impact_duration", "1", Some(duration)),
            ("impact_duration_over_fall", "1", Some(self.duration_over_fall())),
            ("impact_speed", "1", Some(run_out / duration)),
            ("impact_motion_ends", "1", Some(self.motion_ends())),
            ("impact_rise_peak", "1", rise.map(|rise| rise[0])),
            ("impact_rise_ends", "1", rise.map(|rise| rise[1])),
            ("impact_rise_share", "1", rise.map(|rise| rise[2] / self.given())),
            ("impact_energy_left", "1", self.energy_left()),
            ("impact_half_life", "1", self.half_life()),
            ("impact_half_life_over_fall", "1", self.half_life().map(|time| time / fall)),
            ("impact_duration_left", "1", Some(self.duration_left())),
        ]
    }
}

/// Time of the first point after the last one that is beyond; zero when none is.
fn last_beyond(curve: &[[f64; 2]], beyond: impl Fn(f64) -> bool) -> f64 {
    let last = curve.iter().rposition(|point| beyond(point[1]));
    last.map_or(0.0, |last| curve[(last + 1).min(curve.len() - 1)][0])
}

/// When a curve first falls to a level, linear between its points.
fn crossing(curve: &[[f64; 2]], level: f64) -> Option<f64> {
    let after = curve.iter().position(|point| point[1] <= level)?;
    let [later, high] = [curve[after], curve[after.max(1) - 1]];
    let share = if high[1] > later[1] { (high[1] - level) / (high[1] - later[1]) } else { 1.0 };
    Some(high[0] + share * (later[0] - high[0]))
}

/// Value of a curve at a time, linear between its points.
fn value_at(curve: &[[f64; 2]], time: f64) -> Option<f64> {
    let after = curve.iter().position(|point| point[0] >= time)?;
    let [later, before] = [curve[after], curve[after.max(1) - 1]];
    let share = if later[0] > before[0] { (time - before[0]) / (later[0] - before[0]) } else { 1.0 };
    Some(before[1] + share * (later[1] - before[1]))
}

/// Numbers of all impacts of a scene; of several the last counts.
pub(super) fn metrics(scene: &Scene, folder: &RunFolder, records: &[RecordedStage]) -> Vec<Metric> {
    let mut metrics: Vec<Metric> = Vec::new();
    for figure in &scene.figures {
        let FigureSpec::Impact { table, stage, transient, .. } = figure else { continue };
        let records = seen_by(scene, records, figure);
        let record = records.iter().find(|record| record.name == *stage);
        let (Some(record), Ok(table)) = (record, table_of(folder, table)) else { continue };
        let Some(impact) = Impact::of(&table, record, *transient) else { continue };
        for (name, unit, value) in impact.numbers() {
            let Some(value) = value.filter(|value| value.is_finite()) else { continue };
            metrics.retain(|metric| metric.name != name);
            metrics.push(Metric { name: name.to_owned(), unit, value });
        }
    }
    metrics
}

/// Front, energies and decay over time, as figures 4.29 to 4.35 of \[Kumar2014\] draw them.
pub(super) fn panels(
    scene: &Scene,
    table: &Table,
    record: &StageRecord,
    transient: f64,
) -> Result<Panels, Failure> {
    let impact = Impact::of(table, record, transient).ok_or_else(|| {
        let reason = "pushed no grains with a weight, so there is no figure of its impact";
        Failure::Io(format!("stage `{}` {reason}", record.name))
    })?;
    let charts = vec![impact.front_chart(), impact.energy_chart(), impact.decay_chart()];
    Ok(Panels::new(title(scene, "after the push"), charts.len(), charts))
}

const TIME: &str = "time after the push, t / √(d/g) [-]";

impl Impact {
    fn front_chart(&self) -> Chart {
        let points = self.fronts.iter().map(|[t, front]| [*t, (front - self.front) / self.front]).collect();
        Chart::new("Run-out", Axis::linear(TIME), Axis::linear("(L − L₀) / L₀ [-]"))
            .note(format!("E₀ = {:.4} m g d; final run-out {:.3}", self.given(), self.length_ratio() - 1.0))
            .note(format!("within a mean diameter of it after {:.1} √(d/g)", self.duration()))
            .with(Series::new("", points, Style::Line))
    }

    fn energy_chart(&self) -> Chart {
        let given = self.given();
        let share = |curve: &[[f64; 2]]| curve.iter().map(|[t, energy]| [*t, energy / given]).collect();
        let mut chart = Chart::new("Energy of motion", Axis::linear(TIME), Axis::linear("energy / E₀ [-]"))
            .with(Series::new("all", share(&self.energy), Style::Line).colour(7))
            .with(Series::new("along x", share(&self.along), Style::Line))
            .with(Series::new("across", share(&self.across), Style::Line));
        if let Some([peak, end, _]) = self.rise() {
            chart = chart.note(format!("across: highest at {peak:.1}, a tenth of that at {end:.1} √(d/g)"));
        }
        chart
    }

    fn decay_chart(&self) -> Chart {
        let axes = (Axis::linear("time after the transient, t' / τ [-]"), Axis::linear("E_x / E_x(t₁) [-]"));
        let mut chart = Chart::new("Decay along x", axes.0, axes.1);
        if let (Some(left), Some(half_life)) = (self.energy_left(), self.half_life().filter(|t| *t > 0.0)) {
            let after = self.along.iter().filter(|point| point[0] >= self.transient);
            let points = after.map(|[t, energy]| [(t - self.transient) / half_life, energy / left]).collect();
            chart = chart
                .with(Series::new("", points, Style::Line))
                .note(format!("t₁ = {:.1} √(d/g), half-life τ = {half_life:.2} √(d/g)", self.transient));
        }
        chart
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Front, energies along x and across of a made-up flow: grains of 1 m and 1 kg, gravity 1, a pile 4 m high and 10 m
    /// long with E_p = 50 J.
    fn impact(rows: impl Iterator<Item = [f64; 4]>) -> Impact {
        let columns = ["time", "front", "kinetic_energy", "kinetic_energy_x"];
        let rows: Vec<Vec<f64>> =
            rows.map(|[t, front, along, across]| vec![t, front, along + across, along]).collect();
        let columns = columns.map(|name| (name.to_owned(), "1".to_owned())).to_vec();
        let push = PushRecord {
            energy: 100.0,
            momentum: 20.0,
            speed: 2.0,
            diameter: 1.0,
            mass: 10.0,
            gravity: 1.0,
            potential: 50.0,
        };
        let record =
            StageRecord { name: "impact".to_owned(), start: 5.0, front: 10.0, height: 4.0, push: Some(push) };
        Impact::of(&Table { columns, rows }, &record, 1.0).unwrap()
    }

    #[test]
    fn numbers_of_a_flow_in_closed_form() {
        // The front moves 12 m in 6 s; energy along x halves every 3 s; energy across is a hat with its peak at 1 s.
        let rows = (0..400).map(|k| {
            let t = 0.1 * f64::from(k) - 5.0;
            let along = if t < 0.0 { 0.0 } else { 100.0 * 0.5_f64.powf(t / 3.0) };
            let across = if t < 0.0 { 0.0 } else { (20.0 * t.min(2.0 - t)).max(0.0) };
            [t + 5.0, 10.0 + 2.0 * t.clamp(0.0, 6.0), along, across]
        });
        let impact = impact(rows);
        let numbers = impact.numbers();
        let found = |name: &str| numbers.iter().find(|number| number.0 == name).unwrap().2.unwrap();
        let near = |name: &str, value: f64, error: f64| {
            assert!((found(name) - value).abs() <= error, "{name}: {} not {value}", found(name));
        };
        near("impact_energy_per_grain", 10.0, 1e-12);
        near("impact_energy_over_potential", 2.0, 1e-12);
        near("impact_length_ratio", 2.2, 1e-12);
        near("impact_runout", 1.2, 1e-12);
        // Within 1 m of 22 m from 5.5 s on, but for the time between rows.
        near("impact_duration", 5.5, 0.11);
        near("impact_duration_over_fall", 2.75, 0.06);
        near("impact_rise_peak", 1.0, 0.051);
        near("impact_rise_ends", 1.9, 1e-9);
        near("impact_rise_share", 0.2, 1e-12);
        // The transient is one sqrt(H/g), 2 s.
        near("impact_energy_left", 10.0 * 0.5_f64.powf(2.0 / 3.0), 1e-9);
        near("impact_half_life", 3.0, 1e-9);
        near("impact_half_life_over_fall", 1.5, 1e-9);
        near("impact_duration_left", found("impact_duration") - 2.0, 1e-12);
        // A hundredth is left after 3 s times log2 of 100.
        near("impact_motion_ends", 3.0 * 100.0_f64.log2(), 0.11);
    }

    #[test]
    fn what_never_happens_has_no_number() {
        let impact = impact((0..100).map(|k| [5.0 + 0.1 * f64::from(k), 10.0, 100.0, 0.0]));
        assert_eq!(impact.half_life(), None);
        assert_eq!(impact.duration(), 0.0);
        assert!((impact.motion_ends() - 9.9).abs() < 1e-9);
    }
}
