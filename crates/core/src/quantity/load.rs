//! Forces and torques that one solver puts on the grains of another.

use crate::dim::{Dim, Linear};
use crate::exchange::Quantity;
use std::marker::PhantomData;
use std::ops::AddAssign;

/// Force and torque on a body; in the plane both are per metre of depth.
#[derive(Clone, Copy, Debug)]
pub struct Load<D: Dim> {
    /// Force \[N\].
    pub force: D::Vec,
    /// Torque about the centre \[N m\]; in the plane positive when it turns x towards y.
    pub torque: D::Spin,
}

impl<D: Dim> Load<D> {
    /// No load.
    pub const ZERO: Self = Self { force: D::Vec::ZERO, torque: D::Spin::ZERO };

    /// Whether all components are finite.
    pub fn is_finite(&self) -> bool {
        self.force.is_finite() && self.torque.is_finite()
    }
}

impl<D: Dim> Default for Load<D> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<D: Dim> PartialEq for Load<D> {
    fn eq(&self, other: &Self) -> bool {
        self.force == other.force && self.torque == other.torque
    }
}

impl<D: Dim> AddAssign for Load<D> {
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.torque += other.torque;
    }
}

/// What a fluid does to grains: force \[N\] and torque about the centre \[N m\] on each, in the frame of the scene, positive
/// along its axes as they act on the grain; per metre of depth in the plane. Means over the slow step, so that load times
/// step is the impulse that the fluid gave; held in all steps that the grains take within it.
///
/// Loads stand in the order in which the grains are stored, which is that of [`GrainMotion`](super::GrainMotion). A solver
/// that re-sorts, adds, removes or exchanges grains while a load is held carries the loads along, so that each stays with
/// its grain; a grain that is new has none. `granular_core::testing::loads_follow_their_grains` tests it.
#[derive(Clone, Copy, Debug)]
pub struct HydroLoad<D>(PhantomData<D>);

impl<D: Dim> Quantity for HydroLoad<D> {
    const NAME: &'static str = "load of the fluid on grains";
    const UNIT: &'static str = "N, N m";
    type View<'a> = &'a [Load<D>];
    type ViewMut<'a> = LoadsMut<'a, D>;
}

/// Loads on grains, to be added to, with the identifiers of the grains.
#[derive(Debug)]
pub struct LoadsMut<'a, D: Dim> {
    id: &'a [u32],
    load: &'a mut [Load<D>],
}

impl<'a, D: Dim> LoadsMut<'a, D> {
    /// From one load per grain in the order of storage. `id` may be empty: the identifiers are 0, 1, 2 and so on.
    ///
    /// # Panics
    /// When lengths differ.
    pub fn new(id: &'a [u32], load: &'a mut [Load<D>]) -> Self {
        assert!(id.is_empty() || id.len() == load.len(), "identifiers and loads differ in number");
        Self { id, load }
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.load.len()
    }

    /// Whether there is no grain.
    pub fn is_empty(&self) -> bool {
        self.load.is_empty()
    }

    /// Adds to the load on the grain at an index of the order of storage.
    ///
    /// # Panics
    /// When there is no such grain.
    pub fn add(&mut self, index: usize, load: Load<D>) {
        self.load[index] += load;
    }

    /// Identifier and load of all grains, in the order of storage.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (u32, &mut Load<D>)> {
        let Self { id, load } = self;
        load.iter_mut().enumerate().map(|(k, load)| (id.get(k).copied().unwrap_or(k as u32), load))
    }
}
