//! Velocities that particles get at once, before a run or at a pause: a field, or a push as from a blow or a quake.
//!
//! What this changes of the energy counts as put in from outside.

use crate::mpm::{BodyId, Mpm};
use granular_core::matrix::Matrix;
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

/// How strong a push is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Velocity of the particles that it moves fastest \[m/s\]; below zero against the direction.
    Speed(f64),
    /// Kinetic energy that all particles get together \[J; J/m in the plane\].
    Energy(f64),
}

/// How a push is spread over the height of the particles that get it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PushProfile {
    /// The same velocity for all.
    #[default]
    Uniform,
    /// In proportion to the depth below the highest particle: most for the lowest, nothing for the highest, as from a quake along the
    /// bottom \[Kumar2014, section 4.4\].
    Gradient,
}

/// A velocity $u_p = k s_p e$ that particles get beside the one they have: $e$ is the direction, $s_p$ from 0 to 1 the profile.
/// A speed is $k$ itself; for an energy, motion that is left from before counts, so that the kinetic energy grows by it to round-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push<D: Dim> {
    /// Where to, of any length.
    pub direction: D::Vec,
    /// How strong.
    pub strength: Strength,
    /// How it is spread over the height.
    pub profile: PushProfile,
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

impl<D: Dim> Push<D> {
    fn check(&self) -> Result<(), SetupError> {
        let length = self.direction.length();
        if !(length > 0.0 && length.is_finite()) {
            return Err(SetupError::new(
                "length of the direction of a push",
                length,
                "above zero and finite",
            ));
        }
        match self.strength {
            Strength::Speed(speed) if !speed.is_finite() => {
                Err(SetupError::new("speed of a push", speed, "finite"))
            }
            Strength::Energy(energy) if !(energy >= 0.0 && energy.is_finite()) => {
                Err(SetupError::new("energy of a push", energy, "zero or more, and finite"))
            }
            _ => Ok(()),
        }
    }
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
        let shares = self.shares(&chosen, push.profile);
        let sum = |of: &(dyn Fn(usize, f64) -> f64 + Sync)| {
            let blocks = Blocks::new(chosen.len(), BLOCK);
            blocks.sum(|n| particles.mass[chosen[n]] * of(chosen[n], shares[n]))
        };
        let speed = match push.strength {
            Strength::Speed(speed) => speed,
            Strength::Energy(_) if chosen.is_empty() => 0.0,
            Strength::Energy(energy) => {
                let before = sum(&|k, share| share * particles.velocity[k].dot(direction));
                larger_root(sum(&|_, share| 0.5 * share * share), before, energy)
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

    /// Share of the largest velocity that each particle gets. Particles that are all at one height are all lowest.
    fn shares(&self, chosen: &[usize], profile: PushProfile) -> Vec<f64> {
        let height = |k: usize| self.particles.position[k].component(D::UP);
        let heights = || chosen.iter().map(|&k| height(k));
        let (top, bottom) = (heights().fold(f64::MIN, f64::max), heights().fold(f64::MAX, f64::min));
        let share = |k: usize| match profile {
            PushProfile::Gradient if top > bottom => (top - height(k)) / (top - bottom),
            PushProfile::Uniform | PushProfile::Gradient => 1.0,
        };
        chosen.iter().map(|&k| share(k)).collect()
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

/// The larger root k of `a k^2 + b k = c`, without loss of digits; zero for `c = 0`.
fn larger_root(a: f64, b: f64, c: f64) -> f64 {
    let root = (b * b + 4.0 * a * c).sqrt();
    match () {
        () if c == 0.0 => 0.0,
        () if b > 0.0 => 2.0 * c / (b + root),
        () => (root - b) / (2.0 * a),
    }
}
