//! What a work-precision study found.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// Resolution of grains.
pub(super) const CONTACT: &str = "steps per contact";

/// Error and cost at one resolution.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
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
    /// Whether no other point is both nearer and faster.
    pub pareto: bool,
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
    /// Marks the points that no other point beats.
    pub(super) fn mark_front(mut self) -> Self {
        let costs: Vec<(f64, f64)> = self.points.iter().map(|point| (point.seconds, point.error)).collect();
        for (point, &(seconds, error)) in self.points.iter_mut().zip(&costs) {
            let beaten = |&(s, e): &(f64, f64)| s <= seconds && e <= error && (s, e) != (seconds, error);
            point.pareto = !costs.iter().any(beaten);
        }
        self
    }

    /// The schemes in the order of the points.
    pub(super) fn schemes(&self) -> Vec<&str> {
        let mut schemes: Vec<&str> = Vec::new();
        for point in &self.points {
            if !schemes.contains(&point.scheme.as_str()) {
                schemes.push(&point.scheme);
            }
        }
        schemes
    }

    /// All points as CSV.
    pub(super) fn csv(&self) -> String {
        let mut text = "scheme,resolution,dt [s],error,band,seeds,seconds,pareto\n".to_owned();
        for p in &self.points {
            let numbers = [p.resolution, p.dt, p.error, p.band].map(|number| number.to_string()).join(",");
            text += &format!("{},{numbers},{},{},{}\n", p.scheme, p.seeds, p.seconds, p.pareto);
        }
        text
    }
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
            let Point { scheme, resolution, dt, error, band, seeds, seconds, pareto } = point;
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
        let point = |seconds, error| Point {
            scheme: "a".to_owned(),
            resolution: 1.0,
            dt: 1.0,
            error,
            band: 0.0,
            seeds: 1,
            seconds,
            pareto: false,
        };
        let points = vec![point(1.0, 0.1), point(2.0, 0.2), point(3.0, 0.01)];
        let study =
            Study { case: "c", error: "e", resolution: "r", points, orders: BTreeMap::new(), notes: vec![] };
        let front: Vec<bool> = study.mark_front().points.iter().map(|point| point.pareto).collect();
        assert_eq!(front, [true, false, true]);
    }
}
