//! Samples that are columns: their outline, which grains and a continuum share.

#[cfg(any(feature = "dem", feature = "mpm"))]
mod outline;

#[cfg(any(feature = "dem", feature = "mpm"))]
pub(crate) use outline::{Outline, check_grading, grading_of, volume};

/// Size of a column \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnSize {
    /// Width along x; the radius of a cylinder.
    pub width: f64,
    /// Height asked for; what comes to rest may differ.
    pub height: f64,
    /// Depth along y in space; none for a cylinder.
    pub depth: Option<f64>,
    /// Whether it is a cylinder about the z axis.
    pub round: Option<Round>,
}

/// How much of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Round {
    /// All of it.
    Whole,
    /// The half with y above 0.
    Half,
}

impl ColumnSize {
    /// The number that says how far it spread.
    pub fn front(&self) -> &'static str {
        if self.round.is_some() { "radial_front" } else { "front" }
    }

    /// The number that says how far 99 % of its mass did.
    pub fn front_99(&self) -> &'static str {
        if self.round.is_some() { "radial_front_99" } else { "front_99" }
    }
}
