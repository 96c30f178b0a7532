//! Bodies that surround what is inside.

use super::{ShapeError, SolidShape};
use crate::dim::{Dim, Vector};

/// The body that fills all space outside of a shape, whose inside is left free: a tank, a pipe (with
/// [`Extruded`](super::Extruded)), or with a second obstacle within it an annulus.
///
/// It has no end, so it has no images through periodic faces: the shape lies in the domain, or crosses it along
/// the axes that are periodic, as a pipe does. Walls of a fluid that lie outside of the hole do nothing.
///
/// ```
/// use granular_core::{D2, glam::DVec2};
/// use granular_core::shape::{Ball, Hole, SolidShape};
///
/// let tank = Hole(Ball::<D2> { centre: DVec2::ZERO, radius: 1.0 });
/// assert!(!tank.contains(DVec2::ZERO) && tank.contains(DVec2::new(1.1, 0.0)));
/// // The surface is met from within.
/// assert!((tank.crossing(DVec2::ZERO, DVec2::new(2.0, 0.0)) - 0.5).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Hole<S>(pub S);

impl<D: Dim, S: SolidShape<D>> SolidShape<D> for Hole<S> {
    fn contains(&self, point: D::Vec) -> bool {
        !self.0.contains(point)
    }

    fn check(&self) -> Result<(), ShapeError> {
        self.0.check()
    }

    /// Without end.
    fn bounds(&self) -> (D::Vec, D::Vec) {
        let end = |length| D::Vec::from_slice(&[length; 3][..D::N]).expect("one component per axis");
        (end(f64::NEG_INFINITY), end(f64::INFINITY))
    }

    fn centre(&self) -> D::Vec {
        self.0.centre()
    }

    fn reach(&self) -> f64 {
        self.0.reach()
    }

    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        self.0.distance(point).map(|(distance, normal)| (-distance, -normal))
    }

    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        (1.0 - self.0.crossing(inside, outside)).clamp(f64::MIN_POSITIVE, 1.0)
    }
}
