//! Tests of the lattice Boltzmann solver.

// Outside `#[test]` functions clippy does not see that this is a test.
#![allow(clippy::unwrap_used)]

mod absorbing;
mod advice;
mod channel;
mod contract;
mod lattices;
mod limits;
mod open;
mod pairs;
mod probes;
mod shapes;
mod symmetry;

#[global_allocator]
static ALLOCATOR: granular_core::testing::CountingAllocator =
    granular_core::testing::CountingAllocator::new();
