//! The grading of grains that exist.

use crate::error::{PackingError, largest_radius};
use granular_core::Dim;

/// Share of the area (plane) or volume (space) in grains of at most `diameter` \[m\], measured
/// from their `radii` \[m\]. Not a number without grains.
pub fn finer_by_volume<D: Dim>(radii: &[f64], diameter: f64) -> f64 {
    let volume = |limit: f64| -> f64 {
        radii.iter().filter(|&&radius| 2.0 * radius <= limit).map(|&radius| D::ball_volume(radius)).sum()
    };
    volume(diameter) / volume(f64::INFINITY)
}

/// Median diameter $d_{50}$ \[m\] by area (plane) or volume (space): the smallest diameter in
/// `radii` \[m\] such that the grains up to it hold half of the sample.
pub fn median_diameter<D: Dim>(radii: &[f64]) -> Result<f64, PackingError> {
    let largest = largest_radius(radii)?;
    let mut sorted = radii.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let half = 0.5 * sorted.iter().map(|&radius| D::ball_volume(radius)).sum::<f64>();
    let mut finer = 0.0;
    let median = sorted.into_iter().find(|&radius| {
        finer += D::ball_volume(radius);
        finer >= half
    });
    Ok(2.0 * median.unwrap_or(largest))
}
