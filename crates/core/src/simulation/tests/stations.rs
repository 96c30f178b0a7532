//! Toys that keep a list of all calls.

use crate::exchange::{Coupling, CouplingError};
use crate::field::{FieldRef, FieldSink, Location, Shown};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, Memory, Solver, StepError, StepLimit};
use std::sync::{Arc, Mutex};

/// All calls, in order.
#[derive(Clone, Default)]
pub(super) struct Log(Arc<Mutex<Vec<String>>>);

impl Log {
    pub(super) fn add(&self, entry: impl Into<String>) {
        self.0.lock().expect("no toy panics").push(entry.into());
    }

    /// The calls since the last time.
    pub(super) fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.0.lock().expect("no toy panics"))
    }
}

/// Follows its input. What others see of it is what it last published.
pub(super) struct Station {
    pub(super) name: &'static str,
    pub(super) log: Log,
    pub(super) limit: f64,
    pub(super) value: f64,
    pub(super) input: f64,
    pub(super) shown: f64,
    /// Bits of the input at each step.
    pub(super) inputs: Vec<u64>,
}

impl Station {
    pub(super) fn new(name: &'static str, limit: f64, log: &Log) -> Self {
        let value = name.len() as f64 + 1.0 / f64::from(name.as_bytes()[0]);
        Self { name, log: log.clone(), limit, value, input: 0.0, shown: 0.0, inputs: Vec::new() }
    }
}

impl Solver for Station {
    fn name(&self) -> &'static str {
        self.name
    }
    fn size(&self) -> (usize, &'static str) {
        (1, "value")
    }
    fn limits(&self, report: &mut Limits) {
        report.steps.push(StepLimit::at_most("pace", self.limit, "of the test"));
    }
    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        self.log.add(format!("{} steps {steps} x {dt}", self.name));
        for _ in 0..steps {
            self.value += dt * (self.input - self.value);
            self.inputs.push(self.input.to_bits());
        }
        Ok(())
    }
    fn publish(&mut self) {
        self.shown = self.value;
    }
    fn clear_inputs(&mut self) {
        self.log.add(format!("{} clears", self.name));
        self.input = 0.0;
    }
    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("station", Location::Points(FieldRef::Vector2(&[])))]
    }
    fn shown(&self) -> Vec<Shown> {
        Vec::new()
    }
    fn show(&self, _: &mut dyn FieldSink) {}
    fn save(&self, to: &mut Section) {
        to.put_one("value", self.value);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.value = from.one("value")?;
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}

/// Adds what each end shows to the input of the other.
pub(super) struct Line {
    pub(super) name: &'static str,
    pub(super) log: Log,
    /// Whether it acts within; it then adds one for each sub-step before.
    pub(super) within: bool,
    pub(super) long_step: f64,
}

impl Line {
    pub(super) fn new(name: &'static str, log: &Log) -> Self {
        Self { name, log: log.clone(), within: false, long_step: 0.0 }
    }
}

impl Coupling<Station, Station> for Line {
    fn name(&self) -> &'static str {
        self.name
    }
    fn attach(&mut self, _: &mut Station, _: &mut Station) -> Result<(), CouplingError> {
        Ok(())
    }
    fn begin(&mut self, long_step: f64) {
        self.long_step = long_step;
    }
    fn forward(&mut self, fast: &Station, slow: &mut Station) -> Result<(), StepError> {
        self.log.add(format!("{} forward, step {}", self.name, self.long_step));
        slow.input += fast.shown;
        Ok(())
    }
    fn backward(&mut self, slow: &Station, fast: &mut Station) -> Result<(), StepError> {
        self.log.add(format!("{} backward", self.name));
        fast.input += slow.shown;
        Ok(())
    }
    fn acts_within(&self) -> bool {
        self.within
    }
    fn during(&mut self, k: u64, n: u64, _: &Station, fast: &mut Station) -> Result<(), StepError> {
        self.log.add(format!("{} during {k} of {n}", self.name));
        fast.input += k as f64;
        Ok(())
    }
}
