//! Tests of couplings as users see them.

// Integration tests are all test code: an `unwrap` there is a failure with a message.
#![allow(clippy::unwrap_used)]

mod bits;
mod forces;
mod refusals;
mod resolved;
mod resolved_flows;
mod resolved_open;
mod tank;

#[global_allocator]
static ALLOCATOR: granular_core::testing::CountingAllocator =
    granular_core::testing::CountingAllocator::new();
