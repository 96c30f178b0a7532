//! Simulated time: the start of a run of equal steps, and how many were taken since.
//!
//! Never a running sum, so that it has the same bits however a run is split into calls.

use crate::grains::check_finite;
use granular_core::{Section, SnapshotError};

/// Time since the start of the simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Clock {
    /// Time at which steps became `dt` \[s\].
    start: f64,
    dt: f64,
    /// Steps of `dt` since.
    steps: u64,
}

impl Clock {
    pub(crate) fn time(self) -> f64 {
        self.start + self.steps as f64 * self.dt
    }

    /// From here on, steps are `dt` \[s\].
    pub(crate) fn run_at(&mut self, dt: f64) {
        if dt != self.dt {
            *self = Self { start: self.time(), dt, steps: 0 };
        }
    }

    pub(crate) fn step(&mut self) {
        self.steps += 1;
    }

    pub(crate) fn save(self, to: &mut Section) {
        to.put("clock", &[self.start, self.dt]);
        to.put_one("steps on the clock", self.steps);
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let times: Vec<f64> = from.array_of("clock", 2)?;
        check_finite("clock", times.iter().all(|time| time.is_finite()))?;
        *self = Self { start: times[0], dt: times[1], steps: from.one("steps on the clock")? };
        Ok(())
    }
}
