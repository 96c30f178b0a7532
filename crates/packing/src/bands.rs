//! How evenly a sample is packed: solid fraction and void ratio over horizontal bands.

use crate::beta::regularised_incomplete_beta;
use crate::error::{PackingError, largest_radius, require};
use crate::grading::median_diameter;
use granular_core::{Dim, Vector};

/// Thickness of a band over the median diameter \[Kumar2014, section 3.5.6\].
pub const BAND_OVER_MEDIAN_DIAMETER: f64 = 2.5;

/// Most bands that a sample is cut into.
const MOST_BANDS: f64 = 1e7;

/// Horizontal bands of equal thickness: from `low` up, as many as fit below `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bands {
    /// Width of the box \[m\] in the plane, area of its base \[m^2\] in space.
    pub base: f64,
    /// Height of the bottom of the first band \[m\].
    pub low: f64,
    /// Height that no band exceeds \[m\].
    pub high: f64,
    /// Thickness of a band \[m\].
    pub thickness: f64,
}

impl Bands {
    /// Bands of 2.5 median diameters ($d_{50}$ by volume) of the grains with these `radii` \[m\].
    pub fn of_grains<D: Dim>(radii: &[f64], base: f64, low: f64, high: f64) -> Result<Self, PackingError> {
        let thickness = BAND_OVER_MEDIAN_DIAMETER * median_diameter::<D>(radii)?;
        Ok(Self { base, low, high, thickness })
    }

    /// Number of whole bands; an error when the box has none or a length is out of range.
    pub fn count(&self) -> Result<usize, PackingError> {
        let Self { base, low, high, thickness } = *self;
        require(base > 0.0 && base.is_finite(), "base of the box [m or m^2]", base, "above 0 and finite")?;
        require(low.is_finite(), "bottom of the bands [m]", low, "finite")?;
        require(
            thickness > 0.0 && thickness.is_finite(),
            "thickness of a band [m]",
            thickness,
            "above 0 and finite",
        )?;
        // A height of exactly n bands has n bands in spite of round-off.
        let count = ((high - low) / thickness * (1.0 + 4.0 * f64::EPSILON)).floor();
        require(
            (1.0..=MOST_BANDS).contains(&count),
            "top of the bands [m]",
            high,
            format!("at least one band above {low}"),
        )?;
        Ok(count as usize)
    }
}

/// Solid fraction of each band, from the bottom up.
///
/// The part of a ball in a band is exact: a segment of a disk, a slice of a sphere. Balls of the
/// periodic images at the sides count once, as they should; `positions` and `radii` are in
/// metres, one per grain.
pub fn solid_fraction_bands<D: Dim>(
    positions: &[D::Vec],
    radii: &[f64],
    bands: &Bands,
) -> Result<Vec<f64>, PackingError> {
    largest_radius(radii)?;
    let count = bands.count()?;
    let same = positions.len() == radii.len();
    require(
        same,
        "number of positions",
        positions.len() as f64,
        format!("{} (one per radius)", radii.len()),
    )?;
    let mut fractions = vec![0.0; count];
    let band_volume = bands.base * bands.thickness;
    for (index, &radius) in radii.iter().enumerate() {
        let height = positions[index].component(D::UP);
        require(height.is_finite(), "height of a grain [m]", height, "finite")?;
        // A float cast saturates: what lies below starts at the first band.
        let first = ((height - radius - bands.low) / bands.thickness).floor() as usize;
        let mut below = volume_below::<D>(radius, bands.low + first as f64 * bands.thickness - height);
        for (band, fraction) in fractions.iter_mut().enumerate().skip(first) {
            let top = bands.low + (band + 1) as f64 * bands.thickness - height;
            let upto = volume_below::<D>(radius, top);
            *fraction += (upto - below) / band_volume;
            below = upto;
            if top >= radius {
                break;
            }
        }
    }
    Ok(fractions)
}

/// Variance of the void ratio over bands, $S = \frac{1}{N-1} \sum_i (e - e_i)^2$
/// \[Kumar2014, eq. 3.61\], from the solid fraction $\phi_i$ of each band.
///
/// $e_i = (1 - \phi_i) / \phi_i$ is the void ratio of a band (void over solid), $e$ that of all
/// bands together. No unit; the source calls a sample homogeneous below 0.05 \[Jiang2003\].
/// Refuses fewer than two bands and a solid fraction that is not above 0 and at most 1.
pub fn homogeneity(solid_fractions: &[f64]) -> Result<f64, PackingError> {
    let count = solid_fractions.len() as f64;
    require(count >= 2.0, "number of bands", count, "at least 2")?;
    for &fraction in solid_fractions {
        require(
            fraction > 0.0 && fraction <= 1.0,
            "solid fraction of a band",
            fraction,
            "above 0, at most 1",
        )?;
    }
    let void_ratio = |solid: f64| (1.0 - solid) / solid;
    let overall = void_ratio(solid_fractions.iter().sum::<f64>() / count);
    let squares: f64 = solid_fractions.iter().map(|&solid| (overall - void_ratio(solid)).powi(2)).sum();
    Ok(squares / (count - 1.0))
}

/// Volume of the part of a ball below a plane at `height` over its centre.
///
/// With $t$ = height / radius, half the ball plus the slice $\frac12 I_{t^2}(\frac12, \frac{N+1}{2})$
/// of it: one expression for the segment of a disk and the cap of a sphere.
fn volume_below<D: Dim>(radius: f64, height: f64) -> f64 {
    let t = (height / radius).clamp(-1.0, 1.0);
    let slice = regularised_incomplete_beta(t * t, 0.5, 0.5 * (D::N as f64 + 1.0));
    D::ball_volume(radius) * 0.5 * (1.0 + slice.copysign(t))
}

#[cfg(test)]
mod tests;
