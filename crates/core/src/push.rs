//! Pushes: a velocity that grains, or particles of a continuum, get at once, as from a blow or a quake.

use crate::dim::{Dim, Linear};
use crate::setup_error::SetupError;

/// How strong a push is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Velocity of what it moves fastest \[m/s\]; below zero against the direction.
    Speed(f64),
    /// Kinetic energy that all get together \[J; J/m in the plane\].
    Energy(f64),
    /// The same for each grain, in units of mean mass times gravity times mean diameter. A continuum has no grains and refuses it.
    EnergyPerGrain(f64),
}

/// How a push is spread over the height of what gets it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PushProfile {
    /// The same velocity for all.
    #[default]
    Uniform,
    /// In proportion to the depth of the centre below the highest one: most for the lowest, nothing for the highest, as from a quake
    /// along the bottom \[Kumar2014, section 4.4\].
    Gradient,
}

impl PushProfile {
    /// Share of the largest velocity at each of these heights. What is all at one height is all lowest.
    pub fn shares(self, heights: &[f64]) -> Vec<f64> {
        let (top, bottom) =
            heights.iter().fold((f64::MIN, f64::MAX), |(top, bottom), &h| (top.max(h), bottom.min(h)));
        let share = |height: f64| match self {
            Self::Gradient if top > bottom => (top - height) / (top - bottom),
            Self::Uniform | Self::Gradient => 1.0,
        };
        heights.iter().map(|&height| share(height)).collect()
    }
}

/// A velocity $u_i = k s_i e$ that grains or particles get beside the one they have.
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

impl<D: Dim> Push<D> {
    /// Whether it can be done.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn check(&self) -> Result<(), SetupError> {
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

/// The larger root $k$ of `squares k^2 + before k = energy`, without loss of digits: the velocity with which a push gives an energy.
/// `squares` is $\sum_i m_i s_i^2 / 2$, `before` $\sum_i m_i s_i v_i \cdot e$. Zero for no energy.
pub fn speed_for_energy(squares: f64, before: f64, energy: f64) -> f64 {
    let root = (before * before + 4.0 * squares * energy).sqrt();
    match () {
        () if energy == 0.0 => 0.0,
        () if before > 0.0 => 2.0 * energy / (before + root),
        () => (root - before) / (2.0 * squares),
    }
}
