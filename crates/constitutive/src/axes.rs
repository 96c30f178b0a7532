//! Which components of a tensor can differ from zero, and principal values there.

mod plane;
mod space;
#[cfg(test)]
mod tests;

use granular_core::SymmetricTensor;
use granular_core::glam::{DMat2, DMat3};
use std::fmt::Debug;

/// Where stress and strain live. A law that needs principal stresses asks for them here: in plane strain one of them is known, and
/// the others follow from a square root.
///
/// Nothing here branches: what calls it in a loop over particles can be turned into wide instructions.
pub trait Axes: Copy + Debug + Send + Sync + 'static {
    /// Whether the components xz and yz are zero, now and after any increment.
    const PLANE: bool;

    /// A gradient of displacement or velocity: `DMat2` in the plane, `DMat3` in space. Column j is the derivative along axis j.
    type Gradient: Copy + Debug;

    /// The axes that principal values belong to.
    type Directions: Copy + Debug;

    /// Principal values and their directions, to round-off. Equal values on the diagonal of a diagonal tensor come out equal to the
    /// last bit, in the plane those of xx and yy.
    fn principal(tensor: SymmetricTensor) -> Principal<Self::Directions>;

    /// The tensor with the directions of one that was decomposed, and other principal values, in the same order.
    fn with_values(directions: &Self::Directions, values: [f64; 3]) -> SymmetricTensor;

    /// Symmetric part of a gradient: the strain of a gradient of displacement.
    fn strain(gradient: Self::Gradient) -> SymmetricTensor;

    /// Adds what the rate of Jaumann adds in a step to the stress \[Pa\] of material that turns:
    /// see [`rotation::jaumann`](crate::rotation::jaumann).
    fn jaumann(stress: SymmetricTensor, gradient: Self::Gradient) -> SymmetricTensor;

    /// Turns the stress \[Pa\] with the material: see [`rotation::hughes_winget`](crate::rotation::hughes_winget).
    fn hughes_winget(stress: SymmetricTensor, gradient: Self::Gradient) -> SymmetricTensor;
}

/// Plane strain: the components xz and yz are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InPlane;

/// Any stress in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InSpace;

/// Principal values and the axes that they belong to.
#[derive(Clone, Copy, Debug)]
pub struct Principal<Directions> {
    /// The values, the largest first: in tension positive.
    pub values: [f64; 3],
    /// Their axes.
    pub directions: Directions,
}

impl Axes for InPlane {
    const PLANE: bool = true;

    type Gradient = DMat2;
    type Directions = plane::Directions;

    #[inline(always)]
    fn principal(tensor: SymmetricTensor) -> Principal<plane::Directions> {
        plane::principal(tensor)
    }

    #[inline(always)]
    fn with_values(directions: &plane::Directions, values: [f64; 3]) -> SymmetricTensor {
        directions.with_values(values)
    }

    #[inline(always)]
    fn strain(gradient: DMat2) -> SymmetricTensor {
        SymmetricTensor {
            xx: gradient.x_axis.x,
            yy: gradient.y_axis.y,
            xy: 0.5 * (gradient.y_axis.x + gradient.x_axis.y),
            ..SymmetricTensor::ZERO
        }
    }

    #[inline(always)]
    fn jaumann(stress: SymmetricTensor, gradient: DMat2) -> SymmetricTensor {
        crate::rotation::plane_jaumann(stress, gradient)
    }

    #[inline(always)]
    fn hughes_winget(stress: SymmetricTensor, gradient: DMat2) -> SymmetricTensor {
        crate::rotation::plane_hughes_winget(stress, gradient)
    }
}

impl Axes for InSpace {
    const PLANE: bool = false;

    type Gradient = DMat3;
    type Directions = space::Directions;

    #[inline(always)]
    fn principal(tensor: SymmetricTensor) -> Principal<space::Directions> {
        space::principal(tensor)
    }

    #[inline(always)]
    fn with_values(directions: &space::Directions, values: [f64; 3]) -> SymmetricTensor {
        directions.with_values(values)
    }

    #[inline(always)]
    fn strain(gradient: DMat3) -> SymmetricTensor {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = gradient;
        SymmetricTensor {
            xx: x.x,
            yy: y.y,
            zz: z.z,
            xy: 0.5 * (y.x + x.y),
            yz: 0.5 * (z.y + y.z),
            xz: 0.5 * (z.x + x.z),
        }
    }

    #[inline(always)]
    fn jaumann(stress: SymmetricTensor, gradient: DMat3) -> SymmetricTensor {
        crate::rotation::space_jaumann(stress, gradient)
    }

    #[inline(always)]
    fn hughes_winget(stress: SymmetricTensor, gradient: DMat3) -> SymmetricTensor {
        crate::rotation::space_hughes_winget(stress, gradient)
    }
}

/// Two of the principal values lie in a plane, the third along its normal: where the third stands among them.
///
/// Of the two in the plane only mean and half difference are needed to put values back, never their axes, which are undefined where the two are equal.
#[derive(Clone, Copy, Debug)]
struct Order {
    /// Half the difference of the two values in the plane.
    radius: f64,
    /// The value along the normal is the largest.
    normal_is_first: bool,
    /// The value along the normal is the smallest.
    normal_is_last: bool,
}

impl Order {
    /// Values in their order, by mean and half difference of those in the plane, and the value along the normal.
    #[inline(always)]
    fn of(mean: f64, radius: f64, normal: f64) -> ([f64; 3], Self) {
        let (high, low) = (mean + radius, mean - radius);
        let (normal_is_first, normal_is_last) = (normal > high, normal < low);
        let first = if normal_is_first { normal } else { high };
        let last = if normal_is_last { normal } else { low };
        let middle = if normal_is_last { low } else { normal };
        let middle = if normal_is_first { high } else { middle };
        ([first, middle, last], Self { radius, normal_is_first, normal_is_last })
    }

    /// Of new values: the mean of those in the plane, what the deviator in the plane is to be multiplied by, and the value along
    /// the normal.
    #[inline(always)]
    fn undo(&self, [first, middle, last]: [f64; 3]) -> (f64, f64, f64) {
        let high = if self.normal_is_first { middle } else { first };
        let low = if self.normal_is_last { middle } else { last };
        let normal = if self.normal_is_last { last } else { middle };
        let normal = if self.normal_is_first { first } else { normal };
        let divisor = if self.radius > 0.0 { self.radius } else { 1.0 };
        let scale = 0.5 * (high - low) / divisor;
        (0.5 * (high + low), if self.radius > 0.0 { scale } else { 0.0 }, normal)
    }
}
