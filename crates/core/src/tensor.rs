//! Symmetric tensors of second order, always 3x3: stress of a plane problem has a component
//! across the plane too.

use glam::DVec3;
use std::ops::{Add, AddAssign, Mul, Sub};

/// A symmetric 3x3 tensor such as stress \[Pa\] or strain \[-\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SymmetricTensor {
    /// Component xx.
    pub xx: f64,
    /// Component yy.
    pub yy: f64,
    /// Component zz.
    pub zz: f64,
    /// Components xy and yx.
    pub xy: f64,
    /// Components yz and zy.
    pub yz: f64,
    /// Components xz and zx.
    pub xz: f64,
}

impl SymmetricTensor {
    /// The zero tensor.
    pub const ZERO: Self = Self { xx: 0.0, yy: 0.0, zz: 0.0, xy: 0.0, yz: 0.0, xz: 0.0 };
    /// The unit tensor.
    pub const IDENTITY: Self = Self { xx: 1.0, yy: 1.0, zz: 1.0, xy: 0.0, yz: 0.0, xz: 0.0 };

    /// Symmetric part of the dyad `a b`.
    #[inline(always)]
    pub fn dyad(a: DVec3, b: DVec3) -> Self {
        Self {
            xx: a.x * b.x,
            yy: a.y * b.y,
            zz: a.z * b.z,
            xy: 0.5 * (a.x * b.y + a.y * b.x),
            yz: 0.5 * (a.y * b.z + a.z * b.y),
            xz: 0.5 * (a.x * b.z + a.z * b.x),
        }
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(self) -> f64 {
        self.xx + self.yy + self.zz
    }

    /// The tensor less a third of its trace on the diagonal.
    #[inline(always)]
    pub fn deviator(self) -> Self {
        self - Self::IDENTITY * (self.trace() / 3.0)
    }

    /// Full contraction `a : b`.
    #[inline(always)]
    pub fn contract(self, b: Self) -> f64 {
        self.xx * b.xx
            + self.yy * b.yy
            + self.zz * b.zz
            + 2.0 * (self.xy * b.xy + self.yz * b.yz + self.xz * b.xz)
    }
}

impl Add for SymmetricTensor {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self {
            xx: self.xx + b.xx,
            yy: self.yy + b.yy,
            zz: self.zz + b.zz,
            xy: self.xy + b.xy,
            yz: self.yz + b.yz,
            xz: self.xz + b.xz,
        }
    }
}

impl Sub for SymmetricTensor {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self + b * -1.0
    }
}

impl Mul<f64> for SymmetricTensor {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        Self {
            xx: self.xx * s,
            yy: self.yy * s,
            zz: self.zz * s,
            xy: self.xy * s,
            yz: self.yz * s,
            xz: self.xz * s,
        }
    }
}

impl AddAssign for SymmetricTensor {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviator_has_no_trace_and_work_is_full_contraction() {
        let stress = SymmetricTensor::dyad(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 2.0));
        assert!(stress.deviator().trace().abs() < 1e-15);
        assert_eq!(stress.contract(SymmetricTensor::IDENTITY), stress.trace());
        let shear = SymmetricTensor { xy: 3.0, ..SymmetricTensor::ZERO };
        assert_eq!(shear.contract(shear), 18.0);
    }
}
