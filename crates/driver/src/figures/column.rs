//! Figures of a collapsing column: run-out and height, and where the energy goes.

use super::{Units, title, with_references};
use crate::column::ColumnSize;
use crate::records::StageRecord;
use crate::scene::outputs::LawSpec;
use crate::scene::{ReferenceCurve, Scene};
use granular_io::Table;
use granular_io::figure::{Axis, Chart, Panels, Series, Style};

/// What the run-out of a column is drawn beside.
pub(super) struct Compared<'a> {
    pub(super) column: Option<ColumnSize>,
    pub(super) laws: &'a [LawSpec],
    pub(super) references: &'a [ReferenceCurve],
}

/// Run-out and height over time, as figures 4.8 to 4.12 of \[Kumar2014\] draw them.
pub(super) fn runout(
    scene: &Scene,
    table: &Table,
    release: &StageRecord,
    Compared { column, laws, references }: Compared<'_>,
) -> Panels {
    let units = super::units(scene, release, column);
    let width = column.map_or(release.front, |column| column.width);
    let front = column.map_or("front", |column| column.front());
    let aspect = release.height / width;
    let over_time = |name: &str, map: &dyn Fn(f64) -> f64| {
        let values = table.column(name).unwrap_or_default();
        let time = table.column("time").unwrap_or_default();
        let pairs = time.into_iter().zip(values).filter(|(t, _)| *t >= units.start);
        pairs.map(|(t, value)| [(t - units.start) / units.time, map(value)]).collect::<Vec<_>>()
    };
    // Grains at the front touch the main mass off and on; the median shows where it is.
    let run_out = running_median(&over_time(front, &|front| (front - width) / width));
    let height = running_median(&over_time("height", &|height| height / width));
    let last = |points: &[[f64; 2]]| points.last().map_or(f64::NAN, |point| point[1]);
    let ends = run_out.first().zip(run_out.last()).map_or([0.0; 2], |(first, last)| [first[0], last[0]]);
    let [spread, high, unit] = if front == "front" {
        ["(L − L₀) / L₀ [-]", "H / L₀ [-]", "L₀"]
    } else {
        ["(r − r₀) / r₀ [-]", "H / r₀ [-]", "r₀"]
    };
    let label = if laws.is_empty() { "" } else { "this run" };
    let mut charts = vec![
        Chart::new("Run-out", Axis::linear(units.time_label()), Axis::linear(spread))
            .note(format!(
                "a = {aspect:.2}; final run-out {:.3}; running median of {MEDIAN} rows",
                last(&run_out)
            ))
            .note("front: farthest point of the largest mass that hangs together;")
            .note("it falls back when pieces at the edge part from it")
            .with(Series::new(label, run_out, Style::Line)),
        Chart::new("Height", Axis::linear(units.time_label()), Axis::linear(high))
            .note(format!("final height {:.3} {unit}", last(&height)))
            .with(Series::new(label, height, Style::Line).colour(1)),
    ];
    for (chart, of_height) in charts.iter_mut().zip([false, true]) {
        for law in laws.iter().filter(|law| law.of_height == of_height) {
            let value = law.at(aspect);
            let level = ends.map(|time| [time, value]).to_vec();
            let label = format!("{}: {value:.2}", law.label);
            *chart = std::mem::take(chart).with(Series::new(label, level, Style::Dashed).colour(7));
        }
    }
    charts[0] = with_references(std::mem::take(&mut charts[0]), references);
    Panels::new(title(scene, "run-out and height"), 2, charts)
}

/// Rows that a running median takes.
pub(super) const MEDIAN: usize = 9;

/// Median of y over the neighbouring points, fewer at the ends; the last point stays.
pub fn running_median(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let median = |k: usize| {
        let reach = (MEDIAN / 2).min(k).min(points.len() - 1 - k);
        let mut window: Vec<f64> = points[k - reach..=k + reach].iter().map(|point| point[1]).collect();
        window.sort_unstable_by(f64::total_cmp);
        [points[k][0], window[reach]]
    };
    (0..points.len()).map(median).collect()
}

/// Curves of the figure of energies: label, and the columns that are summed. Losses count from the start of the stage; energies are
/// absolute.
const CURVES: &[(&str, &[&str])] = &[
    ("potential", &["potential_energy"]),
    ("kinetic", &["kinetic_energy", "rotational_energy"]),
    ("elastic", &["elastic_energy"]),
    ("lost by sliding between grains", &["loss_sliding"]),
    ("lost by sliding at walls", &["loss_sliding_at_walls"]),
    ("lost in dashpots", &["loss_normal_damping", "loss_tangential_damping"]),
    ("lost by rolling", &["loss_rolling"]),
    ("lost to plastic strain", &["loss_plastic"]),
    ("lost to viscosity", &["loss_viscous"]),
    ("lost in impacts on walls", &["loss_stopping_at_walls"]),
    ("lost to damping", &["loss_local_damping", "loss_pic"]),
    ("missing in the balance", &["energy_residual"]),
];

/// Energies over the energy at the start, as figure 4.14 of \[Kumar2014\] draws them.
pub(super) fn energies(scene: &Scene, table: &Table, units: Units) -> Chart {
    let time = table.column("time").unwrap_or_default();
    let column = |name: &str| table.column(name).unwrap_or_else(|| vec![0.0; time.len()]);
    let first = time.iter().position(|&t| t >= units.start - 1e-12).unwrap_or(0);
    let potential = column("potential_energy");
    let scale = potential.get(first).copied().unwrap_or(1.0);
    let mut chart = Chart::new(
        title(scene, "where the energy goes"),
        Axis::linear(units.time_label()),
        Axis::linear("energy over the potential energy at the start [-]"),
    );
    for (label, names) in CURVES {
        // Each method has losses of its own.
        if names.iter().all(|name| table.column(name).is_none()) {
            continue;
        }
        let from_start = names.iter().any(|name| name.starts_with("loss_") || *name == "energy_residual");
        let mut sum = vec![0.0; time.len()];
        for name in *names {
            sum.iter_mut().zip(column(name)).for_each(|(sum, value)| *sum += value);
        }
        // Grains that roll freely lose nothing by rolling.
        if sum.iter().all(|value| *value == 0.0) {
            continue;
        }
        let offset = if from_start { sum.get(first).copied().unwrap_or(0.0) } else { 0.0 };
        let points = time.iter().zip(&sum).skip(first);
        let points = points.map(|(t, value)| [(t - units.start) / units.time, (value - offset) / scale]);
        let style = if label.starts_with("missing") { Style::Dashed } else { Style::Line };
        chart = chart.with(Series::new(*label, points.collect(), style));
    }
    chart
}
