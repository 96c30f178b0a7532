//! Walls: planes, segments and boxes, each with its own material.

use crate::facets::Facets;
use crate::material::{MaterialId, SetupError};
use crate::moving::WallMotion;
use granular_core::{Dim, Linear, Vector};
use std::sync::Arc;

/// The surface of a wall.
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

/// A wall, at rest unless it has a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall<D: Dim> {
    /// Name, unique in a scene.
    pub name: String,
    /// Surface.
    pub shape: Shape<D>,
    /// Material.
    pub material: MaterialId,
    /// Whether it is open, as a gate may be: grains then pass through it.
    pub open: bool,
    /// How it moves; the shape is where it begins.
    pub motion: Option<WallMotion<D>>,
    /// Whether a moving wall waits where it is until [`Dem::set_moving`](crate::Dem::set_moving).
    pub held: bool,
}

impl<D: Dim> Wall<D> {
    /// A plane through `point` \[m\]; grains are on the side to which `normal` points (any length).
    ///
    /// # Errors
    /// When the normal has no direction.
    pub fn plane(
        name: &str,
        point: D::Vec,
        normal: D::Vec,
        material: MaterialId,
    ) -> Result<Self, SetupError> {
        let length = normal.length();
        if !(length.is_finite() && length > 0.0 && point.is_finite()) {
            return Err(SetupError::new(format!("normal of wall `{name}`"), length, "a finite direction"));
        }
        Ok(Self::of(name, Shape::Plane { point, normal: normal * (1.0 / length) }, material))
    }

    /// A segment between two points \[m\].
    ///
    /// # Errors
    /// When the points coincide or are not finite.
    pub fn segment(name: &str, from: D::Vec, to: D::Vec, material: MaterialId) -> Result<Self, SetupError> {
        let length = (to - from).length();
        if !(length.is_finite() && length > 0.0) {
            return Err(SetupError::new(format!("length of wall `{name}`"), length, "positive and finite"));
        }
        Ok(Self::of(name, Shape::Segment { from, to }, material))
    }

    /// A solid block between two corners \[m\].
    ///
    /// # Errors
    /// When the upper corner is below the lower one, or a corner is not finite.
    pub fn block(name: &str, low: D::Vec, high: D::Vec, material: MaterialId) -> Result<Self, SetupError> {
        let extent = (0..D::N).map(|axis| (high - low).component(axis)).fold(f64::INFINITY, f64::min);
        if !(extent >= 0.0 && low.is_finite() && high.is_finite()) {
            return Err(SetupError::new(
                format!("extent of wall `{name}`"),
                extent,
                "zero or more, and finite",
            ));
        }
        Ok(Self::of(name, Shape::Block { low, high }, material))
    }

    /// The curved surface of a cylinder between the middles of its ends \[m\], with a radius \[m\]; open at both ends
    /// and touched from both sides.
    ///
    /// # Errors
    /// When the ends coincide, the radius is not positive, or something is not finite.
    pub fn tube(
        name: &str,
        from: D::Vec,
        to: D::Vec,
        radius: f64,
        material: MaterialId,
    ) -> Result<Self, SetupError> {
        for (what, value) in [("length", (to - from).length()), ("radius", radius)] {
            if !(value.is_finite() && value > 0.0) {
                let what = format!("{what} of wall `{name}`");
                return Err(SetupError::new(what, value, "positive and finite"));
            }
        }
        Ok(Self::of(name, Shape::Tube { from, to, radius }, material))
    }

    /// A circle about a centre \[m\] with a radius \[m\], touched from inside and outside; in space the shell of a sphere.
    ///
    /// # Errors
    /// When the centre is not finite or the radius not positive.
    pub fn circle(name: &str, centre: D::Vec, radius: f64, material: MaterialId) -> Result<Self, SetupError> {
        if !(radius.is_finite() && radius > 0.0 && centre.is_finite()) {
            let what = format!("radius of wall `{name}`");
            return Err(SetupError::new(what, radius, "positive and finite, about a finite centre"));
        }
        Ok(Self::of(name, Shape::Circle { centre, radius }, material))
    }

    /// A chain of segments through some points \[m\], touched from both sides and at its ends; `closed` joins the
    /// last point to the first.
    ///
    /// # Errors
    /// When there are fewer than two points, one is not finite, or two neighbours coincide.
    pub fn chain(
        name: &str,
        points: &[D::Vec],
        closed: bool,
        material: MaterialId,
    ) -> Result<Self, SetupError> {
        let closing = if closed { points.first().zip(points.last()) } else { None };
        let segments = points.windows(2).map(|pair| [pair[0], pair[1]]);
        let corners: Vec<D::Vec> =
            segments.chain(closing.map(|(&first, &last)| [last, first])).flatten().collect();
        let facets = Facets::new(name, corners, 2)?;
        Ok(Self::of(name, Shape::Facets(Arc::new(facets)), material))
    }

    /// A mesh of triangles, three corners \[m\] each, touched from both sides, at its faces, edges and corners. It
    /// need not be closed and its triangles need not share corners. (In the plane a triangle is a filled one.)
    ///
    /// # Errors
    /// When there is no triangle, corners are left over, one is not finite, or those of a triangle coincide.
    pub fn triangles(name: &str, corners: Vec<D::Vec>, material: MaterialId) -> Result<Self, SetupError> {
        if !corners.len().is_multiple_of(3) {
            let what = format!("number of corners of wall `{name}`");
            return Err(SetupError::new(what, corners.len() as f64, "three for each triangle"));
        }
        let facets = Facets::new(name, corners, 3)?;
        Ok(Self::of(name, Shape::Facets(Arc::new(facets)), material))
    }

    /// A wall of grains that are held: centre \[m\] and radius \[m\] of each. They are not integrated; like any
    /// wall they may move all together.
    ///
    /// # Errors
    /// When there is none, or one has no finite position and positive radius.
    pub fn held_grains(
        name: &str,
        grains: &[(D::Vec, f64)],
        material: MaterialId,
    ) -> Result<Self, SetupError> {
        let facets = Facets::balls(name, grains)?;
        Ok(Self::of(name, Shape::Facets(Arc::new(facets)), material))
    }

    /// The same wall with a motion; its shape is where it begins.
    pub fn moving(self, motion: WallMotion<D>) -> Self {
        Self { motion: Some(motion), ..self }
    }

    fn of(name: &str, shape: Shape<D>, material: MaterialId) -> Self {
        Self { name: name.to_owned(), shape, material, open: false, motion: None, held: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    #[test]
    fn distances_follow_the_nearest_point() {
        let material = MaterialId(0);
        let segment = Wall::<D2>::segment("s", DVec2::ZERO, DVec2::X, material).unwrap();
        assert_eq!(segment.shape.distance(DVec2::new(0.3, -2.0)), (2.0, -DVec2::Y));
        assert_eq!(segment.shape.distance(DVec2::new(4.0, 4.0)).0, 5.0);
        let block = Wall::<D2>::block("b", DVec2::ZERO, DVec2::ONE, material).unwrap();
        assert_eq!(block.shape.distance(DVec2::new(1.5, 0.5)), (0.5, DVec2::X));
        let plane = Wall::<D2>::plane("p", DVec2::ZERO, DVec2::new(0.0, 7.0), material).unwrap();
        assert_eq!(plane.shape.distance(DVec2::new(3.0, -0.5)), (-0.5, DVec2::Y));
        assert!(Wall::<D2>::plane("p", DVec2::ZERO, DVec2::ZERO, material).is_err());
        assert!(Wall::<D2>::block("b", DVec2::ONE, DVec2::ZERO, material).is_err());
    }

    #[test]
    fn a_circle_is_touched_inside_and_outside() {
        let drum = Wall::<D2>::circle("drum", DVec2::new(1.0, 2.0), 3.0, MaterialId(0)).unwrap().shape;
        assert_eq!(drum.distance(DVec2::new(3.5, 2.0)), (0.5, -DVec2::X));
        assert_eq!(drum.distance(DVec2::new(1.0, 6.0)), (1.0, DVec2::Y));
        assert_eq!(drum.distance(DVec2::new(1.0, 2.0)), (3.0, DVec2::ZERO));
        assert_eq!(drum.bounds(), Some((DVec2::new(-2.0, -1.0), DVec2::new(4.0, 5.0))));
        let shell = Wall::<D3>::circle("s", DVec3::ZERO, 1.0, MaterialId(0)).unwrap().shape;
        assert_eq!(shell.distance(DVec3::new(0.0, 0.0, -0.75)), (0.25, DVec3::Z));
        assert!(Wall::<D2>::circle("s", DVec2::ZERO, 0.0, MaterialId(0)).is_err());
        assert!(Wall::<D2>::circle("s", DVec2::NAN, 1.0, MaterialId(0)).is_err());
    }

    #[test]
    fn bounds_hold_the_whole_shape() {
        let tube = Wall::<D3>::tube("t", DVec3::ZERO, DVec3::X * 4.0, 2.0, MaterialId(0)).unwrap().shape;
        assert_eq!(tube.bounds(), Some((DVec3::new(0.0, -2.0, -2.0), DVec3::new(4.0, 2.0, 2.0))));
        assert_eq!(tube.reference(), DVec3::X * 2.0);
        let chain = [DVec2::new(1.0, 5.0), DVec2::new(-1.0, 0.0), DVec2::new(0.0, 2.0)];
        let chain = Wall::<D2>::chain("c", &chain, false, MaterialId(0)).unwrap().shape;
        assert_eq!(chain.bounds(), Some((DVec2::new(-1.0, 0.0), DVec2::new(1.0, 5.0))));
        let held = Wall::<D2>::held_grains("h", &[(DVec2::ONE, 0.5)], MaterialId(0)).unwrap().shape;
        assert_eq!(held.bounds(), Some((DVec2::splat(0.5), DVec2::splat(1.5))));
        let plane = Wall::<D2>::plane("p", DVec2::ONE, DVec2::Y, MaterialId(0)).unwrap().shape;
        assert_eq!((plane.bounds(), plane.reference()), (None, DVec2::ONE));
    }

    #[test]
    fn a_tube_is_touched_inside_outside_and_at_its_rims() {
        let (from, to) = (DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 4.0));
        let tube = Wall::<D3>::tube("t", from, to, 2.0, MaterialId(0)).unwrap().shape;
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
        assert!(Wall::<D3>::tube("t", from, from, 2.0, MaterialId(0)).is_err());
        assert!(Wall::<D3>::tube("t", from, to, 0.0, MaterialId(0)).is_err());
    }
}
