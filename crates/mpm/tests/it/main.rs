//! Tests of the material point method as a whole.

// Outside `#[test]` functions clippy does not see that this is a test.
#![allow(clippy::unwrap_used)]

use granular_core::testing::CountingAllocator;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator::new();

mod balance;
mod boundaries;
mod closed_forms;
mod contacts;
mod contract;
mod pushes;
mod robust;
mod sample;
