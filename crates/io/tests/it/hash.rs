//! The hash of a state needs no copy of it.

use granular_core::glam::DVec2;
use granular_core::testing::CountingAllocator;
use granular_core::{
    Coupling, CouplingError, FieldRef, FieldSink, Limits, Location, Memory, Section, Shown, Simulation,
    SnapshotError, Solver, StepError,
};
use granular_io::{simulation_hash, state_hash};

/// A large array, and one that is worked out when it is saved.
struct Cells(Vec<f64>);

impl Solver for Cells {
    fn name(&self) -> &'static str {
        "cells"
    }
    fn size(&self) -> (usize, &'static str) {
        (1, "cell")
    }
    fn limits(&self, _: &mut Limits) {}
    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        self.0.iter_mut().for_each(|value| *value += dt * steps as f64);
        Ok(())
    }
    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("cells", Location::Points(FieldRef::Vector2(&[DVec2::ZERO])))]
    }
    fn shown(&self) -> Vec<Shown> {
        Vec::new()
    }
    fn show(&self, _: &mut dyn FieldSink) {}
    fn save(&self, to: &mut Section) {
        to.put_text("kind", "cells");
        to.put("values", &self.0);
        to.put_each("squares", self.0.len(), |put| self.0.iter().for_each(|value| put(value * value)));
        to.put::<u32>("none", &[]);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.0 = from.array("values")?;
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}

struct Beside;

impl Coupling<Cells, Cells> for Beside {
    fn name(&self) -> &'static str {
        "beside"
    }
    fn attach(&mut self, _: &mut Cells, _: &mut Cells) -> Result<(), CouplingError> {
        Ok(())
    }
    fn forward(&mut self, _: &Cells, _: &mut Cells) -> Result<(), StepError> {
        Ok(())
    }
    fn save(&self, to: &mut Section) {
        to.put_one("state of the law", 3_u64);
    }
}

const CELLS: usize = 200_000;

#[test]
fn the_hash_is_that_of_the_sections_without_a_copy_of_them() {
    let cells = |count: usize| Cells((0..count).map(|k| k as f64).collect());
    let mut simulation = Simulation::named("first", Box::new(cells(CELLS)));
    let alone = simulation_hash(&simulation);
    assert_eq!(alone, state_hash(&simulation.save()));
    let first = simulation.find::<Cells>("first").unwrap();
    let second = simulation.add("second", cells(1025)).unwrap();
    simulation.couple(first, second, Beside).unwrap();
    simulation.begin_segment(0.1).unwrap();
    simulation.advance(3).unwrap();
    let hash = simulation_hash(&simulation);
    assert_eq!(hash, state_hash(&simulation.save()));
    assert_ne!(hash, alone);
    let before = CountingAllocator::bytes_on_this_thread();
    simulation_hash(&simulation);
    let asked = CountingAllocator::bytes_on_this_thread() - before;
    assert!(asked < (8 * CELLS / 10) as u64, "{asked} bytes for {CELLS} cells");
    let before = CountingAllocator::bytes_on_this_thread();
    drop(simulation.save());
    assert!(CountingAllocator::bytes_on_this_thread() - before > 16 * CELLS as u64, "nothing is counted");
}
