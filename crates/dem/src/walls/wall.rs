//! Walls: shapes with a name and a material, at rest or in motion.

use crate::material::{MaterialId, SetupError};
use granular_core::walls::WallMotion;
use granular_core::{Dim, Shape};

/// A wall, at rest unless it has a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall<D: Dim> {
    /// Name, unique in a scene.
    pub name: String,
    /// Surface.
    pub shape: Shape<D>,
    /// Material.
    pub material: MaterialId,
    /// Whether it is out of the way: an open gate.
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
        Self::of(name, Shape::plane(point, normal), material)
    }

    /// A segment between two points \[m\].
    ///
    /// # Errors
    /// When the points coincide or are not finite.
    pub fn segment(name: &str, from: D::Vec, to: D::Vec, material: MaterialId) -> Result<Self, SetupError> {
        Self::of(name, Shape::segment(from, to), material)
    }

    /// A solid block between two corners \[m\].
    ///
    /// # Errors
    /// When the upper corner is below the lower one, or a corner is not finite.
    pub fn block(name: &str, low: D::Vec, high: D::Vec, material: MaterialId) -> Result<Self, SetupError> {
        Self::of(name, Shape::block(low, high), material)
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
        Self::of(name, Shape::tube(from, to, radius), material)
    }

    /// A circle about a centre \[m\] with a radius \[m\], touched from inside and outside; in space the shell of a sphere.
    ///
    /// # Errors
    /// When the centre is not finite or the radius not positive.
    pub fn circle(name: &str, centre: D::Vec, radius: f64, material: MaterialId) -> Result<Self, SetupError> {
        Self::of(name, Shape::circle(centre, radius), material)
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
        Self::of(name, Shape::chain(points, closed), material)
    }

    /// A mesh of triangles, three corners \[m\] each, touched from both sides, at its faces, edges and corners. It
    /// need not be closed and its triangles need not share corners. (In the plane a triangle is a filled one.)
    ///
    /// # Errors
    /// When there is no triangle, corners are left over, one is not finite, or those of a triangle coincide.
    pub fn triangles(name: &str, corners: Vec<D::Vec>, material: MaterialId) -> Result<Self, SetupError> {
        Self::of(name, Shape::triangles(corners), material)
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
        Self::of(name, Shape::balls(grains), material)
    }

    /// The same wall with a motion; its shape is where it begins.
    pub fn moving(self, motion: WallMotion<D>) -> Self {
        Self { motion: Some(motion), ..self }
    }

    fn of(name: &str, shape: Result<Shape<D>, SetupError>, material: MaterialId) -> Result<Self, SetupError> {
        let shape = shape.map_err(|error| error.of(format_args!("wall `{name}`")))?;
        Ok(Self { name: name.to_owned(), shape, material, open: false, motion: None, held: false })
    }
}

impl<D: Dim> AsRef<Shape<D>> for Wall<D> {
    fn as_ref(&self) -> &Shape<D> {
        &self.shape
    }
}
