//! Shapes: surfaces that are touched, and [solid shapes](solid) that fill space. They know no solver: grains, continua and
//! fluids meet the same ones.
//!
//! | | is | asks |
//! |---|---|---|
//! | [`Shape`] | a surface without or with an inside: planes, segments, blocks, tubes, circles, meshes | distance and normal |
//! | [`SolidShape`] | what fills space: balls, blocks, polygons, prisms, images | what it contains, where a ray enters it |
//!
//! A [`Shape`] with an inside (a half-space, a block, balls) is a [`SolidShape`] too, and a [`Ball`] or [`Block`] has a [`Shape`].

mod facets;
pub mod solid;

pub use facets::Facets;
pub use solid::{Ball, Block, Extruded, Hole, Polygon, ShapeError, SolidShape};

use crate::dim::{Dim, Linear, Vector};
use crate::setup_error::SetupError;
use std::sync::Arc;

/// A surface that bodies touch.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape<D: Dim> {
    /// A half-space: grains are on the side to which the normal points.
    Plane {
        /// A point on the plane \[m\].
        point: D::Vec,
        /// Unit normal.
        normal: D::Vec,
    },
    /// A straight line between two points, touched from both sides and at its ends; in space a
    /// thin rod.
    Segment {
        /// One end \[m\].
        from: D::Vec,
        /// Other end \[m\].
        to: D::Vec,
    },
    /// A solid block with edges along the axes, touched from outside. With no extent along one
    /// axis it is a plate.
    Block {
        /// Lower corner \[m\].
        low: D::Vec,
        /// Upper corner \[m\].
        high: D::Vec,
    },
    /// The curved surface of a cylinder, open at both ends, touched from both sides and at its rims; in the
    /// plane two parallel segments.
    Tube {
        /// Middle of one end \[m\].
        from: D::Vec,
        /// Middle of the other end \[m\].
        to: D::Vec,
        /// Radius \[m\].
        radius: f64,
    },
    /// A circle, touched from inside and outside: a drum in the plane; in space the shell of a sphere.
    Circle {
        /// Centre \[m\].
        centre: D::Vec,
        /// Radius \[m\].
        radius: f64,
    },
    /// A surface of many parts, touched from both sides: a chain of segments, a mesh of triangles, or
    /// grains that are held.
    Facets(Arc<Facets<D>>),
}

impl<D: Dim> Shape<D> {
    /// Distance of a point from the surface \[m\] and the unit normal from the surface to the
    /// point. Inside a block the distance is zero and there is no direction; nor is there one on the axis of a tube or in
    /// the centre of a circle.
    #[inline]
    pub fn distance(&self, point: D::Vec) -> (f64, D::Vec) {
        let nearest = match *self {
            Self::Plane { point: on, normal } => return ((point - on).dot(normal), normal),
            Self::Facets(ref facets) => return facets.distance(point),
            Self::Segment { from, to } => {
                let along = to - from;
                let share = (point - from).dot(along) / along.length_squared();
                from + along * share.clamp(0.0, 1.0)
            }
            Self::Block { low, high } => point.max(low).min(high),
            Self::Circle { centre, radius } => {
                let arm = point - centre;
                let reach = arm.length();
                if reach == 0.0 {
                    return (radius, D::Vec::ZERO);
                }
                centre + arm * (radius / reach)
            }
            Self::Tube { from, to, radius } => {
                let along = to - from;
                let share = (point - from).dot(along) / along.length_squared();
                let across = point - from - along * share;
                let (reach, beyond) = (across.length(), share - share.clamp(0.0, 1.0));
                if reach == 0.0 {
                    return (radius.hypot(beyond * along.length()), D::Vec::ZERO);
                }
                point - along * beyond - across * (1.0 - radius / reach)
            }
        };
        let arm = point - nearest;
        let distance = arm.length();
        if distance > 0.0 { (distance, arm * (1.0 / distance)) } else { (0.0, D::Vec::ZERO) }
    }
}

impl<D: Dim> Shape<D> {
    /// Corners of a box \[m\] around the shape where it was given; none for a plane, which has no end.
    pub fn bounds(&self) -> Option<(D::Vec, D::Vec)> {
        match *self {
            Self::Plane { .. } => None,
            Self::Segment { from, to } => Some((from.min(to), from.max(to))),
            Self::Block { low, high } => Some((low, high)),
            Self::Tube { from, to, radius } => {
                // Across its axis a tube reaches as far as the axis is not along.
                let axis = (to - from) * (1.0 / (to - from).length());
                let across =
                    |k: usize| D::Vec::along(k, radius * (1.0 - axis.component(k).powi(2)).max(0.0).sqrt());
                let reach = (0..D::N).fold(D::Vec::ZERO, |sum, k| sum + across(k));
                Some((from.min(to) - reach, from.max(to) + reach))
            }
            Self::Circle { centre, radius } => {
                Some((centre - D::Vec::splat(radius), centre + D::Vec::splat(radius)))
            }
            Self::Facets(ref facets) => Some(facets.bounds()),
        }
    }

    /// The point \[m\] by which its place is told, where it was given: that of a plane, else the middle of its bounds.
    pub fn reference(&self) -> D::Vec {
        match (self, self.bounds()) {
            (Self::Plane { point, .. }, _) => *point,
            (_, Some((low, high))) => (low + high) * 0.5,
            (_, None) => D::Vec::ZERO,
        }
    }
}

impl<D: Dim> Shape<D> {
    /// A plane through `point` \[m\]; bodies are on the side to which `normal` points (any length).
    ///
    /// # Errors
    /// When the normal has no direction.
    pub fn plane(point: D::Vec, normal: D::Vec) -> Result<Self, SetupError> {
        let length = normal.length();
        if !(length.is_finite() && length > 0.0 && point.is_finite()) {
            return Err(SetupError::new("normal", length, "a finite direction"));
        }
        Ok(Self::Plane { point, normal: normal * (1.0 / length) })
    }

    /// A segment between two points \[m\].
    ///
    /// # Errors
    /// When the points coincide or are not finite.
    pub fn segment(from: D::Vec, to: D::Vec) -> Result<Self, SetupError> {
        let length = (to - from).length();
        if !(length.is_finite() && length > 0.0) {
            return Err(SetupError::new("length", length, "positive and finite"));
        }
        Ok(Self::Segment { from, to })
    }

    /// A solid block between two corners \[m\].
    ///
    /// # Errors
    /// When the upper corner is below the lower one, or a corner is not finite.
    pub fn block(low: D::Vec, high: D::Vec) -> Result<Self, SetupError> {
        let extent = (0..D::N).map(|axis| (high - low).component(axis)).fold(f64::INFINITY, f64::min);
        if !(extent >= 0.0 && low.is_finite() && high.is_finite()) {
            return Err(SetupError::new("extent", extent, "zero or more, and finite"));
        }
        Ok(Self::Block { low, high })
    }

    /// The curved surface of a cylinder between the middles of its ends \[m\], with a radius \[m\].
    ///
    /// # Errors
    /// When the ends coincide, the radius is not positive, or something is not finite.
    pub fn tube(from: D::Vec, to: D::Vec, radius: f64) -> Result<Self, SetupError> {
        for (what, value) in [("length", (to - from).length()), ("radius", radius)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(SetupError::new(what, value, "positive and finite"));
            }
        }
        Ok(Self::Tube { from, to, radius })
    }

    /// A circle about a centre \[m\] with a radius \[m\]; in space the shell of a sphere.
    ///
    /// # Errors
    /// When the centre is not finite or the radius not positive.
    pub fn circle(centre: D::Vec, radius: f64) -> Result<Self, SetupError> {
        if !(radius.is_finite() && radius > 0.0 && centre.is_finite()) {
            return Err(SetupError::new("radius", radius, "positive and finite, about a finite centre"));
        }
        Ok(Self::Circle { centre, radius })
    }

    /// A chain of segments through some points \[m\]; `closed` joins the last point to the first.
    ///
    /// # Errors
    /// When there are fewer than two points, one is not finite, or two neighbours coincide.
    pub fn chain(points: &[D::Vec], closed: bool) -> Result<Self, SetupError> {
        let closing = if closed { points.first().zip(points.last()) } else { None };
        let segments = points.windows(2).map(|pair| [pair[0], pair[1]]);
        let corners: Vec<D::Vec> =
            segments.chain(closing.map(|(&first, &last)| [last, first])).flatten().collect();
        Ok(Self::Facets(Arc::new(Facets::new(corners, 2)?)))
    }

    /// A mesh of triangles, three corners \[m\] each. It need not be closed and its triangles need not share corners.
    /// (In the plane a triangle is a filled one.)
    ///
    /// # Errors
    /// When there is no triangle, corners are left over, one is not finite, or those of a triangle coincide.
    pub fn triangles(corners: Vec<D::Vec>) -> Result<Self, SetupError> {
        Ok(Self::Facets(Arc::new(Facets::new(corners, 3)?)))
    }

    /// Balls in fixed places: centre \[m\] and radius \[m\] of each.
    ///
    /// # Errors
    /// When there is none, or one has no finite centre and positive radius.
    pub fn balls(balls: &[(D::Vec, f64)]) -> Result<Self, SetupError> {
        Ok(Self::Facets(Arc::new(Facets::balls(balls)?)))
    }

    /// Number of parts of which it is made: one, but for facets.
    pub fn parts(&self) -> usize {
        match self {
            Self::Facets(facets) => facets.len(),
            _ => 1,
        }
    }
}

/// All corners of a box, from its lowest and highest one.
pub fn corners<D: Dim>(low: D::Vec, high: D::Vec) -> impl Iterator<Item = D::Vec> {
    (0..1 << D::N).map(move |corner| {
        let of = |axis: usize| if corner >> axis & 1 == 0 { low } else { high };
        (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, of(axis).component(axis)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{D2, D3};
    use glam::{DVec2, DVec3};

    #[test]
    fn distances_follow_the_nearest_point() {
        let segment = Shape::<D2>::segment(DVec2::ZERO, DVec2::X).unwrap();
        assert_eq!(segment.distance(DVec2::new(0.3, -2.0)), (2.0, -DVec2::Y));
        assert_eq!(segment.distance(DVec2::new(4.0, 4.0)).0, 5.0);
        let block = Shape::<D2>::block(DVec2::ZERO, DVec2::ONE).unwrap();
        assert_eq!(block.distance(DVec2::new(1.5, 0.5)), (0.5, DVec2::X));
        let plane = Shape::<D2>::plane(DVec2::ZERO, DVec2::new(0.0, 7.0)).unwrap();
        assert_eq!(plane.distance(DVec2::new(3.0, -0.5)), (-0.5, DVec2::Y));
        assert!(Shape::<D2>::plane(DVec2::ZERO, DVec2::ZERO).is_err());
        assert!(Shape::<D2>::block(DVec2::ONE, DVec2::ZERO).is_err());
    }

    #[test]
    fn a_circle_is_touched_inside_and_outside() {
        let drum = Shape::<D2>::circle(DVec2::new(1.0, 2.0), 3.0).unwrap();
        assert_eq!(drum.distance(DVec2::new(3.5, 2.0)), (0.5, -DVec2::X));
        assert_eq!(drum.distance(DVec2::new(1.0, 6.0)), (1.0, DVec2::Y));
        assert_eq!(drum.distance(DVec2::new(1.0, 2.0)), (3.0, DVec2::ZERO));
        assert_eq!(drum.bounds(), Some((DVec2::new(-2.0, -1.0), DVec2::new(4.0, 5.0))));
        let shell = Shape::<D3>::circle(DVec3::ZERO, 1.0).unwrap();
        assert_eq!(shell.distance(DVec3::new(0.0, 0.0, -0.75)), (0.25, DVec3::Z));
        assert!(Shape::<D2>::circle(DVec2::ZERO, 0.0).is_err());
        assert!(Shape::<D2>::circle(DVec2::NAN, 1.0).is_err());
    }

    #[test]
    fn bounds_hold_the_whole_shape() {
        let tube = Shape::<D3>::tube(DVec3::ZERO, DVec3::X * 4.0, 2.0).unwrap();
        assert_eq!(tube.bounds(), Some((DVec3::new(0.0, -2.0, -2.0), DVec3::new(4.0, 2.0, 2.0))));
        assert_eq!(tube.reference(), DVec3::X * 2.0);
        let chain = [DVec2::new(1.0, 5.0), DVec2::new(-1.0, 0.0), DVec2::new(0.0, 2.0)];
        let chain = Shape::<D2>::chain(&chain, false).unwrap();
        assert_eq!(chain.bounds(), Some((DVec2::new(-1.0, 0.0), DVec2::new(1.0, 5.0))));
        let held = Shape::<D2>::balls(&[(DVec2::ONE, 0.5)]).unwrap();
        assert_eq!(held.bounds(), Some((DVec2::splat(0.5), DVec2::splat(1.5))));
        let plane = Shape::<D2>::plane(DVec2::ONE, DVec2::Y).unwrap();
        assert_eq!((plane.bounds(), plane.reference()), (None, DVec2::ONE));
    }

    #[test]
    fn a_tube_is_touched_inside_outside_and_at_its_rims() {
        let (from, to) = (DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 4.0));
        let tube = Shape::<D3>::tube(from, to, 2.0).unwrap();
        let near = |at: [f64; 3], distance: f64, normal: [f64; 3]| {
            let (found, direction) = tube.distance(at.into());
            assert!((found - distance).abs() < 1e-14, "{at:?}: {found}");
            assert!((direction - DVec3::from(normal)).length() < 1e-14, "{at:?}: {direction}");
        };
        near([2.5, 1.0, 1.0], 0.5, [-1.0, 0.0, 0.0]);
        near([1.0, 3.25, 3.0], 0.25, [0.0, 1.0, 0.0]);
        // Below the lower rim, and beyond the upper one.
        near([3.0, 1.0, -0.5], 0.5, [0.0, 0.0, -1.0]);
        near([3.3, 1.0, 4.4], 0.5, [0.6, 0.0, 0.8]);
        near([1.0, 1.0, 2.0], 2.0, [0.0; 3]);
        assert!(Shape::<D3>::tube(from, from, 2.0).is_err());
        assert!(Shape::<D3>::tube(from, to, 0.0).is_err());
    }
}
