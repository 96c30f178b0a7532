//! Loads that others put on grains, such as those of a fluid: force and torque on each, held until they are replaced.
//!
//! They enter the step in one place, beside the loads of contacts, and stay with their grain when grains are sorted, put
//! in or taken out. In a periodic cell that deforms they count as loads on the motion relative to its flow, and not as
//! part of its stress. A simulation to which nothing puts loads has none of this.

use crate::dem::Dem;
use crate::material::SetupError;
use granular_core::quantity::{HydroLoad, Load, LoadsMut};
use granular_core::{Accepts, Dim, Linear, Matrix};

impl<D: Dim> Accepts<HydroLoad<D>> for Dem<D> {
    /// Makes room for loads, and lets grains turn, since loads may have torques.
    fn enable(&mut self) {
        if !self.grains.takes_loads {
            self.grains.takes_loads = true;
            self.grains.load = vec![Load::ZERO; self.len()];
            self.let_turn();
        }
    }

    fn view_mut(&mut self) -> LoadsMut<'_, D> {
        LoadsMut::new(&self.grains.id, &mut self.grains.load)
    }
}

impl<D: Dim> Dem<D> {
    /// Puts a load on the grain of a stable identifier, in place of the one that it has; it is held until it is replaced.
    ///
    /// # Errors
    /// When there is no such grain or the load is not finite.
    pub fn set_load(&mut self, id: u32, load: Load<D>) -> Result<(), SetupError> {
        let index = self.index_of(id)?;
        if !load.is_finite() {
            return Err(SetupError::new(format!("load on grain {id}"), f64::NAN, "finite"));
        }
        Accepts::<HydroLoad<D>>::enable(self);
        self.grains.load[index] = load;
        Ok(())
    }

    /// Loads of others on grains, in the order of memory; empty unless something puts some.
    pub fn loads(&self) -> &[Load<D>] {
        &self.grains.load
    }

    /// Work of the loads of others on grains since the start \[J\], in a cell relative to its flow; zero unless the ledger
    /// is kept.
    pub fn load_work(&self) -> f64 {
        self.load_work
    }

    /// Adds loads of others to those of contacts.
    pub(crate) fn add_loads(&mut self) {
        let grains = &mut self.grains;
        let work = (&mut grains.acceleration[..], &mut grains.spin_acceleration[..], &mut grains.load[..]);
        self.blocks.for_each(work, |_, (force, torque, load)| {
            for ((force, torque), load) in force.iter_mut().zip(torque).zip(load) {
                *force += load.force;
                *torque += load.torque;
            }
        });
    }

    /// Power of the loads of others \[W\].
    pub(crate) fn power_of_loads(&self) -> f64 {
        let grains = &self.grains;
        self.blocks
            .sum(|i| grains.load[i].force.dot(grains.velocity[i]) + grains.load[i].torque.dot(grains.spin[i]))
    }

    /// Sum of force times place of the loads of others \[J\], from the corner of the cell.
    pub(crate) fn virial_of_loads(&self, low: D::Vec) -> Matrix<D> {
        let of = |i: usize| Matrix::dyad(self.grains.load[i].force, self.grains.position[i] - low);
        let sums =
            self.blocks.map(|range| range.fold(Matrix::default(), |sum: Matrix<D>, i| sum.plus(&of(i), 1.0)));
        sums.iter().fold(Matrix::default(), |sum, of_block| sum.plus(of_block, 1.0))
    }
}
