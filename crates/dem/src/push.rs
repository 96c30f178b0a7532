//! A push: a velocity that all grains get at once, as from a blow or a quake.

use crate::dem::Dem;
use crate::material::SetupError;
use granular_core::{Dim, Linear, Vector};

/// How strong a push is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Velocity of the grains that it moves fastest \[m/s\]; below zero against the direction.
    Speed(f64),
    /// Kinetic energy that all grains get together \[J; J/m in the plane\].
    Energy(f64),
    /// The same for each grain, in units of mean mass times gravity times mean diameter.
    EnergyPerGrain(f64),
}

/// How a push is spread over the height of the grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PushProfile {
    /// The same velocity for all.
    #[default]
    Uniform,
    /// In proportion to the depth of the centre below the highest one: most for the lowest grain, nothing for the highest,
    /// as from a quake along the bottom \[Kumar2014, section 4.4\].
    Gradient,
}

/// A velocity $u_i = k s_i e$ that grains get beside the one they have.
///
/// $e$ is the direction, $s_i$ from 0 to 1 the profile. A speed is $k$ itself. For an energy $E$, $k$ is the larger root of
/// $\sum_i m_i (s_i^2 k^2 / 2 + s_i v_i \cdot e k) = E$: motion that is left from before counts, so the kinetic energy
/// grows by $E$ to round-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push<D: Dim> {
    /// Where to, of any length.
    pub direction: D::Vec,
    /// How strong.
    pub strength: Strength,
    /// How it is spread over the height.
    pub profile: PushProfile,
}

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

impl<D: Dim> Push<D> {
    fn check(&self) -> Result<(), SetupError> {
        let refuse =
            |what: &str, value: f64, allowed: &'static str| Err(SetupError::new(what, value, allowed));
        let length = self.direction.length();
        if !(length > 0.0 && length.is_finite()) {
            return refuse("length of the direction of a push", length, "above zero and finite");
        }
        match self.strength {
            Strength::Speed(speed) if !speed.is_finite() => refuse("speed of a push", speed, "finite"),
            Strength::Energy(energy) | Strength::EnergyPerGrain(energy)
                if !(energy >= 0.0 && energy.is_finite()) =>
            {
                refuse("energy of a push", energy, "zero or more, and finite")
            }
            _ => Ok(()),
        }
    }
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
        let shares = self.shares(push.profile);
        let sum = |of: &(dyn Fn(usize) -> f64 + Sync)| self.blocks.sum(|i| self.grains.mass[i] * of(i));
        let squares = sum(&|i| 0.5 * shares[i] * shares[i]);
        let before = sum(&|i| shares[i] * self.grains.velocity[i].dot(direction));
        let of_energy = |energy: f64| larger_root(squares, before, energy);
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

    /// Share of the largest velocity that each grain gets. Grains that are all at one height are all lowest.
    fn shares(&self, profile: PushProfile) -> Vec<f64> {
        let height = |i: usize| self.grains.position[i].component(D::UP);
        let (top, bottom) = (self.blocks.largest(height), -self.blocks.largest(|i| -height(i)));
        let share = |i: usize| match profile {
            PushProfile::Gradient if top > bottom => (top - height(i)) / (top - bottom),
            PushProfile::Uniform | PushProfile::Gradient => 1.0,
        };
        (0..self.len()).map(share).collect()
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
