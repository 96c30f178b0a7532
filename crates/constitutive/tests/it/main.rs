//! What holds for every law.

// Outside `#[test]` functions clippy does not see that this is a test.
#![allow(clippy::unwrap_used)]

mod energy;
mod property;
mod same_bits;
mod support;
