//! Grains in a fluid that is resolved between them.

use crate::dim::{Dim, Linear};
use crate::exchange::Quantity;
use crate::quantity::{Load, Motion};
use std::marker::PhantomData;

/// A grain as a fluid meets it.
#[derive(Clone, Copy, Debug)]
pub struct ImmersedGrain<D: Dim> {
    /// Where it is and how it moves.
    pub motion: Motion<D>,
    /// Radius \[m\] at which the fluid meets it: its hydrodynamic radius.
    pub radius: f64,
}

impl<D: Dim> PartialEq for ImmersedGrain<D> {
    fn eq(&self, other: &Self) -> bool {
        self.motion == other.motion && self.radius == other.radius
    }
}

/// Grains in a fluid: where they are \[m\], how they move \[m/s, rad/s\] and how large they are \[m\], in the frame of the scene.
///
/// The fluid meets them so in the whole of its next steps: what is right to second order is the motion in the middle of a
/// step. Laws push their grains to the list, which the simulation clears before each long step; how the fluid resolves
/// them is its own affair. A solver that takes grains provides [`FlowLoad`].
#[derive(Clone, Copy, Debug)]
pub struct ImmersedGrains<D>(PhantomData<D>);

impl<D: Dim> Quantity for ImmersedGrains<D> {
    const NAME: &'static str = "grains in a fluid";
    const UNIT: &'static str = "m, m/s, rad/s";
    type View<'a> = &'a [ImmersedGrain<D>];
    type ViewMut<'a> = &'a mut Vec<ImmersedGrain<D>>;
}

/// What the flow does to [`ImmersedGrains`]: force \[N\] and torque \[N m\] on each as the mean over the last step, in the order
/// of the list and the frame of the scene; per metre of depth in the plane.
///
/// The weight of the fluid that a grain displaces is left out, whether the fluid has a body force or not: a grain at rest in a
/// fluid at rest has no load, though pressure grows with depth. The whole force of the fluid on a grain of hydrodynamic volume `V` is
/// `load + inner_density V dU/dt - density V g`, `U` being the velocity of the grain and `g` the part of the body force on the
/// fluid that is a weight. (A body force that stands for the mean gradient of a pressure does not enter: the load has its push.)
/// The torque lacks the inertia of the fluid within the grain in the same way. In the first step `dU` begins at the velocity of the
/// fluid that the grain found in its place ([`CoveredFluid`]).
#[derive(Clone, Copy, Debug)]
pub struct FlowLoad<D>(PhantomData<D>);

impl<D: Dim> Quantity for FlowLoad<D> {
    const NAME: &'static str = "load of the flow on grains";
    const UNIT: &'static str = "N, N m";
    type View<'a> = FlowLoads<'a, D>;
    type ViewMut<'a> = &'a mut [Load<D>];
}

/// Loads of the flow, and the fluid in which they arise.
#[derive(Clone, Copy, Debug)]
pub struct FlowLoads<'a, D: Dim> {
    /// Mean over the last step, one per grain.
    pub loads: &'a [Load<D>],
    /// The fluid that each grain covered when the last step began.
    pub covered: &'a [CoveredFluid<D>],
    /// Density of the fluid \[kg/m^3\].
    pub density: f64,
    /// Density \[kg/m^3\] of the fluid that fills grains and moves with them; zero where there is none. Loads then contain what
    /// it takes to accelerate it.
    pub inner_density: f64,
    /// The part of the body force on the fluid that is a weight \[m/s^2\].
    pub gravity: D::Vec,
    /// The smallest length that the fluid resolves \[m\], such as the edge of a cell.
    pub spacing: f64,
}

/// The fluid that a grain covers: as it was before the grain acted on it.
#[derive(Clone, Copy, Debug)]
pub struct CoveredFluid<D: Dim> {
    /// Share of the grain that lies in the fluid: exactly 1 where all of it does, less where it reaches beyond a face or into an obstacle.
    pub share: f64,
    /// Momentum \[kg m/s\] of the fluid; per metre of depth in the plane.
    pub momentum: D::Vec,
    /// Angular momentum \[kg m^2/s\] about its own centre; per metre of depth in the plane.
    pub angular_momentum: D::Spin,
}

impl<D: Dim> CoveredFluid<D> {
    /// Nothing is covered.
    pub const NONE: Self = Self { share: 0.0, momentum: D::Vec::ZERO, angular_momentum: D::Spin::ZERO };

    /// Whether all components are finite.
    pub fn is_finite(&self) -> bool {
        self.share.is_finite() && self.momentum.is_finite() && self.angular_momentum.is_finite()
    }
}

impl<D: Dim> PartialEq for CoveredFluid<D> {
    fn eq(&self, other: &Self) -> bool {
        let Self { share, momentum, angular_momentum } = self;
        *share == other.share && *momentum == other.momentum && *angular_momentum == other.angular_momentum
    }
}
