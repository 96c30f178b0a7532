//! The loop between outputs.

use super::Simulation;
use super::decision::Decision;
use crate::observer::{Flow, ObserverError, Scheduled};
use crate::solver::{StepError, check_step};
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How a segment ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Its duration is over.
    Finished,
    /// An observer asked to stop.
    Stopped,
    /// The interrupt flag was raised.
    Interrupted,
}

/// Why a segment failed.
#[derive(Debug)]
#[non_exhaustive]
pub enum RunError {
    /// The solver could not go on.
    Step(StepError),
    /// An observer failed.
    Observer(ObserverError),
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.fmt(f),
            Self::Observer(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for RunError {}

impl From<StepError> for RunError {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl From<ObserverError> for RunError {
    fn from(error: ObserverError) -> Self {
        Self::Observer(error)
    }
}

/// Wall time between looks at the interrupt flag and at wall-clock schedules.
const ATTENTION: Duration = Duration::from_millis(50);

impl Simulation {
    /// Runs the present segment until it has lasted `duration` \[s\] (the first step at or after
    /// it), an observer stops it, or the interrupt flag is raised. Observers look before the
    /// first step, and then when they are due.
    ///
    /// # Errors
    /// When a solver or an observer fails.
    pub fn run(
        &mut self,
        duration: f64,
        observers: &mut [Scheduled],
        interrupt: &AtomicBool,
    ) -> Result<Ending, RunError> {
        check_step(self.clock.dt)?;
        let last = (duration / self.clock.dt * (1.0 - 1e-12)).ceil() as u64;
        let outcome = self.run_until(last, observers, interrupt);
        // Whoever looks or saves next sees the state as it is.
        self.graph.publish();
        outcome
    }

    /// Runs until the segment has `last` steps.
    fn run_until(
        &mut self,
        last: u64,
        observers: &mut [Scheduled],
        interrupt: &AtomicBool,
    ) -> Result<Ending, RunError> {
        let mut burst = 1_u64;
        let mut taken = Ok(());
        loop {
            let seen = taken.map_err(RunError::from).and_then(|()| Ok(self.look(observers)?));
            let due = observers.iter().map(|observer| observer.steps_until_due(self)).min();
            let steps = due.unwrap_or(u64::MAX).min(burst);
            let left = last.saturating_sub(self.clock.steps_in_segment);
            match Decision::of(&seen, steps, left, interrupt.load(Ordering::Relaxed)) {
                Decision::GoOn { steps } => {
                    let begun = Instant::now();
                    taken = self.take(steps);
                    burst = next_burst(burst, steps, begun.elapsed());
                }
                Decision::End(ending) => return seen.map(|_| ending),
                Decision::Fail => return seen.map(|_| Ending::Stopped),
            }
        }
    }

    /// Lets all observers look that are due, at what all solvers have brought up to date.
    fn look(&mut self, observers: &mut [Scheduled]) -> Result<Flow, ObserverError> {
        let mut flow = Flow::Continue;
        let mut is_published = false;
        for observer in observers {
            let Some(next) = observer.due(self) else { continue };
            if !is_published {
                self.graph.publish();
                is_published = true;
            }
            if observer.look(next, self)? == Flow::Stop {
                flow = Flow::Stop;
            }
        }
        Ok(flow)
    }
}

/// Lets bursts of steps grow while they are short against [`ATTENTION`].
fn next_burst(burst: u64, taken: u64, wall: Duration) -> u64 {
    if wall > ATTENTION {
        (burst / 2).max(1)
    } else if taken == burst && wall < ATTENTION / 2 {
        burst.saturating_mul(2)
    } else {
        burst
    }
}
