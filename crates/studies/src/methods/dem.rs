//! The discrete element method, for grains.

pub(super) mod cases;
mod precision;
mod speed;
mod stability;

use super::Method;

pub(super) const METHOD: Method = Method {
    cases: cases::CASES,
    stability: Some(stability::STUDY),
    precision: precision::STUDIES,
    speed: Some(speed::THROUGHPUT),
    ..Method::named("dem", "Discrete element method")
};
