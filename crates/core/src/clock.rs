//! The clock of what moves or comes and goes inside a solver: the start of a run of equal steps, and how many were taken
//! since.
//!
//! Never a running sum, so that it has the same bits however a run is split into calls.

use crate::snapshot::{Section, SnapshotError, check_entry};

/// Time since the start of the simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepClock {
    /// Time at which steps became `dt` \[s\].
    start: f64,
    dt: f64,
    /// Steps of `dt` since.
    steps: u64,
}

impl StepClock {
    /// Time since the start \[s\].
    pub fn time(self) -> f64 {
        self.start + self.steps as f64 * self.dt
    }

    /// From here on, steps are `dt` \[s\].
    pub fn run_at(&mut self, dt: f64) {
        if dt != self.dt {
            *self = Self { start: self.time(), dt, steps: 0 };
        }
    }

    /// One more step was taken.
    pub fn step(&mut self) {
        self.steps += 1;
    }

    /// Adds the clock to a section.
    pub fn save(self, to: &mut Section) {
        to.put("clock", &[self.start, self.dt]);
        to.put_one("steps on the clock", self.steps);
    }

    /// Takes the clock from a section.
    ///
    /// # Errors
    /// When an entry is missing, or a time is not finite.
    pub fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let times: Vec<f64> = from.array_of("clock", 2)?;
        check_entry("clock", times.iter().all(|time| time.is_finite()))?;
        *self = Self { start: times[0], dt: times[1], steps: from.one("steps on the clock")? };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::StepClock;

    #[test]
    fn time_does_not_depend_on_how_steps_are_split_and_keeps_what_went_before() {
        let (mut clock, dt) = (StepClock::default(), 0.1);
        clock.run_at(dt);
        for _ in 0..10 {
            // Said again before each call, as a solver does.
            clock.run_at(dt);
            clock.step();
        }
        assert_eq!(clock.time(), 10.0 * dt);
        clock.run_at(0.25);
        clock.step();
        assert_eq!(clock.time(), 10.0 * dt + 0.25);
    }
}
