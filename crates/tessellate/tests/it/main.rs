//! Diagrams against their definition.

mod diagrams;
mod extreme;
mod properties;
mod support;
