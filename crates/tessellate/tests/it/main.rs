//! Diagrams against their definition.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail like tests")]

mod diagrams;
mod extreme;
mod periodic;
mod power;
mod properties;
mod support;
