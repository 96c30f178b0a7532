//! Least squares of friction over the inertial number.

use crate::statistics::Line;

/// Mean of the second numbers.
pub(super) fn mean(points: &[(f64, f64)]) -> f64 {
    points.iter().map(|point| point.1).sum::<f64>() / points.len() as f64
}

/// `mu_s`, `mu_2` and `I_0` of the curve `mu_s + (mu_2 - mu_s) / (1 + I_0 / I)` nearest to some points. For each `I_0`,
/// from 0.01 to 10, the rest is a line over `1 / (1 + I_0 / I)`.
pub(super) fn saturating(points: &[(f64, f64)]) -> [f64; 3] {
    let mut best = (f64::INFINITY, [f64::NAN; 3]);
    for k in 0..=600 {
        let scale = 10_f64.powf(-2.0 + 0.005 * f64::from(k));
        let bent: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (1.0 / (1.0 + scale / x), y)).collect();
        let line = Line::through(&bent);
        let misfit = line.misfit(&bent);
        if misfit < best.0 {
            best = (misfit, [line.intercept, line.intercept + line.slope, scale]);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fits_find_the_curves_that_made_the_points() {
        let numbers = [0.003, 0.01, 0.03, 0.1, 0.3];
        let bent: Vec<(f64, f64)> = numbers.map(|x| (x, 0.38 + 0.26 / (1.0 + 0.279 / x))).to_vec();
        let [low, high, scale] = saturating(&bent);
        assert!((low - 0.38).abs() < 1e-3 && (high - 0.64).abs() < 5e-3, "{low} {high}");
        assert!((scale / 0.279 - 1.0).abs() < 0.02, "{scale}");
    }
}
