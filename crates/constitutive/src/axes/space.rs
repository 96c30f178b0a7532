//! Principal values in space without angles and without iterations that depend on the tensor.
//!
//! The deviator, scaled so that its square has the trace 6, has the characteristic polynomial `x^3 - 3 x - 2 h` with `|h| <= 1`. One
//! root stands apart from the other two by at least the square root of 3, and Newton's method finds it from a polynomial in `h`. Its
//! direction is a column of the adjugate of the matrix less that root, which is far from zero because the root stands apart. The
//! other two values are those of the tensor in the plane across this direction, where a square root gives them, however close they are
//! \[Eberly2014\].

use super::{Order, Principal};
use granular_core::SymmetricTensor;
use granular_core::glam::DVec3;

/// Axes of principal values of any symmetric tensor.
#[derive(Clone, Copy, Debug)]
pub struct Directions {
    order: Order,
    /// Dyad of the direction that stands apart.
    normal: SymmetricTensor,
    /// What the tensor has in the plane across it, less the mean there.
    in_plane: SymmetricTensor,
}

#[inline(always)]
pub(super) fn principal(tensor: SymmetricTensor) -> Principal<Directions> {
    let mean = tensor.trace() * (1.0 / 3.0);
    let deviator = tensor - SymmetricTensor::IDENTITY * mean;
    let apart = direction_apart(deviator);
    let (one, two) = across(apart);
    let (with_one, with_two) = (times(deviator, one), times(deviator, two));
    let (xx, yy, xy) = (one.dot(with_one), two.dot(with_two), one.dot(with_two));
    let (half_sum, half_difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = (half_difference * half_difference + xy * xy).sqrt();
    let value = apart.dot(times(deviator, apart));
    let (values, order) = Order::of(mean + half_sum, radius, mean + value);
    let normal = SymmetricTensor::dyad(apart, apart);
    // Also what couples the normal with the plane, which is of the order of rounding: so the values that were found give the
    // tensor that they came from.
    let in_plane = deviator - SymmetricTensor::IDENTITY * half_sum - normal * (value - half_sum);
    Principal { values, directions: Directions { order, normal, in_plane } }
}

impl Directions {
    #[inline(always)]
    pub(super) fn with_values(&self, values: [f64; 3]) -> SymmetricTensor {
        let (mean, scale, normal) = self.order.undo(values);
        SymmetricTensor::IDENTITY * mean + self.normal * (normal - mean) + self.in_plane * scale
    }
}

/// Unit vector along the principal direction whose value is farthest from the other two; any direction where all are equal.
#[inline(always)]
fn direction_apart(deviator: SymmetricTensor) -> DVec3 {
    let size = (deviator.contract(deviator) * (1.0 / 6.0)).sqrt();
    let inverse = if size > 0.0 { 1.0 / size } else { 0.0 };
    let scaled = deviator * inverse;
    let half = 0.5 * determinant(scaled);
    let sign = if half < 0.0 { -1.0 } else { 1.0 };
    let size_of_half = half.abs();
    // Round-off in the trace can lead beyond 1 where there is hardly a deviator.
    let root = sign * largest_root(if size_of_half > 1.0 { 1.0 } else { size_of_half });
    let m = scaled - SymmetricTensor::IDENTITY * root;
    // Columns of the adjugate. Their lengths are in proportion to their elements on the diagonal.
    let x = DVec3::new(m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy);
    let y = DVec3::new(x.y, m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.xx * m.yz);
    let z = DVec3::new(x.z, y.z, m.xx * m.yy - m.xy * m.xy);
    let best = select(y.y > z.z, y, z);
    let best = select(x.x > y.y && x.x > z.z, x, best);
    let length = best.dot(best).sqrt();
    let is_direction = length > 0.0;
    // Divided, not multiplied by the inverse: an axis of coordinates stays one to the last bit.
    select(is_direction, best, DVec3::Z) / if is_direction { length } else { 1.0 }
}

/// The root of `x^3 - 3 x - 2 h` between the square root of 3 and 2, for h from 0 to 1.
#[inline(always)]
fn largest_root(h: f64) -> f64 {
    // Right to 9e-6 (fitted at Chebyshev points); Newton squares what is left twice.
    let mut x =
        1.732_059_71 + h * (0.332_858_04 + h * (-0.092_010_52 + h * (0.035_284_73 - h * 0.008_198_81)));
    x -= (x * (x * x - 3.0) - 2.0 * h) / (3.0 * (x * x - 1.0));
    x -= (x * (x * x - 3.0) - 2.0 * h) / (3.0 * (x * x - 1.0));
    x
}

/// Two unit vectors that are at right angles to a unit vector and to one another \[Duff2017\].
#[inline(always)]
fn across(n: DVec3) -> (DVec3, DVec3) {
    let sign = if n.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

#[inline(always)]
fn times(t: SymmetricTensor, v: DVec3) -> DVec3 {
    DVec3::new(
        t.xx * v.x + t.xy * v.y + t.xz * v.z,
        t.xy * v.x + t.yy * v.y + t.yz * v.z,
        t.xz * v.x + t.yz * v.y + t.zz * v.z,
    )
}

#[inline(always)]
fn determinant(t: SymmetricTensor) -> f64 {
    t.xx * (t.yy * t.zz - t.yz * t.yz) - t.xy * (t.xy * t.zz - t.yz * t.xz)
        + t.xz * (t.xy * t.yz - t.yy * t.xz)
}

#[inline(always)]
fn select(first: bool, a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(if first { a.x } else { b.x }, if first { a.y } else { b.y }, if first { a.z } else { b.z })
}
