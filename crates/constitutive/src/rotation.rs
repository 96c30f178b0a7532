//! Objective updates: how stress turns with the material.
//!
//! The gradient is that of the displacement of a step, `L dt`; its antisymmetric part `W = (L - L^T) dt / 2` is the turn.
//! \[Kumar2014, eq. 3.20 and 3.21\] print these with the sign of the rate and a factor 1/2 lost.
//!
//! A step that first turns the stress and then adds the answer of the law to the strain is of first order in the step, since what the law adds
//! should have turned by half as well. To turn by half of the gradient before the law and by half after it is of second order.

use crate::axes::Axes;
use granular_core::SymmetricTensor;
use granular_core::glam::{DMat2, DMat3, DVec3};

/// Stress \[Pa\] after a step of the rate of Jaumann, `stress + (W stress - stress W)`: of first order in the angle, and the
/// deviator grows by the square of the angle in each step.
#[inline(always)]
pub fn jaumann<A: Axes>(stress: SymmetricTensor, gradient: A::Gradient) -> SymmetricTensor {
    A::jaumann(stress, gradient)
}

/// Stress \[Pa\] turned with the material, `Q stress Q^T` with `Q = (1 - W/2)^-1 (1 + W/2)` \[HughesWinget1980\]: invariants
/// stay to round-off however large the angle.
#[inline(always)]
pub fn hughes_winget<A: Axes>(stress: SymmetricTensor, gradient: A::Gradient) -> SymmetricTensor {
    A::hughes_winget(stress, gradient)
}

/// Component xy of W.
#[inline(always)]
fn plane_turn(gradient: DMat2) -> f64 {
    0.5 * (gradient.y_axis.x - gradient.x_axis.y)
}

#[inline(always)]
pub(crate) fn plane_jaumann(stress: SymmetricTensor, gradient: DMat2) -> SymmetricTensor {
    let turn = plane_turn(gradient);
    let normal = 2.0 * turn * stress.xy;
    SymmetricTensor {
        xx: stress.xx + normal,
        yy: stress.yy - normal,
        xy: stress.xy + turn * (stress.yy - stress.xx),
        ..stress
    }
}

#[inline(always)]
pub(crate) fn plane_hughes_winget(stress: SymmetricTensor, gradient: DMat2) -> SymmetricTensor {
    // Cosine and sine of the angle follow from the tangent of its half; the deviator turns by twice the angle.
    let half = 0.5 * plane_turn(gradient);
    let inverse = 1.0 / (1.0 + half * half);
    let (cos, sin) = ((1.0 - half * half) * inverse, 2.0 * half * inverse);
    let (cos_twice, sin_twice) = (cos * cos - sin * sin, 2.0 * sin * cos);
    let mean = 0.5 * (stress.xx + stress.yy);
    let difference = 0.5 * (stress.xx - stress.yy);
    let turned = cos_twice * difference + sin_twice * stress.xy;
    SymmetricTensor {
        xx: mean + turned,
        yy: mean - turned,
        xy: cos_twice * stress.xy - sin_twice * difference,
        ..stress
    }
}

/// Axial vector w of W: `W v = w x v`.
#[inline(always)]
fn space_turn(gradient: DMat3) -> DVec3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = gradient;
    DVec3::new(0.5 * (y.z - z.y), 0.5 * (z.x - x.z), 0.5 * (x.y - y.x))
}

#[inline(always)]
pub(crate) fn space_jaumann(stress: SymmetricTensor, gradient: DMat3) -> SymmetricTensor {
    // `W stress - stress W = W stress + (W stress)^T`: rows of W are those of a cross product.
    let w = space_turn(gradient);
    let s = stress;
    SymmetricTensor {
        xx: s.xx + 2.0 * (w.y * s.xz - w.z * s.xy),
        yy: s.yy + 2.0 * (w.z * s.xy - w.x * s.yz),
        zz: s.zz + 2.0 * (w.x * s.yz - w.y * s.xz),
        xy: s.xy + w.y * s.yz - w.z * s.yy + w.z * s.xx - w.x * s.xz,
        yz: s.yz + w.z * s.xz - w.x * s.zz + w.x * s.yy - w.y * s.xy,
        xz: s.xz + w.y * s.zz - w.z * s.yz + w.x * s.xy - w.y * s.xx,
    }
}

#[inline(always)]
pub(crate) fn space_hughes_winget(stress: SymmetricTensor, gradient: DMat3) -> SymmetricTensor {
    let half = space_turn(gradient) * 0.5;
    let factor = 2.0 / (1.0 + half.dot(half));
    // `Q v = v + factor h x (v + h x v)`.
    let turn = |v: DVec3| v + half.cross(v + half.cross(v)) * factor;
    let (x, y, z) = (turn(DVec3::X), turn(DVec3::Y), turn(DVec3::Z));
    let s = stress;
    // Columns of `Q stress`; rows of Q are the components of its columns x, y, z.
    let (a, b, c) =
        (x * s.xx + y * s.xy + z * s.xz, x * s.xy + y * s.yy + z * s.yz, x * s.xz + y * s.yz + z * s.zz);
    SymmetricTensor {
        xx: a.x * x.x + b.x * y.x + c.x * z.x,
        yy: a.y * x.y + b.y * y.y + c.y * z.y,
        zz: a.z * x.z + b.z * y.z + c.z * z.z,
        xy: a.x * x.y + b.x * y.y + c.x * z.y,
        yz: a.y * x.z + b.y * y.z + c.y * z.z,
        xz: a.x * x.z + b.x * y.z + c.x * z.z,
    }
}

#[cfg(test)]
mod tests;
