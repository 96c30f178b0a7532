//! Statistics: means, lines and power laws with their standard errors.

/// The larger number; one that is not a number does not get lost.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// The line `intercept + slope x` through some points by least squares. Its standard errors take the scatter about the
/// line, with two degrees of freedom less than points, as equal everywhere; they are not numbers for two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Value at zero.
    pub intercept: f64,
    /// Slope.
    pub slope: f64,
    /// Standard error of the intercept.
    pub intercept_error: f64,
    /// Standard error of the slope.
    pub slope_error: f64,
}

impl Line {
    /// The line nearest to these points, x and y.
    pub fn through(points: &[(f64, f64)]) -> Self {
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
        let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        let spread = points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
        let slope = covariance / spread;
        let intercept = y - slope * x;
        let line = Self { intercept, slope, intercept_error: f64::NAN, slope_error: f64::NAN };
        if points.len() < 3 {
            return line;
        }
        let variance = line.misfit(points) / (count - 2.0);
        let intercept_error = (variance * (1.0 / count + x * x / spread)).sqrt();
        Self { intercept_error, slope_error: (variance / spread).sqrt(), ..line }
    }

    /// Value at x.
    pub fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }

    /// Sum of the squares of what points are off the line.
    pub fn misfit(&self, points: &[(f64, f64)]) -> f64 {
        points.iter().map(|&(x, y)| (y - self.intercept - self.slope * x).powi(2)).sum()
    }
}

/// The power law `factor x^exponent` through some points, by least squares of the logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Value at one.
    pub factor: f64,
    /// Exponent.
    pub exponent: f64,
    /// Standard error of the exponent; not a number for two points.
    pub error: f64,
}

impl PowerLaw {
    /// The law nearest to these points, x and y above zero.
    pub fn through(points: &[(f64, f64)]) -> Self {
        let logs: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x.ln(), y.ln())).collect();
        let line = Line::through(&logs);
        Self { factor: line.intercept.exp(), exponent: line.slope, error: line.slope_error }
    }

    /// Value at x.
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }

    /// Where two laws have the same value.
    pub fn meets(&self, other: &Self) -> Option<f64> {
        let x = (self.factor / other.factor).powf(1.0 / (other.exponent - self.exponent));
        x.is_finite().then_some(x)
    }
}

impl std::fmt::Display for PowerLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { factor, exponent, error } = self;
        write!(f, "{factor:.4} x^{exponent:.3}, exponent ± {error:.3}")
    }
}

/// Order of convergence: the exponent of the power law through steps and errors.
pub fn order(points: &[(f64, f64)]) -> f64 {
    PowerLaw::through(points).exponent
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
        let law = PowerLaw::through(&points);
        assert!((law.factor - 5.0).abs() < 1e-11 && (law.exponent - 1.7).abs() < 1e-12 && law.error < 1e-12);
        assert!((law.at(0.11) / points[1].1 - 1.0).abs() < 1e-12);
        let other = PowerLaw { factor: 2.5, exponent: 2.7, error: 0.0 };
        assert!((law.meets(&other).unwrap() - 2.0).abs() < 1e-10);
        assert_eq!(law.meets(&PowerLaw { factor: 2.0, ..law }), None);
    }

    #[test]
    fn means_and_middles() {
        assert_eq!(mean_and_error(&[1.0, 3.0]), (2.0, 1.0));
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(root_mean_square(&[3.0, -3.0]), 3.0);
    }

    /// By hand: x 0, 1, 2 and y 0, 2, 1 have slope 1/2, intercept 1/2 and squares left 3/2, of one degree of freedom. The
    /// errors are sqrt(3/2 / 2) and sqrt(3/2 (1/3 + 1/2)).
    #[test]
    fn errors_of_a_line_are_those_of_the_scatter() {
        let line = Line::through(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)]);
        assert!((line.slope - 0.5).abs() < 1e-15 && (line.intercept - 0.5).abs() < 1e-15);
        assert!((line.slope_error - 0.75_f64.sqrt()).abs() < 1e-15);
        assert!((line.intercept_error - 1.25_f64.sqrt()).abs() < 1e-15);
        let exact = Line::through(&[(1.0, 5.0), (3.0, 9.0)]);
        assert_eq!((exact.slope, exact.at(2.0)), (2.0, 7.0));
        assert!(exact.slope_error.is_nan());
    }

    /// Of lines fitted to the same points with random errors, two in three lie within one standard error of the true one,
    /// and nineteen in twenty within two: Student's distribution with eight degrees of freedom has 0.653 and 0.920.
    #[test]
    fn standard_errors_cover_the_true_line() {
        let mut random = granular_core::random::Chance::new(7);
        let mut within = [0; 2];
        let count = 4000;
        for _ in 0..count {
            let points: Vec<(f64, f64)> = (0..10)
                .map(|k| {
                    // Twelve uniform numbers make a normal one.
                    let error = (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
                    (f64::from(k), 3.0 - 0.5 * f64::from(k) + error)
                })
                .collect();
            let line = Line::through(&points);
            let off = (line.slope + 0.5).abs() / line.slope_error;
            within[0] += usize::from(off < 1.0);
            within[1] += usize::from(off < 2.0);
        }
        let share = within.map(|number| number as f64 / f64::from(count));
        assert!((share[0] - 0.653).abs() < 0.03 && (share[1] - 0.920).abs() < 0.02, "{share:?}");
    }
}
