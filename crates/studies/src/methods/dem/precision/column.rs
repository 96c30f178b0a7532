//! Run-out of a column: error of an ensemble mean against stiffness, step and run time, in the plane and in space.

use crate::bench::study::{CONTACT, Point, Study};
use crate::methods::dem::cases::collapse::{Collapse, Fallen};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_driver::statistics::{mean_and_error, median};
use std::collections::BTreeMap;

const GRAINS: usize = 400;
const SEEDS: u64 = 10;
/// Stiffness of the walls over that of the grains, as in table 4.2 of \[Kumar2014\].
const WALLS: f64 = 2.5;
/// Steps in the shortest contact time; the last is the reference.
const RESOLUTIONS: [f64; 3] = [10.0, 25.0, 50.0];

/// Columns of disks or of spheres.
struct Columns {
    grains: &'static str,
    /// Normal stiffness of the grains \[N/m\]; the last is the reference. Spheres of the mean diameter with a thousandth have
    /// about the contact time of disks.
    stiffness: [f64; 4],
    /// What makes the template a column in space.
    edits: &'static [&'static str],
}

const DISKS: Columns = Columns { grains: "disks", stiffness: [1e5, 4e5, 1.6e6, 6.4e6], edits: &[] };
/// Half as deep as wide between smooth sides, which do not carry the flow; settled from a loose lattice.
const SPHERES: Columns = Columns {
    grains: "spheres",
    stiffness: [1e2, 4e2, 1.6e3, 6.4e3],
    edits: &[
        "dimension=Space",
        "gravity=[0.0, 0.0, -9.81]",
        "materials.side=(restitution: 0.75, friction: 0)",
        "sample.packing=Loose",
        "sample.depth_ratio=0.5",
        "walls=[Floor(material: \"wall\"), Left(material: \"wall\"), Gate(material: \"wall\", opens: \"collapse\"), \
         Sides(material: \"side\")]",
    ],
};

/// One run of the study.
struct Job<'a> {
    columns: &'a Columns,
    stiffness: f64,
    resolution: f64,
    seed: u64,
}

impl Job<'_> {
    fn run(&self) -> Result<Fallen, Failure> {
        let Self { columns, stiffness, resolution, seed } = self;
        let collapse = Collapse::of(GRAINS).seed(*seed);
        let mut collapse =
            columns.edits.iter().fold(collapse, |collapse, edit| collapse.set((*edit).to_owned()));
        let materials = [("glass", 1.0), ("wall", WALLS), ("side", WALLS)];
        let known = if columns.edits.is_empty() { &materials[..2] } else { &materials[..] };
        for (name, factor) in known {
            collapse = collapse.set(format!("materials.{name}.normal_stiffness={:e}", factor * stiffness));
        }
        collapse.set(format!("solvers.grains.0.steps_per_contact={resolution}")).run()
    }
}

pub(super) fn study() -> Result<Study, Failure> {
    let mut points = Vec::new();
    let mut notes = vec![
        "the motion is chaotic: the error is that of an ensemble mean over seeds, and means little where it is \
         within its band (one standard error of the differences); no order is fitted"
            .to_owned(),
    ];
    for columns in [&DISKS, &SPHERES] {
        let (more, note) = ensembles(columns)?;
        points.extend(more);
        notes.push(note);
    }
    notes.push("wall time of one run on one thread, settling included, median over seeds".to_owned());
    let error = "error of the mean run-out over its reference [-]";
    Ok(Study { case: "column", error, resolution: CONTACT, points, orders: BTreeMap::new(), notes }
        .mark_front())
}

/// The points of all settings but the reference, and what that is.
fn ensembles(columns: &Columns) -> Result<(Vec<Point>, String), Failure> {
    let settings: Vec<(f64, f64)> =
        columns.stiffness.iter().flat_map(|&k| RESOLUTIONS.iter().map(move |&n| (k, n))).collect();
    // The longest runs first, so that no thread is left waiting at the end.
    let jobs: Vec<Job<'_>> = settings
        .iter()
        .rev()
        .flat_map(|&(stiffness, resolution)| {
            (1..=SEEDS).map(move |seed| Job { columns, stiffness, resolution, seed })
        })
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
            problem: columns.grains.to_owned(),
            scheme: format!("{}, k_n = {stiffness:.1e} N/m", columns.grains),
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
    let shape = if columns.edits.is_empty() { "" } else { ", half as deep as wide between smooth sides" };
    let note = format!(
        "reference of {grains}: k_n = {:.1e} N/m with {} steps per contact, run-out {mean:.3} with standard error \
         {band:.3} over {SEEDS} seeds, {cost:.1} s a run; {GRAINS} {grains}, aspect ratio 0.8{shape}",
        columns.stiffness[columns.stiffness.len() - 1],
        RESOLUTIONS[RESOLUTIONS.len() - 1],
        grains = columns.grains,
    );
    Ok((points, note))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both columns fall as far as columns of this shape do, and say with what step.
    #[test]
    fn columns_of_both_dimensions_run_out() {
        for (columns, shallow) in [(&DISKS, 1e5), (&SPHERES, 1e2)] {
            let job = Job { columns, stiffness: shallow, resolution: 10.0, seed: 1 };
            let fallen = job.run().unwrap();
            assert!((0.5..4.0).contains(&fallen.run_out()), "{}: {fallen:?}", columns.grains);
            assert!(fallen.aspect_ratio() > 0.5 && fallen.dt > 1e-6, "{fallen:?}");
        }
    }
}
