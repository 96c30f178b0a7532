//! The plane and the space: one sealed trait, two types.
//!
//! Every solver is written once against [`Dim`]. Mathematics that exists in one dimension only
//! is a method here, so that no solver asks which dimension it runs in.
//!
//! Tangential motion and force at a contact are handled through their dual, the cross product
//! with the contact normal, which is a [`Spin`]: a number in the plane, a vector in space. A
//! tangential displacement `xi` is kept as `normal x xi`; it turns back into a vector by
//! [`Dim::turn`]. One source then serves both dimensions.

use crate::field::FieldRef;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::PI;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::D2 {}
    impl Sealed for super::D3 {}
}

/// What vectors and spins have in common: a linear space over `f64` with an inner product.
pub trait Linear:
    Copy
    + Default
    + PartialEq
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
    + crate::snapshot::Stored
{
    /// The zero element.
    const ZERO: Self;
    /// Inner product.
    fn dot(self, other: Self) -> f64;
    /// Square of the length.
    #[inline(always)]
    fn length_squared(self) -> f64 {
        self.dot(self)
    }
    /// Length.
    #[inline(always)]
    fn length(self) -> f64 {
        self.length_squared().sqrt()
    }
    /// Whether every component is finite.
    fn is_finite(self) -> bool;
}

/// A position, velocity or force.
pub trait Vector: Linear {
    /// The vector with this length along axis `axis`.
    fn along(axis: usize, length: f64) -> Self;
    /// The vector with these components.
    fn from_fn(component: impl FnMut(usize) -> f64) -> Self;
    /// The vector with this length along every axis.
    fn splat(length: f64) -> Self;
    /// Component along axis `axis`.
    fn component(self, axis: usize) -> f64;
    /// Smaller of both, component by component.
    fn min(self, other: Self) -> Self;
    /// Larger of both, component by component.
    fn max(self, other: Self) -> Self;
    /// From one number per axis; `None` when the count is wrong.
    fn from_slice(components: &[f64]) -> Option<Self>;
    /// Padded with zero to three components, for output.
    fn padded(self) -> [f64; 3];
}

/// An angular velocity or torque: a number in the plane, a vector in space.
pub trait Spin: Linear {
    /// The spin about the axis that leaves the plane (z).
    fn about_z(rate: f64) -> Self;
    /// The component about z, the only one in the plane.
    fn z(self) -> f64;
    /// From components about x, y and z; the plane takes z.
    fn of_components(components: [f64; 3]) -> Self;
    /// Components about x, y and z; in the plane the first two are zero.
    fn components(self) -> [f64; 3];
}

/// The plane or the space. Sealed: only [`D2`] and [`D3`].
pub trait Dim: sealed::Sealed + Copy + Default + Debug + Send + Sync + 'static {
    /// Number of axes.
    const N: usize;
    /// Names of the axes.
    const AXES: &'static [&'static str];
    /// Axis that points up by convention: y in the plane, z in space.
    const UP: usize;
    /// Moment of inertia of a uniform ball over `mass * radius^2`: 1/2 for a disk, 2/5 for a sphere.
    const BALL_INERTIA: f64;
    /// Whether two balls can turn about their common normal.
    const TWISTS: bool;
    /// What a grain is called.
    const BALL: &'static str;
    /// Position, velocity, force.
    type Vec: Vector;
    /// Angular velocity, torque.
    type Spin: Spin;

    /// Area of a disk \[m^2\] or volume of a sphere \[m^3\].
    fn ball_volume(radius: f64) -> f64;
    /// Area \[m^2\] or volume \[m^3\] of the points of a ball about the origin that lie below `corner` \[m\] along
    /// every axis; exact in the plane, to about 1e-11 of the ball in space.
    fn ball_below(radius: f64, corner: Self::Vec) -> f64;
    /// Area \[m^2\] or volume \[m^3\] of the points of a ball about the origin in the box from `low` to `high` \[m\]; exact in
    /// the plane, in space to a few parts in 10 000 of a box that is smaller than the ball, and ten times faster than by
    /// [`Dim::ball_below`].
    fn ball_in_box(radius: f64, low: Self::Vec, high: Self::Vec) -> f64;
    /// Cross product of two vectors.
    fn cross(a: Self::Vec, b: Self::Vec) -> Self::Spin;
    /// Cross product `spin x arm`: the velocity at `arm` of a body that turns with `spin`.
    fn turn(spin: Self::Spin, arm: Self::Vec) -> Self::Vec;
    /// A vector turned by a rotation \[rad\]: an angle in the plane, a rotation vector in space, whose direction is the axis
    /// and whose length is the angle. Rodrigues' formula; one less the cosine from half the angle, so that a small turn is
    /// exact.
    fn rotated(vector: Self::Vec, rotation: Self::Spin) -> Self::Vec {
        let angle = rotation.length();
        if angle == 0.0 {
            return vector;
        }
        let axis = rotation * (1.0 / angle);
        let once = Self::turn(axis, vector);
        let half = (0.5 * angle).sin();
        vector + once * angle.sin() + Self::turn(axis, once) * (2.0 * half * half)
    }
    /// The rotation \[rad\] that turns by `first` and by `then` after it. In space its angle is at most half a turn.
    fn rotation_after(first: Self::Spin, then: Self::Spin) -> Self::Spin;
    /// The part of `spin` at right angles to the unit vector `normal`; all of it in the plane.
    fn tangential(spin: Self::Spin, normal: Self::Vec) -> Self::Spin;
    /// Carries a tangential quantity of a contact along with the contact: turned by `twist`
    /// about the (new) normal, cut to the tangent plane, its length kept. In the plane there
    /// is one tangent only and nothing to do.
    fn follow(spring: Self::Spin, normal: Self::Vec, twist: f64) -> Self::Spin;
    /// Where a unit normal was a short `time` \[s\] ago when it turns at this rate \[1/s\] (of which the part
    /// along the normal does not count), to the second order.
    #[inline(always)]
    fn normal_before(normal: Self::Vec, rate: impl FnOnce() -> Self::Vec, time: f64) -> Self::Vec {
        let rate = rate();
        normal - (rate - normal * rate.dot(normal)) * time
    }
    /// Rate of turning about the normal; zero in the plane.
    fn twist(spin: Self::Spin, normal: Self::Vec) -> f64;
    /// The spin or torque of this size about the normal; zero in the plane.
    fn about(normal: Self::Vec, size: f64) -> Self::Spin;
    /// Shows vectors to an output.
    fn vector_field(values: &[Self::Vec]) -> FieldRef<'_>;
    /// Shows spins to an output.
    fn spin_field(values: &[Self::Spin]) -> FieldRef<'_>;
}

/// The plane; everything is per metre of depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct D2;

/// The space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct D3;

impl Linear for f64 {
    const ZERO: Self = 0.0;
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        self * other
    }
    #[inline(always)]
    fn length(self) -> f64 {
        self.abs()
    }
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Spin for f64 {
    fn about_z(rate: f64) -> Self {
        rate
    }
    #[inline(always)]
    fn z(self) -> f64 {
        self
    }
    fn of_components([_, _, z]: [f64; 3]) -> Self {
        z
    }
    fn components(self) -> [f64; 3] {
        [0.0, 0.0, self]
    }
}

impl Spin for DVec3 {
    fn about_z(rate: f64) -> Self {
        DVec3::new(0.0, 0.0, rate)
    }
    #[inline(always)]
    fn z(self) -> f64 {
        self.z
    }
    fn of_components(components: [f64; 3]) -> Self {
        components.into()
    }
    fn components(self) -> [f64; 3] {
        self.into()
    }
}

macro_rules! implement_vector {
    ($vector:ty, $n:literal, |$v:ident| $padded:expr) => {
        impl Linear for $vector {
            const ZERO: Self = <$vector>::ZERO;
            #[inline(always)]
            fn dot(self, other: Self) -> f64 {
                <$vector>::dot(self, other)
            }
            fn is_finite(self) -> bool {
                <$vector>::is_finite(self)
            }
        }

        impl Vector for $vector {
            #[inline(always)]
            fn along(axis: usize, length: f64) -> Self {
                let mut vector = Self::ZERO;
                vector[axis] = length;
                vector
            }
            #[inline(always)]
            fn from_fn(mut component: impl FnMut(usize) -> f64) -> Self {
                let mut components = [0.0; $n];
                for (axis, value) in components.iter_mut().enumerate() {
                    *value = component(axis);
                }
                Self::from_array(components)
            }
            #[inline(always)]
            fn splat(length: f64) -> Self {
                <$vector>::splat(length)
            }
            #[inline(always)]
            fn component(self, axis: usize) -> f64 {
                self[axis]
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                <$vector>::min(self, other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                <$vector>::max(self, other)
            }
            fn from_slice(components: &[f64]) -> Option<Self> {
                (components.len() == $n).then(|| <$vector>::from_slice(components))
            }
            fn padded(self) -> [f64; 3] {
                let $v = self;
                $padded
            }
        }
    };
}

implement_vector!(DVec2, 2, |v| [v.x, v.y, 0.0]);
implement_vector!(DVec3, 3, |v| [v.x, v.y, v.z]);

impl Dim for D2 {
    const N: usize = 2;
    const AXES: &'static [&'static str] = &["x", "y"];
    const UP: usize = 1;
    const BALL_INERTIA: f64 = 0.5;
    const TWISTS: bool = false;
    const BALL: &'static str = "disk";
    type Vec = DVec2;
    type Spin = f64;

    #[inline(always)]
    fn ball_volume(radius: f64) -> f64 {
        PI * radius * radius
    }
    fn ball_below(radius: f64, corner: DVec2) -> f64 {
        crate::ball::disk_below(radius, corner.x, corner.y)
    }
    fn ball_in_box(radius: f64, low: DVec2, high: DVec2) -> f64 {
        crate::ball::disk_in_box(radius, low.to_array(), high.to_array())
    }
    #[inline(always)]
    fn cross(a: DVec2, b: DVec2) -> f64 {
        a.x * b.y - a.y * b.x
    }
    #[inline(always)]
    fn turn(spin: f64, arm: DVec2) -> DVec2 {
        DVec2::new(-spin * arm.y, spin * arm.x)
    }
    #[inline(always)]
    fn rotation_after(first: f64, then: f64) -> f64 {
        first + then
    }
    #[inline(always)]
    fn tangential(spin: f64, _normal: DVec2) -> f64 {
        spin
    }
    #[inline(always)]
    fn follow(spring: f64, _normal: DVec2, _twist: f64) -> f64 {
        spring
    }
    #[inline(always)]
    fn twist(_spin: f64, _normal: DVec2) -> f64 {
        0.0
    }
    #[inline(always)]
    fn about(_normal: DVec2, _size: f64) -> f64 {
        0.0
    }
    fn vector_field(values: &[DVec2]) -> FieldRef<'_> {
        FieldRef::Vector2(values)
    }
    fn spin_field(values: &[f64]) -> FieldRef<'_> {
        FieldRef::Scalar(values)
    }
}

impl Dim for D3 {
    const N: usize = 3;
    const AXES: &'static [&'static str] = &["x", "y", "z"];
    const UP: usize = 2;
    const BALL_INERTIA: f64 = 0.4;
    const TWISTS: bool = true;
    const BALL: &'static str = "sphere";
    type Vec = DVec3;
    type Spin = DVec3;

    #[inline(always)]
    fn ball_volume(radius: f64) -> f64 {
        4.0 / 3.0 * PI * radius * radius * radius
    }
    fn ball_below(radius: f64, corner: DVec3) -> f64 {
        crate::ball::sphere_below(radius, corner.to_array())
    }
    fn ball_in_box(radius: f64, low: DVec3, high: DVec3) -> f64 {
        crate::ball::sphere_in_box(radius, low.to_array(), high.to_array())
    }
    #[inline(always)]
    fn cross(a: DVec3, b: DVec3) -> DVec3 {
        a.cross(b)
    }
    #[inline(always)]
    fn turn(spin: DVec3, arm: DVec3) -> DVec3 {
        spin.cross(arm)
    }
    fn rotation_after(first: DVec3, then: DVec3) -> DVec3 {
        let product = DQuat::from_scaled_axis(then) * DQuat::from_scaled_axis(first);
        // Of the two that turn alike, the one with the smaller angle.
        let (axis, cosine) = (product.xyz() * product.w.signum(), product.w.abs());
        let sine = axis.length();
        if sine == 0.0 { DVec3::ZERO } else { axis * (2.0 * sine.atan2(cosine) / sine) }
    }
    #[inline(always)]
    fn tangential(spin: DVec3, normal: DVec3) -> DVec3 {
        spin - normal * spin.dot(normal)
    }
    #[inline(always)]
    fn follow(spring: DVec3, normal: DVec3, twist: f64) -> DVec3 {
        let squared = spring.length_squared();
        if squared == 0.0 {
            return DVec3::ZERO;
        }
        let turned = spring + normal.cross(spring) * twist;
        let flat = turned - normal * turned.dot(normal);
        let flat_squared = flat.length_squared();
        // Compared so that what is not a number stays so instead of becoming zero.
        if flat_squared == 0.0 { DVec3::ZERO } else { flat * (squared / flat_squared).sqrt() }
    }
    #[inline(always)]
    fn twist(spin: DVec3, normal: DVec3) -> f64 {
        spin.dot(normal)
    }
    #[inline(always)]
    fn about(normal: DVec3, size: f64) -> DVec3 {
        normal * size
    }
    fn vector_field(values: &[DVec3]) -> FieldRef<'_> {
        FieldRef::Vector3(values)
    }
    fn spin_field(values: &[DVec3]) -> FieldRef<'_> {
        FieldRef::Vector3(values)
    }
}

#[cfg(test)]
mod tests;
