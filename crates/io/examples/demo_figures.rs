//! Draws one figure of each kind into the folder given as argument.

use granular_io::figure::{
    Axis, Chain, Chart, Grain, GrainFigure, GrainPanel, MapFigure, MapPanel, Panels, Series, Style,
};
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
    channel(false).figure().save(&folder.join("speed"))?;
    channel(true).figure().save(&folder.join("vorticity"))?;
    vortices().figure().save(&folder.join("vortices"))?;
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
        ..GrainPanel::default()
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
        ..GrainPanel::default()
    };
    let panels = vec![panel("(a) frictionless"), panel("(b) µ = 0.5")];
    let force = "normal force [N]".to_owned();
    GrainFigure { columns: 2, force, ..GrainFigure::new("Force chains", "", panels) }
}

/// Velocity [m/s] in a channel of 2.2 m by 0.41 m: around a disk of radius 0.05 m at (0.2, 0.2) m,
/// with vortices behind it in turn above and below. It only looks like a flow.
fn velocity([x, y]: [f64; 2]) -> [f64; 2] {
    let profile = 4.0 * 1.5 * y * (0.41 - y) / (0.41 * 0.41);
    let (dx, dy) = (x - 0.2, y - 0.2);
    let distance = dx * dx + dy * dy;
    let bend = 0.0025 / (distance * distance) * (-distance / 0.01).exp();
    let begin = 1.0 - (-(dx.max(0.0) / 0.06).powi(2)).exp();
    let wake = begin * (-(dy / 0.05).powi(2) - dx / 0.5).exp();
    let mut v = [profile * (1.0 - bend * (dx * dx - dy * dy) - 0.8 * wake), -profile * bend * 2.0 * dx * dy];
    for i in 0..12 {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let (dx, dy) = (x - 0.33 - 0.155 * f64::from(i), y - 0.2 - 0.035 * sign);
        let core = 1.2e-3 * (1.0 + 0.35 * f64::from(i));
        let turn = -sign * 22.0 * (-(dx * dx + dy * dy) / core).exp() / (1.0 + 0.12 * f64::from(i));
        v = [v[0] - turn * dy, v[1] + turn * dx];
    }
    v
}

fn channel(rotation: bool) -> MapFigure {
    let cells = [2200, 410];
    let d = 0.5e-3;
    let value = |i: usize| {
        let [x, y] = [(i % cells[0]) as f64 + 0.5, (i / cells[0]) as f64 + 0.5].map(|n| n * 1e-3);
        if (x - 0.2).hypot(y - 0.2) < 0.05 {
            f64::NAN
        } else if rotation {
            let across = velocity([x + d, y])[1] - velocity([x - d, y])[1];
            (across - velocity([x, y + d])[0] + velocity([x, y - d])[0]) / (2.0 * d)
        } else {
            velocity([x, y])[0].hypot(velocity([x, y])[1])
        }
    };
    let turn = |i: i32| (std::f64::consts::TAU * f64::from(i) / 90.0).sin_cos();
    let disk = (0..90).map(|i| [0.2 + 0.05 * turn(i).1, 0.2 + 0.05 * turn(i).0]).collect();
    let values = (0..cells[0] * cells[1]).map(value).collect();
    let panel = MapPanel { cells, values, outlines: vec![disk], ..MapPanel::default() };
    let (title, quantity) = if rotation {
        ("Vorticity behind a disk", "vorticity [s⁻¹]")
    } else {
        ("Flow around a disk in a channel", "speed [m/s]")
    };
    MapFigure {
        diverging: rotation,
        ..MapFigure::new(title, quantity, [[0.0, 0.0], [2.2, 0.41]], vec![panel])
    }
}

fn vortices() -> MapFigure {
    let panel = |n: usize, strength: f64, label: &str| {
        let wave = |i: usize| (std::f64::consts::TAU * (i as f64 + 0.5) / n as f64).sin();
        let value = |i: usize| strength * wave(i % n) * wave(i / n);
        let values = (0..n * n).map(value).collect();
        MapPanel { label: label.to_owned(), cells: [n, n], values, ..MapPanel::default() }
    };
    let panels = vec![
        panel(16, 2.0, "16 × 16 cells, t = 0"),
        panel(256, 2.0, "256 × 256 cells, t = 0"),
        panel(16, 1.1, "16 × 16 cells, t = 0.6 τ"),
        panel(256, 1.1, "256 × 256 cells, t = 0.6 τ"),
    ];
    let corners = [[0.0, 0.0], [1.0, 1.0]];
    let figure = MapFigure::new("Decay of Taylor–Green vortices", "vorticity / ω₀ [-]", corners, panels);
    MapFigure {
        diverging: true,
        values: Some([-2.0, 2.0]),
        columns: 2,
        axes: ["x / L [-]".to_owned(), "y / L [-]".to_owned()],
        ..figure
    }
}
