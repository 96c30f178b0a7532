//! The points equally near to two disks: a branch of a hyperbola with the centres as foci, or a straight line.

use crate::predicates::exact_separation;
use crate::site::Site;
use granular_core::glam::DVec2;

/// The branch $(a \cosh \eta,\; b \sinh \eta)$ about the middle between two centres, first axis from the left
/// site to the right one; $a$ is half the difference of radii. With growing $\eta$ the first site is at the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    middle: DVec2,
    axis: DVec2,
    a: f64,
    b: f64,
}

/// Share of the squared distance of the centres below which `4 b^2` is computed exactly.
const NARROW: f64 = 1e-6;

/// Above this `sinh` of a parameter its difference to another one is taken between logarithms.
const FAR: f64 = 8.0;

impl Curve {
    pub(crate) fn new(left: DVec2, left_radius: f64, right: DVec2, right_radius: f64) -> Self {
        let between = right - left;
        let distance = between.length();
        let step = left_radius - right_radius;
        let mut square = (distance - step.abs()) * (distance + step.abs());
        if square < NARROW * distance * distance {
            let [a, b] = [Site::new(left, left_radius), Site::new(right, right_radius)];
            square = exact_separation(&a, &b);
        }
        let b = (0.5 * square.sqrt()).max(f64::MIN_POSITIVE);
        Self { middle: left + 0.5 * between, axis: between / distance, a: 0.5 * step, b }
    }

    /// Whether it is a straight line.
    pub fn is_straight(&self) -> bool {
        self.a == 0.0
    }

    /// The sinh of the parameter of a point on the curve.
    fn sinh(&self, point: DVec2) -> f64 {
        self.axis.perp_dot(point - self.middle) / self.b
    }

    /// Parameter of a point on the curve.
    pub fn parameter(&self, point: DVec2) -> f64 {
        self.sinh(point).asinh()
    }

    /// The point at a parameter.
    pub fn point(&self, eta: f64) -> DVec2 {
        self.middle + self.axis * (self.a * eta.cosh()) + self.axis.perp() * (self.b * eta.sinh())
    }

    /// Area between chord and curve, positive where the curve runs at the right of its chord: what the
    /// left cell has more than the polygon of its corners.
    pub(crate) fn area_beyond_chord(&self, from: DVec2, to: DVec2) -> f64 {
        if self.a == 0.0 {
            return 0.0;
        }
        let (first, last) = (self.sinh(from), self.sinh(to));
        let beyond = if first.abs().max(last.abs()) < FAR {
            minus_asinh(last * (1.0 + first * first).sqrt() - first * (1.0 + last * last).sqrt())
        } else {
            sinh_minus(last.asinh() - first.asinh())
        };
        -0.5 * self.a * self.b * beyond
    }

    /// Coefficients of `p cosh + q sinh - r`, the distance of a point beyond a line.
    pub(crate) fn beyond(&self, from: DVec2, normal: DVec2) -> Beyond {
        Beyond {
            p: self.a * normal.dot(self.axis),
            q: self.b * normal.dot(self.axis.perp()),
            r: (from - self.middle).dot(normal),
        }
    }
}

/// `s - asinh(s)`, also where both are nearly equal.
fn minus_asinh(s: f64) -> f64 {
    let square = s * s;
    if square > 0.05 {
        return s - (s.abs() + (1.0 + square).sqrt()).ln().copysign(s);
    }
    // Terms of asinh: each is minus this share of the one before, times the square.
    let share = |k: f64| (2.0 * k - 1.0) * (2.0 * k - 1.0) / (2.0 * k * (2.0 * k + 1.0));
    let series = (2..12).rev().fold(1.0, |sum, k| 1.0 - square * share(f64::from(k)) * sum);
    s * square / 6.0 * series
}

/// `sinh(x) - x`, also where both are nearly equal.
fn sinh_minus(x: f64) -> f64 {
    if x.abs() > 1.0 {
        return x.sinh() - x;
    }
    let square = x * x;
    let terms = [272.0, 210.0, 156.0, 110.0, 72.0, 42.0, 20.0];
    let series = terms.iter().fold(1.0, |sum, term| 1.0 + square / term * sum);
    x * square / 6.0 * series
}

/// How far the points of a curve are beyond a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beyond {
    p: f64,
    q: f64,
    r: f64,
}

impl Beyond {
    /// Sign at a parameter, also an infinite one: whether the point is beyond the line.
    pub(crate) fn at(&self, eta: f64) -> bool {
        let Self { p, q, r } = *self;
        let end = |growing: f64| if growing == 0.0 { -r > 0.0 } else { growing > 0.0 };
        if eta == f64::INFINITY {
            end(p + q)
        } else if eta == f64::NEG_INFINITY {
            end(p - q)
        } else {
            p * eta.cosh() + q * eta.sinh() > r
        }
    }

    /// Parameters on the line, in order.
    pub(crate) fn roots(&self) -> [Option<f64>; 2] {
        // (p + q) e^2 - 2 r e + (p - q) = 0 for e = exp(eta)
        let Self { p, q, r } = *self;
        let inner = r * r - (p - q) * (p + q);
        if inner.is_nan() || inner < 0.0 {
            return [None; 2];
        }
        let large = r + inner.sqrt().copysign(r);
        let mut roots =
            [large / (p + q), (p - q) / large].map(|e| (e > 0.0 && e.is_finite()).then(|| e.ln()));
        if let [Some(a), Some(b)] = roots
            && a > b
        {
            roots.swap(0, 1);
        }
        roots
    }
}
