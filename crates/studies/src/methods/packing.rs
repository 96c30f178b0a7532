//! Samples, as they are before any method runs them.

mod grading;

use super::Method;
use crate::validate::cases;

cases! { "packing";
    grading: "sizes follow the beta curve" => grading::run;
}

pub(super) const METHOD: Method = Method { cases: CASES, ..Method::named("packing", "Samples") };
