//! Draws one figure of each kind into the folder given as argument.

use granular_io::figure::{Axis, Chain, Chart, Grain, GrainFigure, GrainPanel, Panels, Series, Style};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: demo_figures FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    energy().figure().save(&folder.join("energy"))?;
    pareto().figure().save(&folder.join("pareto"))?;
    let charts = vec![energy(), pareto(), profile(), energy()];
    Panels::new("Four charts", 2, charts).figure().save(&folder.join("panels"))?;
    collapse().figure().save(&folder.join("collapse"))?;
    chains().figure().save(&folder.join("chains"))?;
    Ok(())
}

/// Numbers in 0..1 that are the same on every machine.
fn noise(i: usize) -> f64 {
    let mixed = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1_u64 << 53) as f64
}

fn energy() -> Chart {
    let curve = |f: &dyn Fn(f64) -> f64, n: usize| -> Vec<[f64; 2]> {
        (0..=n).map(|i| 2.0 * i as f64 / n as f64).map(|t| [t, f(t)]).collect()
    };
    let kinetic = |t: f64| 3.1e-6 * (-1.4 * t).exp() * (1.0 + 0.3 * (9.0 * t).cos());
    let theory = |t: f64| 3.1e-6 * (-1.4 * t).exp();
    Chart::new("Energy of a settling column", Axis::linear("time [s]"), Axis::linear("kinetic energy [J]"))
        .with(Series::new("simulation", curve(&kinetic, 300), Style::Line))
        .with(Series::new("experiment", curve(&|t| theory(t) * 1.04, 14), Style::Markers))
        .with(Series::new("E₀ exp(−1.4 t)", curve(&theory, 100), Style::Dashed).colour(7))
        .note("N = 3000, seed 7, e = 0.9, µ = 0.5")
}

fn pareto() -> Chart {
    let mut chart =
        Chart::new("Error against run time", Axis::log("wall time [s]"), Axis::log("relative error [-]"));
    for (k, name) in ["velocity Verlet", "leapfrog", "symplectic Euler", "Runge–Kutta 4"].iter().enumerate()
    {
        let order = [2.0, 2.0, 1.0, 4.0][k];
        let cost = [1.0, 1.1, 0.8, 4.2][k];
        let points = (0..6).map(|i| {
            [0.02 * cost * 2_f64.powi(i), (0.02 / (k + 1) as f64) * 2_f64.powf(-order * f64::from(i))]
        });
        chart = chart.with(Series::new(*name, points.collect(), Style::LineAndMarkers));
    }
    let mut all: Vec<[f64; 2]> = chart.series.iter().flat_map(|series| series.points.clone()).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut front: Vec<[f64; 2]> = Vec::new();
    for point in all {
        if front.last().is_none_or(|best| point[1] < best[1]) {
            front.push(point);
        }
    }
    chart.with(Series::new("Pareto front", front, Style::Dashed).colour(7))
}

fn profile() -> Chart {
    let points: Vec<[f64; 2]> = (0..=20).map(|i| i as f64 / 20.0).map(|y| [y, y.powf(1.5)]).collect();
    let edge = |by: f64| points.iter().map(|[_, v]| v + by * (0.3 + v)).collect();
    let band = Style::Band { low: edge(-0.12), high: edge(0.12) };
    let measured: Vec<[f64; 2]> = points.iter().step_by(3).map(|[y, v]| [*y, v * 1.05 - 0.02]).collect();
    let bars = Style::ErrorBars(vec![0.06; measured.len()]);
    Chart::new("Velocity profile", Axis::linear("height y / d [-]"), Axis::linear("velocity v / √(g d) [-]"))
        .with(Series::new("mean ± deviation of 8 seeds", points, band))
        .with(Series::new("measured", measured, bars))
}

fn heap(spread: f64) -> Vec<Grain> {
    let radius = |i: usize| 0.9e-3 * (0.8 + 0.4 * noise(i));
    (0..3000)
        .map(|i| {
            let (column, row) = (i % 60, i / 60);
            let x = 2e-3 * column as f64 * spread + 1e-3 * (row % 2) as f64 + 2e-4 * noise(i);
            let y = 2e-3 * row as f64 / spread * (1.0 - 0.4 * (spread - 1.0) * column as f64 / 60.0) + 1e-3;
            Grain { center: [x, y], radius: radius(i), value: (spread - 1.0) * (x * 4.0 + y * 2.0) }
        })
        .collect()
}

fn collapse() -> GrainFigure {
    let panel = |spread: f64, label: &str| GrainPanel {
        label: label.to_owned(),
        grains: heap(spread),
        walls: vec![[[-1e-3, 0.0], [0.27, 0.0]], [[-1e-3, 0.0], [-1e-3, 0.11]]],
        chains: vec![],
    };
    let panels = vec![panel(1.0, "t = 0"), panel(1.5, "t = 1.0 τ"), panel(2.2, "t = 3.0 τ")];
    GrainFigure::new("Collapse of a column of 3000 disks", "speed [m/s]", panels)
}

fn chains() -> GrainFigure {
    let grains: Vec<Grain> =
        heap(1.0).into_iter().filter(|g| g.center[0] < 0.05 && g.center[1] < 0.06).collect();
    let mut chains = Vec::new();
    for (i, a) in grains.iter().enumerate() {
        for b in &grains[..i] {
            if (a.center[0] - b.center[0]).hypot(a.center[1] - b.center[1]) < 2.4e-3 {
                let force = 0.8 * noise(i * 7 + chains.len()).powi(4) * (0.07 - a.center[1]) / 0.07;
                chains.push(Chain { from: a.center, to: b.center, force });
            }
        }
    }
    let grains = grains.into_iter().map(|grain| Grain { value: f64::NAN, ..grain }).collect::<Vec<_>>();
    let panel = |label: &str| GrainPanel {
        label: label.to_owned(),
        grains: grains.clone(),
        walls: vec![[[-1e-3, 0.0], [0.051, 0.0]]],
        chains: chains.clone(),
    };
    let panels = vec![panel("(a) frictionless"), panel("(b) µ = 0.5")];
    let force = "normal force [N]".to_owned();
    GrainFigure { columns: 2, force, ..GrainFigure::new("Force chains", "", panels) }
}
