//! Whole samples: every disk of a deposit is looked at.

mod ballistic;
mod sample;
