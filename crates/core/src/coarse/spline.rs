//! The kernel: cubic B-splines whose knots lie on the cells of a grid.

/// Largest scale of the kernel, in cells.
pub(super) const WIDEST: usize = 8;
/// Most cells along an axis that a kernel reaches.
const MOST: usize = 4 * WIDEST + 1;
/// Farthest place, in cells: more than any grid has.
const FARTHEST: f64 = 1e12;

/// Weights of cells along one axis; they sum to one where the grid does not end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// First cell, which may lie outside the grid.
    first: isize,
    count: usize,
    value: [f64; MOST],
}

impl Weights {
    /// The one weight along an axis that does not exist.
    pub(super) const NONE: Self = {
        let mut value = [0.0; MOST];
        value[0] = 1.0;
        Self { first: 0, count: 1, value }
    };

    /// About a place, in cells from the centre of the first cell, for a kernel of `width` cells.
    #[inline(always)]
    pub(super) fn at(place: f64, width: usize) -> Self {
        Self::of(place, width, cubic, 1.0)
    }

    /// Derivatives of [`Weights::at`] with respect to the place of the cell, per cell.
    #[inline(always)]
    pub(super) fn slope(place: f64, width: usize) -> Self {
        Self::of(place, width, cubic_slope, 1.0 / width as f64)
    }

    #[inline(always)]
    fn of(place: f64, width: usize, spline: fn(f64) -> f64, factor: f64) -> Self {
        let scale = 1.0 / width as f64;
        // A grain that was shot away stays countable, and outside.
        let place = place.clamp(-FARTHEST, FARTHEST);
        let (first, count) = reach(place, width);
        let mut value = [0.0; MOST];
        for (k, value) in value.iter_mut().enumerate().take(count) {
            *value = scale * factor * spline(((first + k as isize) as f64 - place) * scale);
        }
        Self { first, count, value }
    }

    /// Cells and weights within a range of cells.
    #[inline(always)]
    pub(super) fn within(&self, from: usize, to: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        (0..self.count).filter_map(move |k| {
            let cell = self.first + k as isize;
            (cell >= from as isize && cell < to as isize).then(|| (cell as usize, self.value[k]))
        })
    }

    /// Share of the weight within the first `cells` cells; exactly one when none is outside.
    pub(super) fn share(&self, cells: usize) -> f64 {
        if self.first >= 0 && self.first + self.count as isize <= cells as isize {
            return 1.0;
        }
        self.within(0, cells).map(|(_, value)| value).sum()
    }
}

/// First cell and number of cells that a kernel about a place reaches.
#[inline(always)]
fn reach(place: f64, width: usize) -> (isize, usize) {
    let half = 2 * width as isize;
    (place.floor() as isize - half + 1, 2 * half as usize)
}

/// Whether a kernel about any place between two reaches cells of a range.
pub(super) fn touches([low, high]: [f64; 2], width: usize, from: usize, to: usize) -> bool {
    let half = 2.0 * width as f64;
    low - half < to as f64 && high + half > from as f64 - 1.0
}

/// The cubic B-spline: support of two to both sides, integral and sum over whole numbers one.
#[inline(always)]
fn cubic(x: f64) -> f64 {
    let a = x.abs();
    if a < 1.0 {
        2.0 / 3.0 - a * a * (1.0 - 0.5 * a)
    } else if a < 2.0 {
        (2.0 - a).powi(3) / 6.0
    } else {
        0.0
    }
}

#[inline(always)]
fn cubic_slope(x: f64) -> f64 {
    let a = x.abs();
    let slope = if a < 1.0 {
        a * (1.5 * a - 2.0)
    } else if a < 2.0 {
        -0.5 * (2.0 - a).powi(2)
    } else {
        0.0
    };
    slope * x.signum()
}

/// Nodes in [0, 1] and weights of Gauss-Legendre quadrature, exact up to degree 9.
pub(super) fn gauss() -> [(f64, f64); 5] {
    let root = |sign: f64| (5.0 + sign * 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let weight = |sign: f64| (322.0 + sign * 13.0 * 70.0_f64.sqrt()) / 1800.0;
    let ((near, far), (heavy, light)) = ((root(-1.0), root(1.0)), (weight(1.0), weight(-1.0)));
    let at = |x: f64| 0.5 * (1.0 + x);
    [(at(-far), light), (at(-near), heavy), (0.5, 64.0 / 225.0), (at(near), heavy), (at(far), light)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_have_the_place_as_their_mean() {
        for width in [1, 2, 3, 8] {
            for k in 0..1000 {
                let place = 20.0 + 0.0137 * f64::from(k);
                let weights = Weights::at(place, width);
                let sum: f64 = weights.within(0, 100).map(|(_, w)| w).sum();
                let mean: f64 = weights.within(0, 100).map(|(cell, w)| w * cell as f64).sum();
                let slope: f64 = Weights::slope(place, width).within(0, 100).map(|(_, w)| w).sum();
                assert!((sum - 1.0).abs() < 4e-16 * 4.0, "{sum}");
                assert!((mean - place).abs() < 1e-13 && slope.abs() < 1e-15, "{mean} {slope}");
            }
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        for x in [-1.7, -0.4, 0.0, 0.3, 0.99, 1.4, 2.5] {
            let step = 1e-6;
            let found = (cubic(x + step) - cubic(x - step)) / (2.0 * step);
            assert!((found - cubic_slope(x)).abs() < 1e-9, "{x}: {found}");
        }
    }

    #[test]
    fn the_kernel_is_nearly_a_normal_distribution() {
        let variance = 1.0_f64 / 3.0;
        let normal = |x: f64| (-0.5 * x * x / variance).exp() / (std::f64::consts::TAU * variance).sqrt();
        let worst = (0..300).map(|k| 0.01 * f64::from(k)).map(|x| (cubic(x) - normal(x)).abs());
        assert!(worst.fold(0.0, f64::max) < 0.04 * cubic(0.0));
    }

    #[test]
    fn quadrature_is_exact_up_to_degree_nine() {
        for degree in 0..10 {
            let sum: f64 = gauss().iter().map(|(x, w)| w * x.powi(degree)).sum();
            assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 1e-15, "{degree}: {sum}");
        }
    }

    #[test]
    fn a_share_is_one_inside_and_falls_to_nothing_outside() {
        assert_eq!(Weights::at(5.3, 2).share(20), 1.0);
        assert!((Weights::at(-0.5, 2).share(20) - 0.5).abs() < 1e-15);
        assert_eq!(Weights::at(1e300, 2).share(20), 0.0);
        assert_eq!(Weights::at(-1e300, 2).share(20), 0.0);
    }
}
