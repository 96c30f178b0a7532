//! A push: a velocity that all grains get at once, as from a blow or a quake.

use crate::dem::Dem;
use crate::material::SetupError;
use granular_core::push::{Push, Strength, speed_for_energy};
use granular_core::{Dim, Linear, Vector};

/// What a push did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pushed {
    /// Kinetic energy given \[J; J/m in the plane\].
    pub energy: f64,
    /// Momentum given along the direction \[kg m/s; kg/s in the plane\].
    pub momentum: f64,
    /// Velocity given to the grains that it moves fastest \[m/s\].
    pub speed: f64,
}

impl<D: Dim> Dem<D> {
    /// Mass of all grains \[kg; kg/m in the plane\].
    pub fn mass(&self) -> f64 {
        self.blocks.sum(|i| self.grains.mass[i])
    }

    /// Adds a velocity to that of every grain; the ledger counts the energy. Where there are no grains nothing
    /// happens.
    ///
    /// # Errors
    /// When a value is out of range, or the grains are in a periodic cell.
    pub fn apply_push(&mut self, push: &Push<D>) -> Result<Pushed, SetupError> {
        push.check()?;
        if self.cell.is_some() {
            return Err(SetupError::new("number of periodic cells that are pushed", 1.0, "0"));
        }
        if self.is_empty() {
            return Ok(Pushed::default());
        }
        let direction = push.direction * (1.0 / push.direction.length());
        let heights: Vec<f64> = self.grains.position.iter().map(|at| at.component(D::UP)).collect();
        let shares = push.profile.shares(&heights);
        let sum = |of: &(dyn Fn(usize) -> f64 + Sync)| self.blocks.sum(|i| self.grains.mass[i] * of(i));
        let squares = sum(&|i| 0.5 * shares[i] * shares[i]);
        let before = sum(&|i| shares[i] * self.grains.velocity[i].dot(direction));
        let of_energy = |energy: f64| speed_for_energy(squares, before, energy);
        let speed = match push.strength {
            Strength::Speed(speed) => speed,
            Strength::Energy(energy) => of_energy(energy),
            Strength::EnergyPerGrain(units) => {
                of_energy(units * self.mass() * self.gravity.length() * self.mean_diameter())
            }
        };
        let pushed = Pushed {
            energy: speed * (squares * speed + before),
            momentum: speed * sum(&|i| shares[i]),
            speed,
        };
        self.change(|dem| {
            for (velocity, share) in dem.grains.velocity.iter_mut().zip(&shares) {
                *velocity += direction * (speed * share);
            }
        });
        Ok(pushed)
    }
}
