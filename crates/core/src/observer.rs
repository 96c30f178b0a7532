//! What watches a simulation: schedules, observers, and whether to go on.

use crate::simulation::Simulation;
use crate::snapshot::{Section, SnapshotError};
use std::fmt;
use std::time::{Duration, Instant};

/// When an observer looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// Every so many steps, counted over the whole run.
    Steps(u64),
    /// Every so many seconds of simulated time: at the first step at or after each multiple.
    Time(f64),
    /// Every so many seconds of the wall clock.
    Wall(Duration),
}

/// Whether the segment goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// End the segment here: a stop condition is met.
    Stop,
}

/// Why an observer failed.
#[derive(Debug)]
pub struct ObserverError {
    /// Which observer, and what it wrote to.
    pub place: String,
    /// What went wrong.
    pub reason: String,
}

impl fmt::Display for ObserverError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.reason)
    }
}

impl std::error::Error for ObserverError {}

/// Looks at a simulation on a schedule, after all solvers were told to
/// [`publish`](crate::Solver::publish). Observers cannot change the physics, and their order does
/// not matter.
pub trait Observer: Send {
    /// Looks.
    ///
    /// # Errors
    /// When what was seen cannot be written.
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError>;
    /// Called once at the end of the run.
    ///
    /// # Errors
    /// When what was seen cannot be written.
    fn finish(&mut self, simulation: &Simulation) -> Result<(), ObserverError> {
        let _ = simulation;
        Ok(())
    }
    /// Adds what must survive a restart.
    fn save(&self, to: &mut Section) {
        let _ = to;
    }
    /// Takes back what [`Observer::save`] added.
    ///
    /// # Errors
    /// When the section does not fit.
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let _ = from;
        Ok(())
    }
}

/// An observer with its schedule.
pub struct Scheduled {
    name: String,
    every: Every,
    next: u64,
    last_wall: Instant,
    observer: Box<dyn Observer>,
}

impl fmt::Debug for Scheduled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scheduled")
            .field("name", &self.name)
            .field("every", &self.every)
            .finish_non_exhaustive()
    }
}

impl Scheduled {
    /// An observer that looks at the start and then on its schedule. The name is unique in a run.
    pub fn new(name: impl Into<String>, every: Every, observer: Box<dyn Observer>) -> Self {
        Self { name: name.into(), every, next: 0, last_wall: Instant::now(), observer }
    }

    /// Name given at the start.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Steps to take before the observer may be due again; at least one.
    pub(crate) fn steps_until_due(&self, simulation: &Simulation) -> u64 {
        let clock = simulation.clock();
        match self.every {
            Every::Steps(n) => (self.next * n.max(1)).saturating_sub(clock.step()).max(1),
            Every::Time(interval) => {
                let wait = (self.next as f64 * interval - clock.time()) / clock.dt();
                if wait.is_finite() && wait > 1.0 { (wait.ceil() as u64).max(1) } else { 1 }
            }
            Every::Wall(_) => u64::MAX,
        }
    }

    /// The count of the next look if one is due now.
    pub(crate) fn due(&self, simulation: &Simulation) -> Option<u64> {
        let clock = simulation.clock();
        let due = match self.every {
            Every::Steps(n) => clock.step() / n.max(1) + 1,
            Every::Time(interval) => count_of_multiples(clock.time(), interval),
            Every::Wall(interval) => self.next + u64::from(self.last_wall.elapsed() >= interval),
        };
        (due > self.next).then_some(due)
    }

    /// Looks, after which it is due again at the look of this count.
    pub(crate) fn look(&mut self, next: u64, simulation: &Simulation) -> Result<Flow, ObserverError> {
        if let Every::Wall(_) = self.every {
            self.last_wall = Instant::now();
        }
        self.next = next;
        self.observer.observe(simulation)
    }

    /// Calls [`Observer::finish`].
    ///
    /// # Errors
    /// As the observer.
    pub fn finish(&mut self, simulation: &Simulation) -> Result<(), ObserverError> {
        self.observer.finish(simulation)
    }

    /// Saves the schedule and the observer.
    pub fn save(&self) -> Section {
        let mut section = Section::new(format!("observer {}", self.name));
        section.put_one("next", self.next);
        self.observer.save(&mut section);
        section
    }

    /// Restores the schedule and the observer.
    ///
    /// # Errors
    /// When the section does not fit.
    pub fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.next = from.one("next")?;
        self.observer.restore(from)
    }
}

/// How many multiples of `interval` from zero on lie at or before `time`; a time that misses a
/// multiple by round-off has reached it.
fn count_of_multiples(time: f64, interval: f64) -> u64 {
    (time / interval * (1.0 + 1e-12) + 1e-9).floor() as u64 + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_are_reached_in_spite_of_round_off() {
        assert_eq!(count_of_multiples(0.0, 0.01), 1);
        assert_eq!(count_of_multiples(0.1 + 0.2, 0.1), 4);
        assert_eq!(count_of_multiples(0.3 - 1e-17, 0.1), 4);
        assert_eq!(count_of_multiples(0.29, 0.1), 3);
    }
}
