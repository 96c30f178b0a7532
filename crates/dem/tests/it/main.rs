//! Integration tests of the discrete element method.

// Outside `#[test]` functions clippy does not see that this is a test.
#![allow(clippy::unwrap_used)]

mod coarse;
mod coarse_cell;
mod cohesion;
mod conservation;
mod contract;
mod energy;
mod extremes;
mod frames;
mod hertz;
mod impact;
mod incline;
mod inlets;
mod law_page;
mod lists;
mod loads;
mod memory;
mod moving_walls;
mod oblique;
mod order;
mod pairs;
mod periodic;
mod push;
mod restart;
mod sample;
mod shaking;
mod single;
mod stability;
mod surfaces;

mod twisting;
mod wall_numbers;
mod wide;

#[global_allocator]
static ALLOCATOR: granular_core::testing::CountingAllocator =
    granular_core::testing::CountingAllocator::new();
