//! Quantities that more than one solver lends or takes.

mod immersed;
mod load;

pub use immersed::{CoveredFluid, FlowLoad, FlowLoads, ImmersedGrain, ImmersedGrains};
pub use load::{HydroLoad, Load, LoadsMut};

use crate::dim::{Dim, Linear};
use crate::exchange::Quantity;
use std::marker::PhantomData;

/// How a rigid body moves.
#[derive(Clone, Copy, Debug)]
pub struct Motion<D: Dim> {
    /// Centre \[m\].
    pub position: D::Vec,
    /// Velocity of the centre \[m/s\].
    pub velocity: D::Vec,
    /// Angular velocity \[rad/s\].
    pub spin: D::Spin,
    /// How the body is turned \[rad\] against the frame of the scene, about its centre: an angle in the plane, a rotation
    /// vector in space ([`Dim::rotated`]). Zero, also for bodies that nobody can see turn, such as balls.
    pub orientation: D::Spin,
}

impl<D: Dim> PartialEq for Motion<D> {
    fn eq(&self, other: &Self) -> bool {
        self.position == other.position
            && self.velocity == other.velocity
            && self.spin == other.spin
            && self.orientation == other.orientation
    }
}

impl<D: Dim> Motion<D> {
    /// A body at rest.
    pub fn at(position: D::Vec) -> Self {
        Self::new(position, D::Vec::ZERO, D::Spin::ZERO)
    }

    /// A body that is not turned, with its position \[m\], velocity \[m/s\] and angular velocity \[rad/s\].
    pub fn new(position: D::Vec, velocity: D::Vec, spin: D::Spin) -> Self {
        Self { position, velocity, spin, orientation: D::Spin::ZERO }
    }

    /// Whether all components are finite.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite()
            && self.velocity.is_finite()
            && self.spin.is_finite()
            && self.orientation.is_finite()
    }
}

/// Positions \[m\], velocities \[m/s\], angular velocities \[rad/s\], orientations \[rad\] and radii \[m\] of grains, in the frame of
/// the scene.
#[derive(Clone, Copy, Debug)]
pub struct GrainMotion<D>(PhantomData<D>);

impl<D: Dim> Quantity for GrainMotion<D> {
    const NAME: &'static str = "motion of grains";
    const UNIT: &'static str = "m, m/s, rad/s, rad";
    type View<'a> = Grains<'a, D>;
    type ViewMut<'a> = &'a mut [Motion<D>];
}

/// Where the bodies in a fluid are \[m\], how they are turned \[rad\] and how they move \[m/s, rad/s\], in the order of the bodies, in the frame of the
/// scene. A fluid that takes it meets the bodies there in the whole of its next step: what is right to second order is the motion
/// in the middle of that step. A fluid whose bodies keep their shape as they turn, or cannot be turned, ignores orientations.
#[derive(Clone, Copy, Debug)]
pub struct ObstacleMotion<D>(PhantomData<D>);

impl<D: Dim> Quantity for ObstacleMotion<D> {
    const NAME: &'static str = "motion of obstacles";
    const UNIT: &'static str = "m, m/s, rad/s, rad";
    type View<'a> = &'a [Motion<D>];
    type ViewMut<'a> = &'a mut [Motion<D>];
}

/// Grains as a solver lends them. Storage stays the solver's own, in an order of its own; identifiers are stable.
#[derive(Clone, Copy, Debug)]
pub struct Grains<'a, D: Dim> {
    position: &'a [D::Vec],
    velocity: &'a [D::Vec],
    spin: &'a [D::Spin],
    orientation: &'a [D::Spin],
    radius: &'a [f64],
    id: &'a [u32],
}

impl<'a, D: Dim> Grains<'a, D> {
    /// From one array per property, all of one length. `spin` may be empty: no grain turns. `id` may be empty: the
    /// identifiers are 0, 1, 2 and so on.
    ///
    /// # Panics
    /// When lengths differ.
    pub fn new(
        position: &'a [D::Vec],
        velocity: &'a [D::Vec],
        spin: &'a [D::Spin],
        radius: &'a [f64],
        id: &'a [u32],
    ) -> Self {
        let count = position.len();
        assert!(velocity.len() == count && radius.len() == count, "arrays of grains differ in length");
        assert!(spin.is_empty() || spin.len() == count, "arrays of grains differ in length");
        assert!(id.is_empty() || id.len() == count, "arrays of grains differ in length");
        Self { position, velocity, spin, orientation: &[], radius, id }
    }

    /// With orientations \[rad\], by a solver that keeps them; without, no grain is turned.
    ///
    /// # Panics
    /// When there is not one for each grain.
    pub fn with_orientations(self, orientation: &'a [D::Spin]) -> Self {
        assert!(orientation.len() == self.len(), "arrays of grains differ in length");
        Self { orientation, ..self }
    }

    /// Number of grains.
    pub fn len(self) -> usize {
        self.position.len()
    }

    /// Whether there is no grain.
    pub fn is_empty(self) -> bool {
        self.position.is_empty()
    }

    /// Stable identifier of the grain at an index.
    pub fn id(self, index: usize) -> u32 {
        self.id.get(index).copied().unwrap_or(index as u32)
    }

    /// Motion of the grain at an index.
    pub fn motion(self, index: usize) -> Motion<D> {
        Motion {
            position: self.position[index],
            velocity: self.velocity[index],
            spin: self.spin.get(index).copied().unwrap_or(D::Spin::ZERO),
            orientation: self.orientation.get(index).copied().unwrap_or(D::Spin::ZERO),
        }
    }

    /// Radius \[m\] of the grain at an index.
    pub fn radius(self, index: usize) -> f64 {
        self.radius[index]
    }

    /// Identifier, motion and radius of all grains, in the order of storage.
    pub fn iter(self) -> impl Iterator<Item = (u32, Motion<D>, f64)> + 'a {
        (0..self.len()).map(move |index| (self.id(index), self.motion(index), self.radius(index)))
    }
}
