//! Reproducible random numbers.

pub(crate) use granular_core::random::Chance;
