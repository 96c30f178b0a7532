//! Whether the numbers are right, how fast they come, and where they end: validation, stability, precision and speed.
//!
//! [`validate`] compares with known answers, [`validate::stability`] drives solvers to their limits from both sides,
//! [`bench`](mod@bench) measures error against run time and throughput.

pub mod bench;
pub mod validate;
