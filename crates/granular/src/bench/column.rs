//! Run-out of a column: error of an ensemble mean against stiffness, step and run time.

use super::study::{CONTACT, Point, Study};
use crate::failure::Failure;
use crate::validate::collapse::{Collapse, Fallen};
use crate::validate::fit::{mean_and_error, median};
use crate::validate::parallel;
use std::collections::BTreeMap;

const GRAINS: usize = 400;
const SEEDS: u64 = 10;
/// Normal stiffness of the grains \[N/m\]; the last is the reference.
const STIFFNESS: [f64; 4] = [1e5, 4e5, 1.6e6, 6.4e6];
/// Stiffness of the walls over that of the grains, as in table 4.2 of \[Kumar2014\].
const WALLS: f64 = 2.5;
/// Steps in the shortest contact time; the last is the reference.
const RESOLUTIONS: [f64; 3] = [10.0, 25.0, 50.0];

/// One run of the study.
struct Job {
    stiffness: f64,
    resolution: f64,
    seed: u64,
}

impl Job {
    fn run(&self) -> Result<Fallen, Failure> {
        let Self { stiffness, resolution, seed } = self;
        Collapse::of(GRAINS)
            .seed(*seed)
            .set(format!("materials.glass.normal_stiffness={stiffness:e}"))
            .set(format!("materials.wall.normal_stiffness={:e}", WALLS * stiffness))
            .set(format!("solvers.grains.0.steps_per_contact={resolution}"))
            .run()
    }
}

pub(super) fn study() -> Result<Study, Failure> {
    let settings: Vec<(f64, f64)> =
        STIFFNESS.iter().flat_map(|&k| RESOLUTIONS.iter().map(move |&n| (k, n))).collect();
    // The longest runs first, so that no thread is left waiting at the end.
    let jobs: Vec<Job> = settings
        .iter()
        .rev()
        .flat_map(|&(stiffness, resolution)| (1..=SEEDS).map(move |seed| Job { stiffness, resolution, seed }))
        .collect();
    let fallen = parallel::each(&jobs, Job::run)?;
    let ensembles: Vec<&[Fallen]> = fallen.chunks(SEEDS as usize).rev().collect();
    let run_outs = |ensemble: &[Fallen]| ensemble.iter().map(Fallen::run_out).collect::<Vec<f64>>();
    let reference = run_outs(ensembles[ensembles.len() - 1]);
    let (mean, band) = mean_and_error(&reference);
    let points = settings.iter().zip(&ensembles).map(|(&(stiffness, resolution), ensemble)| {
        let differences = run_outs(ensemble).into_iter().zip(&reference).map(|(a, b)| (a - b) / mean);
        let (error, band) = mean_and_error(&differences.collect::<Vec<_>>());
        Point {
            scheme: format!("k_n = {stiffness:.1e} N/m"),
            resolution,
            dt: ensemble[0].dt,
            error: error.abs(),
            band,
            seeds: ensemble.len(),
            seconds: median(ensemble.iter().map(|fallen| fallen.seconds).collect()),
            pareto: false,
        }
    });
    let mut points: Vec<Point> = points.collect();
    let cost = points.pop().map_or(f64::NAN, |point| point.seconds);
    let notes = vec![
        "the motion is chaotic: the error is that of an ensemble mean over seeds, and means little where it is \
         within its band (one standard error of the differences); no order is fitted"
            .to_owned(),
        format!(
            "reference: k_n = {:.1e} N/m with {} steps per contact, run-out {mean:.3} with standard error \
             {band:.3} over {SEEDS} seeds, {cost:.1} s a run; {GRAINS} disks, aspect ratio 0.8",
            STIFFNESS[STIFFNESS.len() - 1],
            RESOLUTIONS[RESOLUTIONS.len() - 1]
        ),
        "wall time of one run on one thread, settling included, median over seeds".to_owned(),
    ];
    let error = "error of the mean run-out over its reference [-]";
    Ok(Study { case: "column", error, resolution: CONTACT, points, orders: BTreeMap::new(), notes }
        .mark_front())
}
