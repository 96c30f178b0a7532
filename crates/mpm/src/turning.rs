//! How a stress turns with its material in a step, and gradients as laws want them.

use granular_constitutive::rotation::{hughes_winget, jaumann};
use granular_constitutive::{Axes, InPlane, InSpace};
use granular_core::SymmetricTensor;
use granular_core::glam::{DMat2, DMat3, DVec2, DVec3};

/// Makes and measures gradients of displacement.
pub(crate) trait Gradients: Axes {
    /// By its components in row and column.
    fn gradient(component: impl Fn(usize, usize) -> f64) -> Self::Gradient;
    /// Volume after the displacement over that before.
    fn stretch(gradient: Self::Gradient) -> f64;
}

impl Gradients for InPlane {
    #[inline(always)]
    fn gradient(at: impl Fn(usize, usize) -> f64) -> DMat2 {
        DMat2::from_cols(DVec2::new(at(0, 0), at(1, 0)), DVec2::new(at(0, 1), at(1, 1)))
    }

    #[inline(always)]
    fn stretch(DMat2 { x_axis: x, y_axis: y }: DMat2) -> f64 {
        (1.0 + x.x) * (1.0 + y.y) - x.y * y.x
    }
}

impl Gradients for InSpace {
    #[inline(always)]
    fn gradient(at: impl Fn(usize, usize) -> f64) -> DMat3 {
        let column = |k: usize| DVec3::new(at(0, k), at(1, k), at(2, k));
        DMat3::from_cols(column(0), column(1), column(2))
    }

    #[inline(always)]
    fn stretch(DMat3 { x_axis: x, y_axis: y, z_axis: z }: DMat3) -> f64 {
        (1.0 + x.x) * ((1.0 + y.y) * (1.0 + z.z) - y.z * z.y) - y.x * (x.y * (1.0 + z.z) - x.z * z.y)
            + z.x * (x.y * y.z - x.z * (1.0 + y.y))
    }
}

/// An objective update.
pub(crate) trait Turning: Copy + Send + Sync + 'static {
    fn turned<A: Axes>(stress: SymmetricTensor, gradient: A::Gradient) -> SymmetricTensor;
}

/// By a rotation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByRotation;

impl Turning for ByRotation {
    #[inline(always)]
    fn turned<A: Axes>(stress: SymmetricTensor, gradient: A::Gradient) -> SymmetricTensor {
        hughes_winget::<A>(stress, gradient)
    }
}

/// By the rate of Jaumann.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByRate;

impl Turning for ByRate {
    #[inline(always)]
    fn turned<A: Axes>(stress: SymmetricTensor, gradient: A::Gradient) -> SymmetricTensor {
        jaumann::<A>(stress, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_determinants() {
        let at =
            |row: usize, column: usize| [[0.2, -0.4, 0.1], [0.3, -0.1, 0.7], [0.5, 0.6, 0.25]][row][column];
        let whole = DMat3::IDENTITY + InSpace::gradient(at);
        assert!((InSpace::stretch(InSpace::gradient(at)) - whole.determinant()).abs() < 1e-15);
        let flat = DMat2::IDENTITY + InPlane::gradient(at);
        assert!((InPlane::stretch(InPlane::gradient(at)) - flat.determinant()).abs() < 1e-15);
    }
}
