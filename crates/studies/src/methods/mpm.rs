//! Material points, and the laws that they obey.

mod cases;
mod names;
mod precision;
mod speed;
mod stability;

use super::Method;

pub(super) const METHOD: Method = Method {
    cases: cases::CASES,
    stability: Some(stability::STUDY),
    precision: precision::STUDIES,
    speed: Some(speed::THROUGHPUT),
    ..Method::named("mpm", "Material points and constitutive laws")
};
