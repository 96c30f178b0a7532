//! Separation of material that carries no tension.

use granular_core::SymmetricTensor;

/// The part of an increment of strain that acts on material in contact, and the gap that is left.
///
/// While a gap is open, volumetric strain widens or closes it and nothing is carried. When it closes within the increment, the
/// rest of the increment acts. A split of the increment changes neither.
#[inline(always)]
pub(crate) fn close(gap: f64, strain: SymmetricTensor) -> (SymmetricTensor, f64) {
    let volumetric = strain.trace();
    let after = gap + volumetric;
    let (open, closes) = (gap > 0.0, after < 0.0);
    let rest = if closes { after / volumetric } else { 0.0 };
    let share = if open { rest } else { 1.0 };
    let left = if open { after } else { 0.0 };
    (strain * share, if closes { 0.0 } else { left })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_closed_before_material_carries() {
        let squeeze = SymmetricTensor { xx: -0.03, yy: -0.01, xy: 0.02, ..SymmetricTensor::ZERO };
        assert_eq!(close(0.0, squeeze), (squeeze, 0.0));
        let (acts, left) = close(0.05, squeeze);
        assert_eq!(acts, SymmetricTensor::ZERO);
        assert!((left - 0.01).abs() < 1e-15);
        let (acts, left) = close(0.01, squeeze);
        assert_eq!(left, 0.0);
        assert!((acts.trace() + 0.03).abs() < 1e-15 && (acts.xy - 0.015).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_finite_shows() {
        let nan = SymmetricTensor { xx: f64::NAN, ..SymmetricTensor::ZERO };
        for gap in [0.0, 0.1] {
            assert!(close(gap, nan).0.xx.is_nan());
        }
        assert!(close(0.1, SymmetricTensor { xx: f64::INFINITY, ..SymmetricTensor::ZERO }).0.xx.is_nan());
    }
}
