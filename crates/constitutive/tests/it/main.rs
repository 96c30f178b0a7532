//! What holds for every law.

// Outside `#[test]` functions clippy does not see that this is a test.
#![allow(clippy::unwrap_used)]

mod energy;
#[cfg(feature = "serde")]
mod laws_page;
mod property;
mod same_bits;
mod support;
