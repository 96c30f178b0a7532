//! The lattice Boltzmann method, for a fluid.

mod cases;
mod operators;
mod precision;
mod speed;
mod stability;

use super::Method;

pub(super) const METHOD: Method = Method {
    cases: cases::CASES,
    stability: Some(stability::STUDY),
    precision: precision::STUDIES,
    comparisons: &[operators::COMPARISON],
    speed: Some(speed::THROUGHPUT),
    ..Method::named("lbm", "Lattice Boltzmann method")
};
