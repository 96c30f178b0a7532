//! The solver of the toy: explicit steps of five points.

use granular_core::solver::check_step;
use granular_core::{
    FieldRef, FieldSink, Limits, Location, Memory, Section, Shown, ShownAs, SnapshotError, Solver, StepError,
    StepLimit,
};
use std::f64::consts::TAU;

/// A temperature per cell.
pub(super) struct Heat {
    spacing: f64,
    cells: usize,
    diffusivity: f64,
    temperature: Vec<f64>,
    before: Vec<f64>,
}

impl Heat {
    pub(super) fn new(size: f64, cells: usize, diffusivity: f64) -> Self {
        let wave = |index: usize| (TAU * ((index % cells) as f64 + 0.5) / cells as f64).sin();
        let temperature: Vec<f64> = (0..cells * cells).map(wave).collect();
        Self { spacing: size / cells as f64, cells, diffusivity, before: temperature.clone(), temperature }
    }

    pub(super) fn largest(&self) -> f64 {
        self.temperature.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    fn step_once(&mut self, dt: f64) {
        std::mem::swap(&mut self.temperature, &mut self.before);
        let (n, old) = (self.cells, &self.before);
        let factor = self.diffusivity * dt / (self.spacing * self.spacing);
        for (index, new) in self.temperature.iter_mut().enumerate() {
            let (x, y) = (index % n, index / n);
            let at = |x: usize, y: usize| old[(y % n) * n + x % n];
            let around = at(x + 1, y) + at(x + n - 1, y) + at(x, y + 1) + at(x, y + n - 1);
            *new = old[index] + factor * (around - 4.0 * old[index]);
        }
    }
}

impl Solver for Heat {
    fn name(&self) -> &'static str {
        "heat"
    }

    fn size(&self) -> (usize, &'static str) {
        (self.cells * self.cells, "cell")
    }

    fn limits(&self, report: &mut Limits) {
        let dt = 0.25 * self.spacing * self.spacing / self.diffusivity;
        let why = "heat crosses a cell".to_owned();
        report.steps.push(StepLimit::at_most("diffusion", dt, why));
    }

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        check_step(dt)?;
        (0..steps).for_each(|_| self.step_once(dt));
        Ok(())
    }

    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        let (spacing, cells) = ([self.spacing; 3], [self.cells, self.cells, 1]);
        vec![("cells", Location::Grid { origin: [0.0; 3], spacing, cells })]
    }

    fn shown(&self) -> Vec<Shown> {
        vec![
            Shown::new("largest_temperature", "K", "largest temperature of any cell", ShownAs::Number),
            Shown::new("temperature", "K", "temperature", ShownAs::Field),
        ]
    }

    fn show(&self, sink: &mut dyn FieldSink) {
        if sink.wants("largest_temperature") {
            sink.number("largest_temperature", "K", self.largest());
        }
        if sink.wants("temperature") {
            sink.field("temperature", "K", FieldRef::Scalar(&self.temperature));
        }
    }

    fn save(&self, to: &mut Section) {
        to.put("temperature", &self.temperature);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.temperature = from.array_of("temperature", self.cells * self.cells)?;
        Ok(())
    }

    fn memory(&self) -> Memory {
        let bytes = 16 * self.temperature.len();
        Memory { bytes, bytes_per_item: 16, left_out: Vec::new() }
    }
}
