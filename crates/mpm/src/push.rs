//! Velocities that particles get at once, before a run or at a pause: a field, or a push as from a blow or a quake.
//!
//! What this changes of the energy counts as put in from outside.

use crate::mpm::{BodyId, Mpm};
use granular_core::matrix::Matrix;
use granular_core::push::{Push, Strength, speed_for_energy};
use granular_core::{Blocks, Dim, Linear, SetupError, Vector};

/// Particles whose momenta are summed at once.
const BLOCK: usize = 4096;

/// A velocity that is uniform or has a gradient, $v = v_0 + G (x - x_0)$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityField<D: Dim> {
    /// Velocity at a point \[m/s\].
    pub velocity: D::Vec,
    /// Its gradient \[1/s\]: the row is the component of the velocity, the column that of the place.
    pub gradient: Matrix<D>,
    /// The point \[m\].
    pub about: D::Vec,
}

impl<D: Dim> VelocityField<D> {
    /// The same velocity \[m/s\] everywhere.
    pub fn uniform(velocity: D::Vec) -> Self {
        Self { velocity, gradient: Matrix::zero(), about: D::Vec::ZERO }
    }

    /// The velocity at a place \[m/s\].
    pub fn at(&self, place: D::Vec) -> D::Vec {
        self.velocity + self.gradient.apply(place - self.about)
    }
}

/// What a change of velocities did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pushed<D: Dim> {
    /// Kinetic energy given \[J; J/m in the plane\].
    pub energy: f64,
    /// Momentum given \[kg m/s; kg/s in the plane\].
    pub momentum: D::Vec,
    /// Greatest change of a velocity \[m/s\].
    pub speed: f64,
    /// Particles that got it.
    pub particles: usize,
}

impl<D: Dim> Mpm<D> {
    /// Adds a velocity \[m/s\] by place to that of the particles of a region, told by their body and place.
    ///
    /// # Errors
    /// When a velocity is not finite; nothing has changed then.
    pub fn add_velocity(
        &mut self,
        region: impl Fn(BodyId, D::Vec) -> bool,
        velocity: impl Fn(D::Vec) -> D::Vec,
    ) -> Result<Pushed<D>, SetupError> {
        let chosen = self.chosen(region);
        self.change_velocity(&chosen, |mpm, k| velocity(mpm.particles.position[k]))
    }

    /// Sets the velocity \[m/s\] of the particles of a region, told by their body and place, by place.
    ///
    /// # Errors
    /// When a velocity is not finite; nothing has changed then.
    pub fn set_velocity(
        &mut self,
        region: impl Fn(BodyId, D::Vec) -> bool,
        velocity: impl Fn(D::Vec) -> D::Vec,
    ) -> Result<Pushed<D>, SetupError> {
        let chosen = self.chosen(region);
        self.change_velocity(&chosen, |mpm, k| {
            velocity(mpm.particles.position[k]) - mpm.particles.velocity[k]
        })
    }

    /// Pushes the particles of a region, told by their body and place.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn apply_push(
        &mut self,
        push: &Push<D>,
        region: impl Fn(BodyId, D::Vec) -> bool,
    ) -> Result<Pushed<D>, SetupError> {
        push.check()?;
        let chosen = self.chosen(region);
        let (particles, direction) = (&self.particles, push.direction * (1.0 / push.direction.length()));
        let heights: Vec<f64> = chosen.iter().map(|&k| particles.position[k].component(D::UP)).collect();
        let shares = push.profile.shares(&heights);
        let sum = |of: &(dyn Fn(usize, f64) -> f64 + Sync)| {
            let blocks = Blocks::new(chosen.len(), BLOCK);
            blocks.sum(|n| particles.mass[chosen[n]] * of(chosen[n], shares[n]))
        };
        let speed = match push.strength {
            Strength::Speed(speed) => speed,
            Strength::EnergyPerGrain(energy) => {
                let allowed = "a speed or an energy: a continuum has no grains";
                return Err(SetupError::new("energy per grain of a push", energy, allowed));
            }
            Strength::Energy(_) if chosen.is_empty() => 0.0,
            Strength::Energy(energy) => {
                let before = sum(&|k, share| share * particles.velocity[k].dot(direction));
                speed_for_energy(sum(&|_, share| 0.5 * share * share), before, energy)
            }
        };
        let mut shares = shares.into_iter();
        let by_order = |_: &Self, _| direction * (speed * shares.next().unwrap_or(0.0));
        self.change_velocity(&chosen, by_order)
    }

    /// Particles of a region, in the order of memory.
    pub(crate) fn chosen(&self, region: impl Fn(BodyId, D::Vec) -> bool) -> Vec<usize> {
        let range = |starts: &[u32]| starts[0] as usize..starts[starts.len() - 1] as usize;
        let of_body = |(body, group): (usize, &crate::sorting::Group<D>)| {
            range(&group.starts).map(move |k| (BodyId(body), k)).collect::<Vec<_>>()
        };
        let all = self.groups.iter().enumerate().flat_map(of_body);
        all.filter(|&(body, k)| region(body, self.particles.position[k])).map(|(_, k)| k).collect()
    }

    /// Adds to velocities, asked for in the order of memory; the ledger counts the energy as put in.
    fn change_velocity(
        &mut self,
        chosen: &[usize],
        mut change: impl FnMut(&Self, usize) -> D::Vec,
    ) -> Result<Pushed<D>, SetupError> {
        let changes: Vec<D::Vec> = chosen.iter().map(|&k| change(self, k)).collect();
        if let Some(n) = changes.iter().position(|change| !change.is_finite()) {
            let error = SetupError::new("velocity", f64::NAN, "finite, in m/s");
            return Err(error.of(format_args!("particle {}", self.particles.id[chosen[n]])));
        }
        let mut pushed = Pushed { energy: 0.0, momentum: D::Vec::ZERO, speed: 0.0, particles: chosen.len() };
        for (&k, &change) in chosen.iter().zip(&changes) {
            let (velocity, mass) = (&mut self.particles.velocity[k], self.particles.mass[k]);
            // Half of the difference of squares, without their cancellation.
            pushed.energy += mass * change.dot(*velocity + change * 0.5);
            pushed.momentum += change * mass;
            pushed.speed = pushed.speed.max(change.length());
            *velocity += change;
            self.fastest = self.fastest.max(velocity.length());
        }
        self.injected += pushed.energy;
        Ok(pushed)
    }
}
