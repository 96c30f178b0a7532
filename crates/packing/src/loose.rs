//! A loose lattice of grains of any sizes, from which gravity makes a bed.

use crate::error::{PackingError, largest_radius, require};
use crate::random::Random;
use granular_core::{Dim, Vector};

/// Part of the free space of a cell that the jitter uses; the rest keeps grains apart.
const JITTER: f64 = 0.98;

/// Centres \[m\] of grains of the given `radii` \[m\] on a loose lattice: layers upon `low`, to
/// be let fall by a solver \[Kumar2014, section 3.5.5\].
///
/// Every grain has a cell of its own, at least `1 + gap` largest diameters wide; cells share
/// the edges of the base evenly. `base` holds those edges \[m\], one per axis other than up, `low`
/// is the lowest corner \[m\]. Each centre is moved from the middle of its cell by at most
/// half the gap along each axis, drawn from `seed`, so that columns do not stand on edge;
/// grains never overlap and stay inside the base. Grains keep their order: along x first.
pub fn loose_lattice<D: Dim>(
    radii: &[f64],
    low: D::Vec,
    base: &[f64],
    gap: f64,
    seed: u64,
) -> Result<Vec<D::Vec>, PackingError> {
    let diameter = 2.0 * largest_radius(radii)?;
    require(gap >= 0.0 && gap.is_finite(), "gap over the largest diameter", gap, "0 and above, finite")?;
    require(
        base.len() == D::N - 1,
        "number of edges of the base",
        base.len() as f64,
        (D::N - 1).to_string(),
    )?;
    let spacing = diameter * (1.0 + gap);
    let mut cells = [usize::MAX; 3];
    let mut widths = [spacing; 3];
    for (axis, &edge) in (0..D::N).filter(|&axis| axis != D::UP).zip(base) {
        // A base of exactly n spacings has n cells in spite of round-off.
        let fitting = (edge / spacing * (1.0 + 4.0 * f64::EPSILON)).floor();
        require(
            fitting >= 1.0 && edge.is_finite(),
            "edge of the base [m]",
            edge,
            format!("at least {spacing}"),
        )?;
        cells[axis] = fitting as usize;
        widths[axis] = edge / fitting;
    }
    let amplitude = JITTER * gap * diameter;
    let mut random = Random::new(seed);
    let place = |index: usize| {
        let mut rest = index;
        (0..D::N).fold(low, |centre, axis| {
            let cell = rest % cells[axis];
            rest /= cells[axis];
            let jitter = amplitude * (random.uniform() - 0.5);
            centre + D::Vec::along(axis, (cell as f64 + 0.5) * widths[axis] + jitter)
        })
    };
    Ok((0..radii.len()).map(place).collect())
}

#[cfg(test)]
mod tests;
