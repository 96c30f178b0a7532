//! Material points, and the laws that they obey.

mod elastic_column;
mod element_tests;

use super::Method;
use crate::validate::cases;

cases! { "mpm";
    element_tests: "laws of soil in triaxial, biaxial and oedometer tests" => element_tests::run;
    elastic_column: "settlement of an elastic column under its own weight" => elastic_column::run;
}

pub(super) const METHOD: Method =
    Method { cases: CASES, ..Method::named("mpm", "Material points and constitutive laws") };
