//! Restitution of a normal impact: error against step and run time.

use crate::bench::study::{CONTACT, Point, Study};
use crate::methods::dem::cases::impact::Impact;
use crate::methods::dem::cases::restitution::{PHASE_STEPS, errors, gaps};
use granular_core::{Solver, StepError};
use granular_dem::Tension;
use granular_driver::failure::Failure;
use granular_driver::statistics::{mean_and_error, median, order, root_mean_square};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Restitution asked for, as in table 4.2 of \[Kumar2014\].
const RESTITUTION: f64 = 0.75;
/// Random gaps that an error is taken over, and that are timed.
const GAPS: usize = 256;
/// Rounds that the wall time is the median of.
pub(super) const ROUNDS: usize = 15;
/// A round lasts at least this long.
const ROUND: Duration = Duration::from_millis(20);

pub(super) fn study() -> Result<Study, Failure> {
    let mut points = Vec::new();
    let mut orders = BTreeMap::new();
    for (tension, scheme) in [(Tension::Cut, "tension cut"), (Tension::Kept, "tension kept")] {
        let mut line = Vec::new();
        for phase_step in PHASE_STEPS {
            let impact = Impact { restitution: RESTITUTION, tension, phase_step };
            let point = measure(&impact, scheme)?;
            line.push((point.dt, point.error));
            points.push(point);
        }
        orders.insert(scheme.to_owned(), order(&line));
    }
    let notes = vec![
        format!(
            "e = {RESTITUTION}; root mean square over random gaps before the impact; the band is its standard error"
        ),
        "no step divides the contact time; orders are least squares in the logarithms of step and error"
            .to_owned(),
        format!("wall time of the steps of one impact of two disks on one thread, median of {ROUNDS} rounds"),
    ];
    let error = "error of the restitution [-]";
    Ok(Study { case: "restitution", error, resolution: CONTACT, points, orders, notes }.mark_front())
}

/// An impact whose restitution is measured and timed.
pub(super) trait Trial {
    /// Step \[s\].
    fn dt(&self) -> f64;
    /// Steps in a contact.
    fn resolution(&self) -> f64;
    /// Errors over so many random gaps.
    fn errors(&self, count: usize) -> Result<Vec<f64>, StepError>;
    /// The simulation from a gap of so many steps, and how many it takes.
    fn begin(&self, gap: f64) -> (Box<dyn Solver>, u64);
}

impl Trial for Impact {
    fn dt(&self) -> f64 {
        self.dt()
    }

    fn resolution(&self) -> f64 {
        self.contact_time() / self.dt()
    }

    fn errors(&self, count: usize) -> Result<Vec<f64>, StepError> {
        errors(*self, count)
    }

    fn begin(&self, gap: f64) -> (Box<dyn Solver>, u64) {
        (Box::new(self.disks(gap)), self.steps(gap))
    }
}

pub(super) fn measure(impact: &dyn Trial, scheme: &str) -> Result<Point, Failure> {
    let errors = impact.errors(GAPS)?;
    let error = root_mean_square(&errors);
    let squares: Vec<f64> = errors.iter().map(|error| error * error).collect();
    Ok(Point {
        problem: String::new(),
        scheme: scheme.to_owned(),
        resolution: impact.resolution(),
        dt: impact.dt(),
        error,
        // From the standard error of the mean square.
        band: 0.5 * mean_and_error(&squares).1 / error,
        seeds: errors.len(),
        seconds: seconds(impact)?,
        pareto: false,
    })
}

/// Wall time of the steps of one impact. Set-up is not counted.
fn seconds(impact: &dyn Trial) -> Result<f64, StepError> {
    let gaps = gaps(64);
    let mut rounds = Vec::new();
    for _ in 0..ROUNDS {
        let (mut spent, mut impacts) = (Duration::ZERO, 0);
        while spent < ROUND {
            let mut pairs: Vec<_> = gaps.iter().map(|&gap| impact.begin(gap)).collect();
            let begun = Instant::now();
            for (grains, steps) in &mut pairs {
                grains.advance(impact.dt(), *steps)?;
            }
            spent += begun.elapsed();
            impacts += pairs.len();
        }
        rounds.push(spent.as_secs_f64() / impacts as f64);
    }
    Ok(median(rounds))
}
