//! Whether the numbers are right, how fast they come, and where they end: validation, stability, precision and speed.
//!
//! [`validate`] compares with known answers, [`validate::stability`] drives solvers to their limits from both sides,
//! [`bench`](mod@bench) measures error against run time and throughput. What is run belongs to methods: [`METHODS`] lists them,
//! one folder and one line each.

// What methods share is not all used where some of them are off.
#![cfg_attr(not(all(feature = "dem", feature = "lbm")), allow(dead_code))]

pub mod bench;
mod methods;
pub mod validate;

pub use methods::{METHODS, Method};
