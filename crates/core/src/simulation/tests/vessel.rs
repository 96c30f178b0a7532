//! Toys: a tank that leaks into a bucket.

use crate::exchange::{Accepts, Coupling, CouplingError, Provides, Quantity};
use crate::field::{FieldRef, FieldSink, Location, Shown, ShownAs};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, Memory, Solver, StepError, StepLimit, StepRule};

/// Water over the brim \[m\].
pub(super) struct Level;

impl Quantity for Level {
    const NAME: &'static str = "level";
    const UNIT: &'static str = "m";
    type View<'a> = f64;
    type ViewMut<'a> = &'a mut f64;
}

/// Decays towards its input; keeps the steps it took.
pub(super) struct Vessel {
    pub(super) level: f64,
    pub(super) input: f64,
    pub(super) limit: Option<(f64, StepRule)>,
    pub(super) taken: Vec<f64>,
    pub(super) calls: usize,
}

impl Vessel {
    pub(super) fn new(level: f64, limit: Option<(f64, StepRule)>) -> Self {
        Self { level, input: 0.0, limit, taken: Vec::new(), calls: 0 }
    }
}

impl Provides<Level> for Vessel {
    fn view(&self) -> f64 {
        self.level
    }
}

impl Accepts<Level> for Vessel {
    fn view_mut(&mut self) -> &mut f64 {
        &mut self.input
    }
}

impl Solver for Vessel {
    fn name(&self) -> &'static str {
        "vessel"
    }
    fn size(&self) -> (usize, &'static str) {
        (1, "vessel")
    }
    fn limits(&self, report: &mut Limits) {
        if let Some((dt, rule)) = self.limit {
            report.steps.push(StepLimit { rule, ..StepLimit::at_most("leak", dt, "of the test") });
        }
    }
    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        self.calls += 1;
        for _ in 0..steps {
            self.level += dt * (self.input - self.level);
            self.taken.push(dt);
        }
        Ok(())
    }
    fn clear_inputs(&mut self) {
        self.input = 0.0;
    }
    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("vessel", Location::Points(crate::field::FieldRef::Vector2(&[])))]
    }
    fn shown(&self) -> Vec<Shown> {
        Vec::new()
    }
    fn show(&self, _: &mut dyn FieldSink) {}
    fn save(&self, to: &mut Section) {
        to.put("level and input", &[self.level, self.input]);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let values: Vec<f64> = from.array_of("level and input", 2)?;
        (self.level, self.input) = (values[0], values[1]);
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}

/// Adds the level of each to the input of the other; keeps how much went forward.
#[derive(Default)]
pub(super) struct Pipe {
    moved: f64,
}

impl<A: Accepts<Level> + Provides<Level>, B: Accepts<Level> + Provides<Level>> Coupling<A, B> for Pipe {
    fn name(&self) -> &'static str {
        "pipe"
    }
    fn attach(&mut self, _: &mut A, fast: &mut B) -> Result<(), CouplingError> {
        let below_brim = fast.view() < 100.0;
        below_brim.then_some(()).ok_or_else(|| CouplingError::new("pipe", "the vessel is full"))
    }
    fn forward(&mut self, fast: &B, slow: &mut A) -> Result<(), StepError> {
        *slow.view_mut() += fast.view();
        self.moved += fast.view();
        Ok(())
    }
    fn backward(&mut self, slow: &A, fast: &mut B) -> Result<(), StepError> {
        *fast.view_mut() += slow.view();
        Ok(())
    }
    fn limits(&self, _: &A, _: &B, report: &mut Limits) {
        report.steps.push(StepLimit::at_most("pipe", 0.5, "of the pipe"));
    }
    fn shown(&self) -> Vec<Shown> {
        vec![
            Shown::new("moved", "m", "sum of what went forward", ShownAs::Number),
            Shown::new(
                "difference",
                "m",
                "level of the fast vessel over that of the slow one",
                ShownAs::Field,
            ),
        ]
    }
    fn show(&self, slow: &A, fast: &B, sink: &mut dyn FieldSink) {
        if sink.wants("moved") {
            sink.number("moved", "m", self.moved);
        }
        if sink.wants("difference") {
            sink.field("difference", "m", FieldRef::Scalar(&[fast.view() - slow.view()]));
        }
    }
    fn save(&self, to: &mut Section) {
        to.put_one("moved", self.moved);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.moved = from.one("moved")?;
        Ok(())
    }
}
