//! Tests of the lattice Boltzmann solver.

// Outside `#[test]` functions clippy does not see that this is a test.
#![allow(clippy::unwrap_used)]

mod absorbing;
mod advice;
mod body_forces;
mod channel;
mod contract;
mod edges;
mod immersed;
mod lattices;
mod limits;
mod mass;
mod obstacles;
mod open;
mod pairs;
mod probes;
mod scales;
mod shapes;
mod symmetry;
mod translation;
mod walls;

#[global_allocator]
static ALLOCATOR: granular_core::testing::CountingAllocator =
    granular_core::testing::CountingAllocator::new();
