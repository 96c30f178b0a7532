//! The clock of a simulation.

/// Simulated time. Inside a segment it is `start + k * dt`, not a running sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    pub(super) start: f64,
    pub(super) dt: f64,
    pub(super) steps_in_segment: u64,
    pub(super) step: u64,
}

impl Clock {
    /// Simulated time \[s\].
    pub fn time(&self) -> f64 {
        self.start + self.steps_in_segment as f64 * self.dt
    }

    /// Step of the present segment \[s\]; zero before the first.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Steps taken since the start of the run.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Time since the start of the present segment \[s\].
    pub fn time_in_segment(&self) -> f64 {
        self.steps_in_segment as f64 * self.dt
    }
}
