//! A toy whose grains change places in memory at every step.

use crate::D2;
use crate::exchange::{Accepts, Provides};
use crate::field::{FieldRef, FieldSink, Location, Shown};
use crate::quantity::{GrainMotion, Grains, HydroLoad, Load, LoadsMut};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, Memory, Solver, StepError};
use glam::DVec2;

/// What may be wrong with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flaw {
    None,
    LeavesLoadsBehind,
    IgnoresLoads,
    AddsUpLoads,
}

/// Grains of unit mass that only loads move.
pub(super) struct Sorter {
    flaw: Flaw,
    id: Vec<u32>,
    position: Vec<DVec2>,
    velocity: Vec<DVec2>,
    spin: Vec<f64>,
    radius: Vec<f64>,
    load: Vec<Load<D2>>,
}

impl Sorter {
    pub(super) fn new(flaw: Flaw) -> Self {
        Self {
            flaw,
            id: (0..5).collect(),
            position: (0..5).map(|k| DVec2::new(f64::from(k), 0.0)).collect(),
            velocity: vec![DVec2::Y; 5],
            spin: vec![0.0; 5],
            radius: vec![0.1; 5],
            load: Vec::new(),
        }
    }

    /// Bytes held for loads.
    pub(super) fn room(&self) -> usize {
        self.load.capacity()
    }
}

impl Provides<GrainMotion<D2>> for Sorter {
    fn view(&self) -> Grains<'_, D2> {
        Grains::new(&self.position, &self.velocity, &self.spin, &self.radius, &self.id)
    }
}

impl Accepts<HydroLoad<D2>> for Sorter {
    fn enable(&mut self) {
        self.load.resize(self.id.len(), Load::ZERO);
    }
    fn view_mut(&mut self) -> LoadsMut<'_, D2> {
        LoadsMut::new(&self.id, &mut self.load)
    }
}

impl Solver for Sorter {
    fn name(&self) -> &'static str {
        "sorter"
    }
    fn size(&self) -> (usize, &'static str) {
        (self.id.len(), "grain")
    }
    fn limits(&self, _: &mut Limits) {}
    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        for _ in 0..steps {
            for (k, load) in self.load.iter().enumerate().filter(|_| self.flaw != Flaw::IgnoresLoads) {
                self.velocity[k] += load.force * dt;
                self.spin[k] += load.torque * dt;
                self.position[k] += self.velocity[k] * dt;
            }
            self.id.rotate_left(1);
            self.position.rotate_left(1);
            self.velocity.rotate_left(1);
            self.spin.rotate_left(1);
            if self.flaw != Flaw::LeavesLoadsBehind && !self.load.is_empty() {
                self.load.rotate_left(1);
            }
        }
        Ok(())
    }
    fn clear_inputs(&mut self) {
        if self.flaw != Flaw::AddsUpLoads {
            self.load.fill(Load::ZERO);
        }
    }
    fn location(&self) -> Location<'_> {
        Location::Points(FieldRef::Vector2(&self.position))
    }
    fn shown(&self) -> Vec<Shown> {
        Vec::new()
    }
    fn show(&self, _: &mut dyn FieldSink) {}
    fn save(&self, to: &mut Section) {
        to.put("id", &self.id);
        to.put("position", &self.position);
        to.put("velocity", &self.velocity);
        to.put("spin", &self.spin);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.id = from.array("id")?;
        self.position = from.array("position")?;
        self.velocity = from.array("velocity")?;
        self.spin = from.array("spin")?;
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}
