//! Changes between steps.

use crate::mpm::{BodyId, Mpm};
use granular_core::{Dim, Linear};

impl<D: Dim> Mpm<D> {
    /// All bodies, in the order in which they were added.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> + use<D> {
        (0..self.groups.len()).map(BodyId)
    }

    /// All velocities become zero.
    pub fn stop_motion(&mut self) {
        self.injected -= self.energies().translational();
        self.particles.velocity.fill(D::Vec::ZERO);
        self.fastest = 0.0;
    }
}
