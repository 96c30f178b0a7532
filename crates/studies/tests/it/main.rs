//! All integration tests of the studies, in one binary: linking is what takes time.

// Helpers of tests may fail as tests do.
#![allow(clippy::unwrap_used)]

mod stability;
mod validation;
