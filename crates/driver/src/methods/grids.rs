//! Grids over which particles are averaged, as a scene says them.

use super::member::NoGrid;
use crate::scene::GridSpec;
use granular_core::coarse::CoarseGrid;
use granular_core::units::Length;
use granular_core::{Dim, Vector};

/// The cells of a grid.
///
/// # Errors
/// When a value is out of range.
pub(crate) fn coarse_grid<D: Dim>(spec: &GridSpec) -> Result<CoarseGrid<D>, NoGrid> {
    let corner = |key, values: &[Length]| {
        let numbers: Vec<f64> = values.iter().map(|value| value.value()).collect();
        let wrong = || NoGrid {
            key,
            value: format!("a list of {}", values.len()),
            allowed: format!("{} values, one per axis", D::N),
        };
        D::Vec::from_slice(&numbers).ok_or_else(wrong)
    };
    let (from, to) = (corner("grid.from", &spec.from)?, corner("grid.to", &spec.to)?);
    CoarseGrid::new(from, to, spec.spacing.value(), spec.width).map_err(|error| {
        let key = match error.what.split(' ').next() {
            Some("spacing" | "cells") => "grid.spacing",
            Some("width") => "grid.width",
            _ => "grid.to",
        };
        let allowed = format!("{}: {}", error.what, error.allowed);
        NoGrid { key, value: error.value.to_string(), allowed }
    })
}
