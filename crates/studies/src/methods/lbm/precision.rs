//! Flows with known answers: error against cells, Mach number, operator and storage.

use super::cases::cavity::{Cavity, EXTREMES, extremes};
use super::cases::cylinder::{Channel, SHED, shed_references};
use super::cases::decay::Vortices;
use crate::bench::Precision;
use crate::bench::study::{Point, Study};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_driver::statistics::{order, root_mean_square};
use granular_lbm::{D2Q9, Operator, Real};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

pub(super) const STUDIES: &[Precision] = &[
    Precision {
        name: "taylor-green",
        about: "Decaying vortices over cells, Mach number, operator and storage; takes a minute",
        run: taylor_green,
    },
    Precision {
        name: "cavity",
        about: "Lid-driven cavity over the same; takes one to two minutes",
        run: cavity,
    },
    Precision {
        name: "schaefer-turek",
        about: "Unsteady cylinder of Schaefer and Turek over the same; takes five to eight minutes on two cores",
        run: schaefer_turek,
    },
];

/// Reynolds number of the vortices, on the side of the box and the largest speed.
const VORTEX_REYNOLDS: f64 = 100.0;
/// Time of the cavity, in units of side over lid speed.
const CAVITY_TIME: f64 = 80.0;
/// Cells that the lid of the cavity, and the stream around the cylinder, moves in a step, but in the series over the
/// Mach number.
const LID: f64 = 0.1;
const STREAM: f64 = 0.06;

const SINGLE: (&str, Operator) = ("single", Operator::SingleRelaxation);
const TWO: (&str, Operator) = ("two", Operator::TwoRelaxation { magic: 3.0 / 16.0 });
const MULTIPLE: (&str, Operator) = ("multiple", Operator::EXACT_WALLS);
const REGULARISED: (&str, Operator) = ("regularised", Operator::Regularised);

/// One run.
#[derive(Clone, Debug)]
struct Run {
    scheme: String,
    operator: Operator,
    cells: usize,
    /// Largest speed, in cells per step.
    speed: f64,
    is_single_precision: bool,
    /// Whether it is one of a series of cells, of which an order is fitted.
    is_refined: bool,
}

/// What a run comes to.
struct Measured {
    dt: f64,
    error: f64,
    /// What the error is made of.
    parts: String,
}

type Measure = fn(&Run) -> Result<Measured, Failure>;

/// Runs over cells, with the speed in cells per step that belongs to each.
fn refined(
    (name, operator): (&str, Operator),
    cells: &[usize],
    speed: impl Fn(usize) -> f64,
    is_single_precision: bool,
) -> Vec<Run> {
    let storage = if is_single_precision { ", f32" } else { "" };
    let run = |&cells: &usize| Run {
        scheme: format!("{name}{storage}"),
        operator,
        cells,
        speed: speed(cells),
        is_single_precision,
        is_refined: true,
    };
    cells.iter().map(run).collect()
}

/// Runs over the speed in cells per step.
fn slowed((name, operator): (&str, Operator), cells: usize, speeds: &[f64]) -> Vec<Run> {
    let run = |&speed: &f64| Run {
        scheme: format!("{name}, {cells} cells, over Mach"),
        operator,
        cells,
        speed,
        is_single_precision: false,
        is_refined: false,
    };
    speeds.iter().map(run).collect()
}

fn taylor_green() -> Result<Study, Failure> {
    // The Mach number falls with the cell: both errors are of second order then.
    let speed = |cells: usize| 1.6 / cells as f64;
    let cells = [16, 24, 32, 48, 64, 96, 128];
    let mut runs = Vec::new();
    for scheme in [SINGLE, TWO, MULTIPLE, REGULARISED] {
        runs.extend(refined(scheme, &cells, speed, false));
    }
    runs.extend(refined(MULTIPLE, &cells, speed, true));
    runs.extend(slowed(MULTIPLE, 64, &[0.2, 0.1, 0.05, 0.025, 0.0125, 0.00625]));
    let about = format!(
        "vortices of Taylor and Green in a periodic square, Reynolds number {VORTEX_REYNOLDS} on its side, until they \
         are at 1/e; error: root mean square of the velocity over that left; dt in units of side^2 over viscosity; \
         speed 1.6 cells per step over the number of cells, but in the series over Mach, 0.2 to 0.00625"
    );
    study("taylor-green", "error of the velocity [-]", &runs, vortices, about)
}

fn vortices(run: &Run) -> Result<Measured, Failure> {
    let viscosity = run.speed * run.cells as f64 / VORTEX_REYNOLDS;
    let case = Vortices {
        operator: run.operator,
        side: run.cells,
        tau: 0.5 + 3.0 * viscosity,
        speed: run.speed,
        decay: 1.0,
    };
    let decayed =
        if run.is_single_precision { case.run::<D2Q9, 9, f32>() } else { case.run::<D2Q9, 9, f64>() }?;
    let dt = viscosity / (run.cells * run.cells) as f64;
    Ok(Measured { dt, error: decayed.velocity, parts: String::new() })
}

fn cavity() -> Result<Study, Failure> {
    let cells = [32, 48, 64, 96];
    let mut runs = Vec::new();
    for scheme in [SINGLE, TWO, MULTIPLE, REGULARISED] {
        runs.extend(refined(scheme, &cells, |_| LID, false));
    }
    runs.extend(refined(MULTIPLE, &cells, |_| LID, true));
    runs.extend(slowed(MULTIPLE, 48, &[0.17, 0.12, 0.05, 0.025]));
    let about = format!(
        "lid-driven cavity, Reynolds number 1000, {CAVITY_TIME} sides over lid speed from rest; error: root mean square \
         of the differences of three extremes on the centre lines from the spectral ones, over the lid's speed; dt in \
         units of side over lid speed; the lid moves {LID} cells a step, but in the series over Mach, 0.17 to 0.025"
    );
    study("cavity", "error of extremes on the centre lines [-]", &runs, lid, about)
}

fn lid(run: &Run) -> Result<Measured, Failure> {
    fn found<T: Real>(run: &Run) -> Result<[f64; 3], Failure> {
        let Run { operator, cells: side, speed: lid, .. } = *run;
        Ok(extremes(&Cavity { operator, reynolds: 1000.0, side, lid, time: CAVITY_TIME }.run::<T>()?))
    }
    let found = if run.is_single_precision { found::<f32>(run) } else { found::<f64>(run) }?;
    let errors: [f64; 3] = std::array::from_fn(|i| found[i] - EXTREMES[i].1);
    let parts = EXTREMES.iter().zip(errors).map(|((name, _), error)| format!("{name} {error:+.4}"));
    let parts = parts.collect::<Vec<_>>().join(", ");
    Ok(Measured { dt: run.speed / run.cells as f64, error: root_mean_square(&errors), parts })
}

fn schaefer_turek() -> Result<Study, Failure> {
    let stream = |_| STREAM;
    let mut runs = refined(MULTIPLE, &[10, 20, 30], stream, false);
    runs.extend(refined(REGULARISED, &[10, 20, 30], stream, false));
    // One relaxation time bears neither size; that it stops is told.
    runs.extend(refined(SINGLE, &[10, 20], stream, false));
    runs.extend(refined(TWO, &[10, 20], stream, false));
    runs.extend(refined(REGULARISED, &[10, 20], stream, true));
    runs.extend(slowed(REGULARISED, 10, &[0.12, 0.06, 0.03, 0.015]));
    let about = format!(
        "cylinder of Schaefer and Turek, 2D-2, Reynolds number 100, 8 s to start and 2 s measured; error: root mean \
         square of the relative errors of three numbers; {STREAM} cells a step enter, but in the series over Mach, \
         0.12 to 0.015"
    );
    study("schaefer-turek", "error of drag, lift and Strouhal number [-]", &runs, cylinder, about)
}

fn cylinder(run: &Run) -> Result<Measured, Failure> {
    let Run { operator, cells, speed: lattice, .. } = *run;
    let channel = Channel { operator, cells, lattice };
    let found = if run.is_single_precision { channel.shed::<f32>() } else { channel.shed::<f64>() }?;
    let references = shed_references();
    let errors: [f64; 3] = std::array::from_fn(|i| found[i] / references[i] - 1.0);
    let parts = SHED.iter().zip(errors).map(|(name, error)| format!("{name} {:+.2} %", 100.0 * error));
    let parts = parts.collect::<Vec<_>>().join("; ");
    Ok(Measured { dt: channel.dt(), error: root_mean_square(&errors), parts })
}

/// Runs everything, each run on one thread, and fits orders.
fn study(
    case: &'static str,
    error: &'static str,
    runs: &[Run],
    measure: Measure,
    about: String,
) -> Result<Study, Failure> {
    // The longest runs first, so that no thread is left waiting at the end.
    let mut queue: Vec<usize> = (0..runs.len()).collect();
    queue.sort_by(|&a, &b| cost(&runs[b]).total_cmp(&cost(&runs[a])));
    let mut done = parallel::each(&queue, |&index| {
        let begun = Instant::now();
        let measured = measure(&runs[index]);
        Ok((index, measured, begun.elapsed().as_secs_f64()))
    })?;
    done.sort_by_key(|(index, ..)| *index);
    let mut notes = vec![
        about,
        "wall time of a run on one thread, set-up included; runs go side by side on all threads".to_owned(),
        "orders are least squares in the logarithms of error and cell; over Mach, in those of step and of what the \
         error is over that of the smallest step, which the cells leave"
            .to_owned(),
    ];
    let mut points = Vec::new();
    for (index, measured, seconds) in done {
        let Run { scheme, cells, speed, .. } = &runs[index];
        let measured = match measured {
            Ok(measured) => measured,
            // A flow that blows up is a result, not a failure of the study.
            Err(Failure::Stopped { reason, .. }) => {
                let reason = reason.split(';').next().unwrap_or_default();
                notes.push(format!("{scheme}, {cells} cells, {speed} cells per step: {reason}"));
                continue;
            }
            Err(failure) => return Err(failure),
        };
        if !measured.parts.is_empty() {
            notes.push(format!("{scheme}, {cells} cells, {speed} cells per step: {}", measured.parts));
        }
        points.push((index, point(&runs[index], &measured, seconds)));
    }
    let orders = orders(runs, &points);
    let points = points.into_iter().map(|(_, point)| point).collect();
    Ok(Study { case, error, resolution: "cells across", points, orders, notes }.mark_front())
}

/// Cells times steps, but for a factor.
fn cost(run: &Run) -> f64 {
    (run.cells as f64).powi(3) / run.speed
}

fn point(run: &Run, measured: &Measured, seconds: f64) -> Point {
    Point::of_one_run(&run.scheme, run.cells as f64, measured.dt, measured.error, seconds)
}

/// Orders of the schemes, from three points or more.
fn orders(runs: &[Run], points: &[(usize, Point)]) -> BTreeMap<String, f64> {
    let mut lines: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    for (index, point) in points {
        let line = lines.entry(point.scheme.clone()).or_default();
        let is_refined = runs[*index].is_refined;
        line.push((if is_refined { 1.0 / point.resolution } else { point.dt }, point.error));
    }
    let over_mach: BTreeSet<&String> =
        runs.iter().filter(|run| !run.is_refined).map(|run| &run.scheme).collect();
    for (scheme, line) in &mut lines {
        if over_mach.contains(scheme) {
            over_the_floor(line);
        }
    }
    lines.retain(|_, line| line.len() > 2);
    lines.into_iter().map(|(scheme, line)| (scheme, order(&line))).collect()
}

/// Takes the error of the smallest step off the others, and leaves those out that are not twice as large.
fn over_the_floor(line: &mut Vec<(f64, f64)>) {
    line.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(_, floor)) = line.first() else { return };
    line.retain(|(_, error)| *error > 2.0 * floor);
    line.iter_mut().for_each(|(_, error)| *error -= floor);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of second order, but that fine cells blow up.
    fn synthetic(run: &Run) -> Result<Measured, Failure> {
        if run.cells > 64 {
            return Err(Failure::Stopped { reason: "too dense".to_owned(), hint: String::new() });
        }
        let error =
            3.0 / (run.cells * run.cells) as f64 + if run.is_refined { 0.0 } else { run.speed.powi(2) };
        Ok(Measured { dt: run.speed, error, parts: "lift".to_owned() })
    }

    #[test]
    fn orders_are_fitted_and_blow_ups_told() {
        let mut runs = refined(MULTIPLE, &[16, 32, 64, 128], |_| 0.1, false);
        runs.extend(slowed(MULTIPLE, 32, &[1.6, 0.8, 0.4, 1e-6]));
        let study = study("taylor-green", "error", &runs, synthetic, String::new()).unwrap();
        assert_eq!(study.points.len(), 7);
        assert_eq!(study.orders.len(), 2);
        assert!((study.orders["multiple"] - 2.0).abs() < 1e-12);
        assert!((study.orders["multiple, 32 cells, over Mach"] - 2.0).abs() < 1e-6, "{study}");
        assert!(study.notes.iter().any(|note| note.contains("128 cells") && note.contains("too dense")));
        let resolutions: Vec<f64> = study.points.iter().map(|point| point.resolution).collect();
        assert_eq!(resolutions, [16.0, 32.0, 64.0, 32.0, 32.0, 32.0, 32.0]);
    }

    #[test]
    fn coarse_vortices_are_of_second_order_in_both_storages() {
        for is_single in [false, true] {
            let runs = refined(SINGLE, &[16, 24, 32], |cells| 1.6 / cells as f64, is_single);
            let study = study("taylor-green", "error", &runs, vortices, String::new()).unwrap();
            let order = study.orders.values().next().unwrap();
            assert!((order - 2.0).abs() < 0.3, "{study}");
        }
    }
}
