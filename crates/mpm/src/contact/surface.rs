//! Where the surface of a body is near a node, by what the body has there.
//!
//! A node sees a body through its shape function. The middle of what it sees along a normal tells where the body ends: if it fills all
//! below a plane at `s`, that middle is at $c(s) = \int^s x S dx / \int^s S dx$, which grows with `s`. Unlike the share of the node that
//! is filled, the middle does not ask whether the body has a corner or an edge there. Shape functions of nodes have the same second moment in all
//! directions, so that the function along an axis serves for any.

use crate::setup::ShapeFunctions;

/// Intervals of the table over the whole of a shape function.
const INTERVALS: usize = 192;
/// Points of the sums within each.
const POINTS: usize = 16;

/// Middles of what a node sees of a body, for ends that are evenly spaced.
#[derive(Clone, Debug)]
pub(super) struct Surfaces {
    /// Distance at which a node sees nothing \[cells\].
    reach: f64,
    middles: [f64; INTERVALS + 1],
}

impl Surfaces {
    pub(super) fn of(shape: ShapeFunctions) -> Self {
        let (reach, function): (f64, fn(f64) -> f64) = match shape {
            // A body of blocks is seen as the whole body is through hats.
            ShapeFunctions::Linear | ShapeFunctions::UniformGimp => (1.0, hat),
            ShapeFunctions::QuadraticBspline => (1.5, spline),
        };
        let step = 2.0 * reach / (INTERVALS * POINTS) as f64;
        let (mut weight, mut moment) = (0.0, 0.0);
        let mut middles = [-reach; INTERVALS + 1];
        for (k, middle) in middles.iter_mut().enumerate().skip(1) {
            for point in (k - 1) * POINTS..k * POINTS {
                let at = (point as f64 + 0.5) * step - reach;
                weight += function(at);
                moment += function(at) * at;
            }
            *middle = moment / weight;
        }
        Self { reach, middles }
    }

    /// Where a body ends that fills what is below, with this middle; all in cells from the node.
    pub(super) fn end_of(&self, middle: f64) -> f64 {
        let after = self.middles.partition_point(|&other| other < middle).clamp(1, INTERVALS);
        let [low, high] = [self.middles[after - 1], self.middles[after]];
        let share = ((middle - low) / (high - low)).clamp(0.0, 1.0);
        ((after - 1) as f64 + share) * (2.0 * self.reach / INTERVALS as f64) - self.reach
    }

    /// The gap between a body that fills what is below and one that fills what is above; negative where they overlap.
    pub(super) fn gap(&self, below: f64, above: f64) -> f64 {
        -self.end_of(-above) - self.end_of(below)
    }
}

fn hat(at: f64) -> f64 {
    1.0 - at.abs()
}

fn spline(at: f64) -> f64 {
    let far = at.abs();
    if far < 0.5 { 0.75 - far * far } else { 0.5 * (1.5 - far) * (1.5 - far) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For hats that are filled to less than the node the middle is linear, `(2 s - 1) / 3`.
    #[test]
    fn ends_below_a_node_have_their_closed_form() {
        let surfaces = Surfaces::of(ShapeFunctions::UniformGimp);
        for middle in [-0.95, -0.7, -1.0 / 3.0] {
            let end = 0.5 * (3.0 * middle + 1.0);
            assert!((surfaces.end_of(middle) - end).abs() < 1e-3, "{middle}");
        }
    }

    #[test]
    fn bodies_that_touch_have_no_gap_wherever_the_node_is() {
        for shape in [ShapeFunctions::Linear, ShapeFunctions::QuadraticBspline] {
            let surfaces = Surfaces::of(shape);
            let function = if shape == ShapeFunctions::Linear { hat } else { spline };
            let middle = |from: f64, to: f64| {
                let points = (0..4000).map(|k| from + (to - from) * (f64::from(k) + 0.5) / 4000.0);
                let sum = |power: i32| points.clone().map(|x| function(x) * x.powi(power)).sum::<f64>();
                sum(1) / sum(0)
            };
            for end in [-0.8, -0.3, 0.0, 0.45, 0.9] {
                let [below, above] = [middle(-surfaces.reach, end), middle(end, surfaces.reach)];
                assert!(surfaces.gap(below, above).abs() < 5e-3, "{shape:?} {end}");
                let apart = surfaces.gap(below, middle(end + 0.05, surfaces.reach));
                assert!((apart - 0.05).abs() < 5e-3, "{shape:?} {end}: {apart}");
            }
        }
    }

    #[test]
    fn what_a_node_hardly_sees_has_an_end_within_its_reach() {
        let surfaces = Surfaces::of(ShapeFunctions::QuadraticBspline);
        assert_eq!(surfaces.end_of(-7.0), -1.5);
        assert_eq!(surfaces.end_of(0.3), 1.5);
    }
}
