//! Grains in a fluid that is resolved between them.

use crate::dim::Dim;
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
#[derive(Clone, Copy, Debug)]
pub struct FlowLoad<D>(PhantomData<D>);

impl<D: Dim> Quantity for FlowLoad<D> {
    const NAME: &'static str = "load of the flow on grains";
    const UNIT: &'static str = "N, N m";
    type View<'a> = FlowLoads<'a, D>;
    type ViewMut<'a> = &'a mut [Load<D>];
}

/// Loads of the flow, and densities of the fluid.
#[derive(Clone, Copy, Debug)]
pub struct FlowLoads<'a, D: Dim> {
    /// Mean over the last step, one per grain.
    pub loads: &'a [Load<D>],
    /// Density of the fluid \[kg/m^3\].
    pub density: f64,
    /// Density \[kg/m^3\] of the fluid that fills grains and moves with them; zero where there is none. Loads then contain what
    /// it takes to accelerate it.
    pub inner_density: f64,
}
