//! Grains of any sizes scattered in a cell, from which compression makes a packing.

use crate::error::{PackingError, largest_radius, require};
use crate::random::Random;
use granular_core::{Dim, Vector};

/// Part of the free space of a site that the jitter uses; the rest keeps grains apart.
const JITTER: f64 = 0.98;

/// Centres \[m\] of grains of the given `radii` \[m\] in a cell with lowest corner at the origin and
/// edges `size` \[m\] along the axes, which is periodic or has walls.
///
/// Sites form a lattice with the same number along each axis; those left over are spread evenly. Each
/// centre is moved from the middle of its site by what keeps the largest grains apart and inside, drawn from
/// `seed`. Grains keep their order: along x first.
///
/// # Errors
/// When the largest grain does not fit a site: below about `pi / 4` of the cell filled by grains of one size
/// (`pi / 6` in space), less for a wide grading.
pub fn scattered<D: Dim>(radii: &[f64], size: D::Vec, seed: u64) -> Result<Vec<D::Vec>, PackingError> {
    let diameter = 2.0 * largest_radius(radii)?;
    let mut side = 1_usize;
    while side.pow(D::N as u32) < radii.len() {
        side += 1;
    }
    let mut spacing = [0.0; 3];
    for (axis, spacing) in spacing.iter_mut().enumerate().take(D::N) {
        let edge = size.component(axis);
        let needed = diameter * side as f64;
        let allowed = format!("at least {needed:.4e}, so that {side} of the largest grains fit side by side");
        require(edge >= needed && edge.is_finite(), "edge of the cell [m]", edge, allowed)?;
        *spacing = edge / side as f64;
    }
    let sites = side.pow(D::N as u32) as u128;
    let mut random = Random::new(seed);
    let place = |grain: usize| {
        let mut rest = (grain as u128 * sites / radii.len() as u128) as usize;
        (0..D::N).fold(D::Vec::default(), |centre, axis| {
            let number = rest % side;
            rest /= side;
            let jitter = JITTER * (spacing[axis] - diameter) * (random.uniform() - 0.5);
            centre + D::Vec::along(axis, (number as f64 + 0.5) * spacing[axis] + jitter)
        })
    };
    Ok((0..radii.len()).map(place).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    #[test]
    fn grains_stay_apart_and_inside_and_differ_from_seed_to_seed() {
        let radii: Vec<f64> = (0..90).map(|k| 0.5e-3 + 1e-6 * f64::from(k % 40)).collect();
        let places = scattered::<D2>(&radii, DVec2::new(12e-3, 14e-3), 1).unwrap();
        for (i, (a, r)) in places.iter().zip(&radii).enumerate() {
            assert!(a.x >= *r && a.y >= *r && a.x <= 12e-3 - r && a.y <= 14e-3 - r);
            assert!(places[..i].iter().zip(&radii).all(|(b, s)| (*a - *b).length() > r + s));
        }
        assert_ne!(places, scattered::<D2>(&radii, DVec2::new(12e-3, 14e-3), 2).unwrap());
        let error = scattered::<D2>(&radii, DVec2::splat(9e-3), 1).unwrap_err();
        assert!(error.to_string().contains("edge of the cell"), "{error}");
    }
}
