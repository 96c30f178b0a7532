//! What a work-precision study found.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// Resolution of grains.
pub(crate) const CONTACT: &str = "steps per contact";

/// Error and cost at one resolution.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// What is simulated, where a study compares several; runs of one are not compared with those of another.
    pub problem: String,
    /// Scheme or parameter that stays the same along a curve.
    pub scheme: String,
    /// How fine it is, in the unit of the study.
    pub resolution: f64,
    /// Step \[s\]; not a number where there is none.
    pub dt: f64,
    /// Error.
    pub error: f64,
    /// Standard error of the error over the seeds.
    pub band: f64,
    /// Number of seeds.
    pub seeds: usize,
    /// Wall time of one run \[s\].
    pub seconds: f64,
    /// Whether no other point of the same problem is both nearer and faster.
    pub pareto: bool,
}

impl Point {
    /// Of one run in which there is no chance.
    pub(crate) fn of_one_run(scheme: &str, resolution: f64, dt: f64, error: f64, seconds: f64) -> Self {
        let (problem, scheme) = (String::new(), scheme.to_owned());
        Self { problem, scheme, resolution, dt, error, band: 0.0, seeds: 1, seconds, pareto: false }
    }
}

/// A study of error against run time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// Name of the case.
    pub case: &'static str,
    /// What the error is.
    pub error: &'static str,
    /// What the resolution of a point counts.
    pub resolution: &'static str,
    /// All points.
    pub points: Vec<Point>,
    /// Fitted order of convergence of each scheme.
    pub orders: BTreeMap<String, f64>,
    /// What to know before the numbers are used.
    pub notes: Vec<String>,
}

impl Study {
    /// Marks the points that no other point of their problem beats.
    pub(crate) fn mark_front(mut self) -> Self {
        let beats = |a: &Point, b: &Point| {
            let costs = [a, b].map(|point| (point.seconds, point.error));
            a.problem == b.problem && a.seconds <= b.seconds && a.error <= b.error && costs[0] != costs[1]
        };
        let beaten = self.points.iter().map(|point| self.points.iter().any(|other| beats(other, point)));
        let beaten: Vec<bool> = beaten.collect();
        self.points.iter_mut().zip(beaten).for_each(|(point, beaten)| point.pareto = !beaten);
        self
    }

    /// The problems in the order of the points.
    pub(crate) fn problems(&self) -> Vec<&str> {
        in_order(self.points.iter().map(|point| point.problem.as_str()))
    }

    /// The schemes in the order of the points.
    pub(crate) fn schemes(&self) -> Vec<&str> {
        in_order(self.points.iter().map(|point| point.scheme.as_str()))
    }

    /// All points as CSV.
    pub(crate) fn csv(&self) -> String {
        let mut text = "problem,scheme,resolution,dt [s],error,band,seeds,seconds,pareto\n".to_owned();
        for p in &self.points {
            let numbers = [p.resolution, p.dt, p.error, p.band, p.seeds as f64, p.seconds];
            let fields = [p.problem.clone(), p.scheme.clone()].into_iter();
            let fields = fields.chain(numbers.map(|number| number.to_string()));
            text += &granular_io::csv_row(fields.chain([p.pareto.to_string()]));
        }
        text
    }
}

/// Each name once, where it came first.
fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut once = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}

impl fmt::Display for Study {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.case, self.error)?;
        writeln!(
            f,
            "  {:<30} {:>17} {:>11} {:>11} {:>11} {:>6} {:>11}  pareto",
            "scheme", self.resolution, "dt [s]", "error", "band", "seeds", "wall [s]"
        )?;
        for point in &self.points {
            let Point { scheme, resolution, dt, error, band, seeds, seconds, pareto, .. } = point;
            let mark = if *pareto { "*" } else { "" };
            // Not every study has steps.
            let dt = if dt.is_nan() { "-".to_owned() } else { format!("{dt:.3e}") };
            writeln!(
                f,
                "  {scheme:<30} {resolution:>17.2} {dt:>11} {error:>11.3e} {band:>11.1e} {seeds:>6} \
                 {seconds:>11.3e}  {mark}"
            )?;
        }
        for (scheme, order) in &self.orders {
            writeln!(f, "  fitted order, {scheme}: {order:.3}")?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "  note: {note}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let point = |problem: &str, seconds, error| Point {
            problem: String::from(problem),
            scheme: "a, soft".to_owned(),
            resolution: 1.0,
            dt: 1.0,
            error,
            band: 0.0,
            seeds: 1,
            seconds,
            pareto: false,
        };
        let mut points = vec![point("a", 1.0, 0.1), point("a", 2.0, 0.2), point("a", 3.0, 0.01)];
        points.push(point("b", 4.0, 0.3));
        let study =
            Study { case: "c", error: "e", resolution: "r", points, orders: BTreeMap::new(), notes: vec![] };
        let study = study.mark_front();
        let csv = study.csv();
        let columns = csv.lines().map(|line| line.replace("\"a, soft\"", "").split(',').count());
        assert_eq!(columns.collect::<Vec<_>>(), [9; 5], "a name with a comma is one column");
        let front: Vec<bool> = study.points.iter().map(|point| point.pareto).collect();
        assert_eq!(front, [true, false, true, true]);
    }
}
