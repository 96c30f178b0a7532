//! Shapes that are bodies too, and bodies that have a shape.

use super::{Ball, Block, ShapeError, SolidShape};
use crate::dim::{Dim, Linear, Vector};
use crate::shape::Shape;

/// A half-space behind a plane, a block, or balls. Other shapes are surfaces without an inside, which
/// [`SolidShape::check`] refuses.
impl<D: Dim> SolidShape<D> for Shape<D> {
    fn check(&self) -> Result<(), ShapeError> {
        let name = match self {
            Self::Plane { point, normal } => {
                let fits = point.is_finite() && (normal.length() - 1.0).abs() < 1e-9;
                let value = format!("through {point:?} m with the normal {normal:?}");
                let error = || ShapeError::new("plane", value, "a finite point and a unit normal");
                return if fits { Ok(()) } else { Err(error()) };
            }
            Self::Block { low, high } => return Block::<D> { low: *low, high: *high }.check(),
            Self::Facets(facets) if facets.are_balls() => return Ok(()),
            Self::Facets(_) => "a chain or mesh",
            Self::Segment { .. } => "a segment",
            Self::Tube { .. } => "a tube",
            Self::Circle { .. } => "a circle, which is a surface",
        };
        Err(ShapeError::new(
            "shape",
            name.to_owned(),
            "one with an inside: a plane, a block or balls; a full disk is a `Ball`",
        ))
    }

    fn contains(&self, point: D::Vec) -> bool {
        match self {
            Self::Block { low, high } => Block::<D> { low: *low, high: *high }.contains(point),
            _ => SolidShape::distance(self, point).is_some_and(|(distance, _)| distance <= 0.0),
        }
    }

    fn bounds(&self) -> (D::Vec, D::Vec) {
        let endless = D::Vec::splat(f64::INFINITY);
        Self::bounds(self).unwrap_or((-endless, endless))
    }

    fn centre(&self) -> D::Vec {
        self.reference()
    }

    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        match self {
            Self::Block { low, high } => Block::<D> { low: *low, high: *high }.distance(point),
            Self::Plane { .. } => Some(Self::distance(self, point)),
            Self::Facets(facets) if facets.are_balls() => Some(facets.distance(point)),
            _ => None,
        }
    }

    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        match self {
            Self::Plane { point, normal } => {
                let height = (outside - *point).dot(*normal);
                (height / (outside - inside).dot(*normal)).clamp(f64::MIN_POSITIVE, 1.0)
            }
            Self::Block { low, high } => Block::<D> { low: *low, high: *high }.crossing(outside, inside),
            _ => super::by_halving(|at| self.contains(outside + (inside - outside) * at)),
        }
    }
}

impl<D: Dim> From<Ball<D>> for Shape<D> {
    /// The surface of a ball.
    fn from(ball: Ball<D>) -> Self {
        Self::Circle { centre: ball.centre, radius: ball.radius }
    }
}

impl<D: Dim> From<Block<D>> for Shape<D> {
    fn from(block: Block<D>) -> Self {
        Self::Block { low: block.low, high: block.high }
    }
}
