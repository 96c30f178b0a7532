//! Diagrams against their definition.

mod diagrams;
mod extreme;
mod power;
mod properties;
mod support;
