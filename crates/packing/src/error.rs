//! What can be wrong with the request for a packing.

use std::fmt;

/// A grading that cannot be sampled: what is wrong, its value and what is allowed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct GradingError {
    /// The quantity that is refused.
    pub what: &'static str,
    /// Its value, in SI units.
    pub value: f64,
    /// The values that are allowed.
    pub allowed: String,
}

impl fmt::Display for GradingError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} is {}, allowed is {}", self.what, self.value, self.allowed)
    }
}

impl std::error::Error for GradingError {}

/// A packing that cannot be made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PackingError {
    /// A length, count or fraction that is out of its range.
    OutOfRange {
        /// The quantity that is refused.
        what: &'static str,
        /// Its value, in SI units.
        value: f64,
        /// The values that are allowed.
        allowed: String,
    },
    /// A grain without a positive, finite radius.
    Radius {
        /// Number of the grain.
        index: usize,
        /// Its radius \[m\].
        radius: f64,
    },
    /// A falling disk found no place without overlap, however often it was dropped anew.
    NotSettled {
        /// Number of the grain.
        index: usize,
        /// Its radius \[m\].
        radius: f64,
        /// How often it was dropped.
        drops: usize,
    },
}

impl fmt::Display for PackingError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { what, value, allowed } => {
                write!(formatter, "{what} is {value}, allowed is {allowed}")
            }
            Self::Radius { index, radius } => {
                write!(formatter, "radius of grain {index} is {radius} m, allowed is above 0 and finite")
            }
            Self::NotSettled { index, radius, drops } => {
                write!(formatter, "grain {index} of radius {radius} m did not settle in {drops} drops")
            }
        }
    }
}

impl std::error::Error for PackingError {}

/// Refuses `value` unless `accepted`.
pub(crate) fn require(
    accepted: bool,
    what: &'static str,
    value: f64,
    allowed: impl Into<String>,
) -> Result<(), PackingError> {
    if accepted { Ok(()) } else { Err(PackingError::OutOfRange { what, value, allowed: allowed.into() }) }
}

/// Refuses an empty list and any radius that is not positive and finite; returns the largest \[m\].
pub(crate) fn largest_radius(radii: &[f64]) -> Result<f64, PackingError> {
    let count = radii.len();
    require(count > 0 && count < u32::MAX as usize, "number of grains", count as f64, "1 to 4294967294")?;
    match radii.iter().position(|&radius| !(radius > 0.0 && radius.is_finite())) {
        Some(index) => Err(PackingError::Radius { index, radius: radii[index] }),
        None => Ok(radii.iter().copied().fold(0.0, f64::max)),
    }
}
