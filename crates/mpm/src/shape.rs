//! Shape functions along one axis, in units of cells. Those of a node are their products over the axes.

/// Greatest number of nodes that a particle reaches along an axis.
pub(crate) const REACH: usize = 3;

/// What a particle shares with the nodes along an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    /// The first node.
    pub(crate) first: f64,
    /// Values.
    pub(crate) value: [f64; REACH],
    /// Derivatives by the place of the particle.
    pub(crate) slope: [f64; REACH],
}

/// A family of shape functions. Values sum to one, derivatives to zero, and both carry linear fields exactly, wherever a particle
/// is.
pub(crate) trait Shape: Copy + Send + Sync + 'static {
    /// Nodes that a particle reaches along an axis.
    const NODES: usize;
    /// Whether the width of a particle matters.
    const HAS_WIDTH: bool;
    /// For a particle at `at` with this width, where the first node lies within `low` and `high`.
    fn shares(at: f64, width: f64, bounds: (f64, f64)) -> Shares;
}

/// Keeps a node within bounds, also where it is not a number: only what is no longer finite is ever out of them.
#[inline(always)]
fn within(node: f64, (low, high): (f64, f64)) -> f64 {
    node.max(low).min(high)
}

/// Share of a particle on the edge of a cell that the node beyond still gets: nothing to anyone but this node, which moves with the
/// particle and does not strain it.
const LEAST_SHARE: f64 = 1e-18;

/// Hats.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear;

impl Shape for Linear {
    const NODES: usize = 2;
    const HAS_WIDTH: bool = false;

    #[inline(always)]
    fn shares(at: f64, _width: f64, bounds: (f64, f64)) -> Shares {
        let first = within(at.floor(), bounds);
        let past = (at - first).max(LEAST_SHARE);
        Shares { first, value: [1.0 - past, past, 0.0], slope: [-1.0, 1.0, 0.0] }
    }
}

/// Hats averaged over a particle of fixed width, at most a cell \[Bardenhagen2004\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct UniformGimp;

impl Shape for UniformGimp {
    const NODES: usize = 3;
    const HAS_WIDTH: bool = true;

    #[inline(always)]
    fn shares(at: f64, width: f64, bounds: (f64, f64)) -> Shares {
        let half = 0.5 * width;
        let first = within((at - half).floor(), bounds);
        // The particle begins in the cell above the first node. What of it is beyond the second node belongs to the third.
        let past = at - first;
        let (over, whole) = (past + half - 1.0, 1.0 / width);
        let beyond = over.max(0.0);
        let before = 1.0 + half - past;
        let inside = over < 0.0;
        let first_value = if inside { 1.0 - past } else { 0.5 * before * before * whole };
        let first_slope = if inside { -1.0 } else { -before * whole };
        let last_value = 0.5 * beyond * beyond * whole;
        let last_slope = beyond * whole;
        Shares {
            first,
            value: [first_value, 1.0 - first_value - last_value, last_value],
            slope: [first_slope, -first_slope - last_slope, last_slope],
        }
    }
}

/// Quadratic B-splines \[Steffen2008\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuadraticBspline;

impl Shape for QuadraticBspline {
    const NODES: usize = 3;
    const HAS_WIDTH: bool = false;

    #[inline(always)]
    fn shares(at: f64, _width: f64, bounds: (f64, f64)) -> Shares {
        let first = within((at - 0.5).floor(), bounds);
        let middle = at - first - 1.0;
        let (below, above) = (0.5 - middle, 0.5 + middle);
        Shares {
            first,
            value: [0.5 * below * below, 0.75 - middle * middle, 0.5 * above * above],
            slope: [-below, -2.0 * middle, above],
        }
    }
}

/// The same functions with values times the way from the particle to each node, in cells, in place of derivatives; over the sum of values
/// times squares of these ways if `PER_MOMENT`. What is given by a vector with the latter and taken with the former is the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arms<S, const PER_MOMENT: bool>(std::marker::PhantomData<S>);

impl<S: Shape, const PER_MOMENT: bool> Shape for Arms<S, PER_MOMENT> {
    const NODES: usize = S::NODES;
    const HAS_WIDTH: bool = S::HAS_WIDTH;

    #[inline(always)]
    fn shares(at: f64, width: f64, bounds: (f64, f64)) -> Shares {
        let Shares { first, value, .. } = S::shares(at, width, bounds);
        let way: [f64; REACH] = std::array::from_fn(|node| first + node as f64 - at);
        let slope: [f64; REACH] = std::array::from_fn(|node| value[node] * way[node]);
        let per_moment =
            if PER_MOMENT { 1.0 / (slope[0] * way[0] + slope[1] * way[1] + slope[2] * way[2]) } else { 1.0 };
        Shares { first, value, slope: slope.map(|slope| slope * per_moment) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: (f64, f64) = (-3.0, 12.0);

    fn check<S: Shape>(width: f64) {
        for step in 0..4000 {
            let at = -1.0 + 0.0025 * f64::from(step) + 1e-4;
            let Shares { first, value, slope } = S::shares(at, width, BOUNDS);
            let nodes = [first, first + 1.0, first + 2.0];
            let sum = |numbers: [f64; 3]| numbers.iter().sum::<f64>();
            let moment = |numbers: [f64; 3]| numbers.iter().zip(nodes).map(|(n, x)| n * x).sum::<f64>();
            assert!((sum(value) - 1.0).abs() < 1e-14);
            assert!(sum(slope).abs() < 1e-14);
            assert!((moment(value) - at).abs() < 1e-14 * at.abs().max(1.0));
            assert!((moment(slope) - 1.0).abs() < 1e-13);
            assert!(value.iter().all(|&share| (-1e-16..=1.0).contains(&share)));
            // Derivatives are those of the values.
            let (later, earlier) = (S::shares(at + 1e-6, width, BOUNDS), S::shares(at - 1e-6, width, BOUNDS));
            if later.first == earlier.first {
                for (node, slope) in slope.into_iter().enumerate() {
                    let by_difference = (later.value[node] - earlier.value[node]) / 2e-6;
                    assert!((by_difference - slope).abs() < 2e-6 / width.min(1.0), "node {node} at {at}");
                }
            }
        }
    }

    #[test]
    fn values_and_slopes_are_complete_to_first_order() {
        check::<Linear>(1.0);
        [0.05, 0.25, 0.5, 1.0].into_iter().for_each(check::<UniformGimp>);
        check::<QuadraticBspline>(1.0);
    }

    #[test]
    fn arms_have_no_mean_and_give_what_they_take() {
        fn check<S: Shape>(width: f64) {
            for step in 0..400 {
                let at = 0.01 * f64::from(step) + 1e-3;
                let given = Arms::<S, true>::shares(at, width, BOUNDS);
                let taken = Arms::<S, false>::shares(at, width, BOUNDS);
                assert!(taken.slope.iter().sum::<f64>().abs() < 1e-14);
                let back: f64 = (0..3).map(|k| given.slope[k] * (given.first + k as f64 - at)).sum();
                assert!((back - 1.0).abs() < 1e-13, "{at}: {back}");
            }
        }
        [0.05, 0.25, 0.5, 1.0].into_iter().for_each(check::<UniformGimp>);
        check::<QuadraticBspline>(1.0);
    }

    /// The closed form of \[Bardenhagen2004\] in the distance from a node.
    #[test]
    fn blocks_have_their_closed_form() {
        for (width, at) in [(0.5, 0.1), (0.5, 0.3), (0.5, 0.6), (0.5, 0.9), (0.25, 0.99), (1.0, 0.4)] {
            let shares = UniformGimp::shares(at, width, BOUNDS);
            for node in 0..3 {
                let r = (at - shares.first - node as f64).abs();
                let expected = if r < 0.5 * width {
                    1.0 - (4.0 * r * r + width * width) / (4.0 * width)
                } else if r < 1.0 - 0.5 * width {
                    1.0 - r
                } else {
                    (1.0 + 0.5 * width - r).max(0.0).powi(2) / (2.0 * width)
                };
                assert!((shares.value[node] - expected).abs() < 1e-15, "{width} {at} {node}");
            }
        }
    }

    #[test]
    fn what_is_not_a_number_stays_within_bounds() {
        let shares = QuadraticBspline::shares(f64::NAN, 1.0, BOUNDS);
        assert_eq!(shares.first, BOUNDS.0);
        assert!(shares.value[0].is_nan());
        assert_eq!(Linear::shares(2.0, 1.0, BOUNDS).value, [1.0, LEAST_SHARE, 0.0]);
    }
}
