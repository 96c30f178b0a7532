//! Statistics of errors: order of convergence, mean and its uncertainty.

/// The larger number; one that is not a number does not get lost.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// Slope of the least-squares line through the logarithms of steps and errors: the order.
pub fn order(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|&(step, error)| (step.ln(), error.ln())).collect();
    let count = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
    let covariance: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    covariance / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// Factor and exponent of the power law through some points, by least squares of the logarithms.
pub fn power_law(points: &[(f64, f64)]) -> (f64, f64) {
    let exponent = order(points);
    let rest = points.iter().map(|&(x, y)| y.ln() - exponent * x.ln()).sum::<f64>() / points.len() as f64;
    (rest.exp(), exponent)
}

/// Mean of some values and its standard error.
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

/// Root of the mean square.
pub fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Middle of some values; of two, the lower.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get((values.len().max(1) - 1) / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_a_power_is_its_exponent() {
        let points: Vec<(f64, f64)> = [0.3, 0.11, 0.02].map(|h: f64| (h, 5.0 * h.powf(1.7))).to_vec();
        assert!((order(&points) - 1.7).abs() < 1e-12);
        let (factor, exponent) = power_law(&points);
        assert!((factor - 5.0).abs() < 1e-11 && (exponent - 1.7).abs() < 1e-12);
        assert_eq!(mean_and_error(&[1.0, 3.0]), (2.0, 1.0));
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(root_mean_square(&[3.0, -3.0]), 3.0);
    }
}
