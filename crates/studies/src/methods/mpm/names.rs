//! Shape functions and schemes as they are called in rows.

use granular_driver::failure::Failure;
use granular_mpm::{Scheme, ShapeFunctions};

/// Shape functions by name.
pub(super) const SHAPES: [(&str, ShapeFunctions); 3] = [
    ("linear", ShapeFunctions::Linear),
    ("gimp", ShapeFunctions::UniformGimp),
    ("bspline", ShapeFunctions::QuadraticBspline),
];

/// Schemes by name.
pub(super) const SCHEMES: [(&str, Scheme); 3] = [
    ("stress-last", Scheme::StressLast),
    ("stress-first", Scheme::StressFirst),
    ("modified-stress-last", Scheme::ModifiedStressLast),
];

/// A failure of what cannot be set up.
pub(super) fn said(error: impl std::fmt::Display) -> Failure {
    Failure::Io(error.to_string())
}
