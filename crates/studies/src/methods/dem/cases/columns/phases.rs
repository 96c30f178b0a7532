//! Phases of the spreading: the front gains speed, keeps it, and loses it \[Kumar2014, section 4.2.3\].

/// Durations of the phases, in the unit of the times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phases {
    /// Constant acceleration.
    pub(super) gains: f64,
    /// Constant speed.
    pub(super) keeps: f64,
    /// Constant deceleration.
    pub(super) loses: f64,
    /// Root of the mean square of what the run-out differs from these phases, over the final one.
    pub(super) misfit: f64,
}

/// Step of the durations that are tried, and how many of them.
const STEP: f64 = 0.1;
const TRIED: [usize; 3] = [25, 40, 40];

impl Phases {
    /// Share of the final run-out that is reached at a time.
    fn share(&self, time: f64) -> f64 {
        let speed = 1.0 / (0.5 * self.gains + self.keeps + 0.5 * self.loses);
        let left = self.gains + self.keeps + self.loses - time;
        if time < self.gains {
            0.5 * speed * time * time / self.gains
        } else if left > self.loses {
            speed * (time - 0.5 * self.gains)
        } else if left > 0.0 {
            1.0 - 0.5 * speed * left * left / self.loses
        } else {
            1.0
        }
    }

    /// The durations whose run-out is nearest by least squares to one over time, found to a tenth of the unit; each of the
    /// phases of change lasts at least that.
    pub(super) fn of(times: &[f64], run_outs: &[f64]) -> Option<Self> {
        let last = run_outs.last().copied().filter(|last| *last > 0.0)?;
        let shares: Vec<f64> = run_outs.iter().map(|run_out| run_out / last).collect();
        let mut best: Option<Self> = None;
        for gains in 1..=TRIED[0] {
            for keeps in 0..TRIED[1] {
                for loses in 1..=TRIED[2] {
                    let [gains, keeps, loses] = [gains, keeps, loses].map(|count| count as f64 * STEP);
                    let tried = Self { gains, keeps, loses, misfit: 0.0 };
                    let squares =
                        times.iter().zip(&shares).map(|(t, share)| (tried.share(*t) - share).powi(2));
                    let misfit = (squares.sum::<f64>() / times.len() as f64).sqrt();
                    if best.is_none_or(|best| misfit < best.misfit) {
                        best = Some(Self { misfit, ..tried });
                    }
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_found_again() {
        let made = Phases { gains: 0.8, keeps: 2.0, loses: 0.6, misfit: 0.0 };
        let times: Vec<f64> = (0..=120).map(|k| f64::from(k) * 0.05).collect();
        let run_outs: Vec<f64> = times.iter().map(|&t| 8.28 * made.share(t)).collect();
        let found = Phases::of(&times, &run_outs).unwrap();
        assert!(found.misfit < 1e-12, "{found:?}");
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(near(found.gains, 0.8) && near(found.keeps, 2.0) && near(found.loses, 0.6), "{found:?}");
    }

    #[test]
    fn a_share_joins_its_phases() {
        let phases = Phases { gains: 1.0, keeps: 1.0, loses: 2.0, misfit: 0.0 };
        // By hand: the speed is 1 / (1/2 + 1 + 1).
        assert_eq!([0.0, 1.0, 2.0, 4.0, 5.0].map(|t| phases.share(t)), [0.0, 0.2, 0.6, 1.0, 1.0]);
        assert!(Phases::of(&[0.0, 1.0], &[0.0, 0.0]).is_none());
    }
}
