//! How far two curves or fields are apart.

use serde::Serialize;

/// Differences from a reference, in the unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Of the last values.
    pub last: f64,
    /// Root of the mean square.
    pub root_mean_square: f64,
    /// The largest, with its sign.
    pub largest: f64,
    /// Where it is: along the axis of a curve, number of the cell of a grid.
    pub at: f64,
}

impl Difference {
    /// Of a curve from a reference, at the points of the reference at which both are known. None where there are none.
    pub fn of(curve: &[[f64; 2]], reference: &[[f64; 2]]) -> Option<Self> {
        let pairs = reference.iter().filter_map(|&[x, y]| Some((x, value_at(curve, x)? - y)));
        let last = curve.last()?[1] - reference.last()?[1];
        Self::from(pairs.filter(|(_, difference)| difference.is_finite()), last)
    }

    /// Of the values of cells, where both are numbers.
    pub fn of_cells(field: &[f64], reference: &[f64]) -> Option<Self> {
        let pairs = field.iter().zip(reference).enumerate().map(|(k, (a, b))| (k as f64, a - b));
        Self::from(pairs.filter(|(_, difference)| difference.is_finite()), f64::NAN)
    }

    fn from(pairs: impl Iterator<Item = (f64, f64)>, last: f64) -> Option<Self> {
        let (mut count, mut squares, mut largest, mut at) = (0.0, 0.0, 0.0_f64, f64::NAN);
        for (x, difference) in pairs {
            (count, squares) = (count + 1.0, squares + difference * difference);
            if at.is_nan() || difference.abs() > largest.abs() {
                (largest, at) = (difference, x);
            }
        }
        (count > 0.0).then(|| Self { last, root_mean_square: (squares / count).sqrt(), largest, at })
    }
}

/// The value of a curve at increasing places, linear between them; none beyond its ends.
fn value_at(curve: &[[f64; 2]], x: f64) -> Option<f64> {
    let after = curve.partition_point(|point| point[0] < x);
    let later = curve.get(after)?;
    if later[0] == x {
        return Some(later[1]);
    }
    let before = curve.get(after.checked_sub(1)?)?;
    let share = (x - before[0]) / (later[0] - before[0]);
    Some(before[1] + share * (later[1] - before[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_between_points_are_compared_where_both_are() {
        let coarse = [[0.0, 0.0], [2.0, 4.0]];
        let fine: Vec<[f64; 2]> =
            (0..=6).map(|k| f64::from(k) * 0.5).map(|x| [x, 2.0 * x + 0.1 * x * x]).collect();
        let found = Difference::of(&coarse, &fine).unwrap();
        // At 0, 0.5, 1, 1.5 and 2.
        let squares: f64 = [0.0, 0.5, 1.0, 1.5, 2.0].iter().map(|x: &f64| (0.1 * x * x).powi(2)).sum();
        assert!((found.root_mean_square - (squares / 5.0).sqrt()).abs() < 1e-15);
        assert!((found.largest + 0.4).abs() < 1e-15 && found.at == 2.0);
        assert!((found.last - (4.0 - 6.9)).abs() < 1e-14);
        assert_eq!(Difference::of(&coarse, &[[5.0, 1.0]]), None);
        let cells = Difference::of_cells(&[1.0, f64::NAN, 3.0], &[1.0, 2.0, 5.0]).unwrap();
        assert_eq!((cells.largest, cells.at), (-2.0, 2.0));
    }
}
