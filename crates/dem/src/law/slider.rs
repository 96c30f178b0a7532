//! Springs that slide at a cap.

use super::Meeting;
use granular_core::{Dim, Linear};

/// A spring and dashpot side by side that slide when their force reaches a cap \[DEM-6,
/// Cundall1979\].
///
/// The spring lives at the middle of steps and advances from one to the next by the velocity
/// between them, the one that moves the grains: the leapfrog, which neither damps nor excites.
/// (Advanced by the predicted velocity it gains `(w dt)^4 / 8` of its amplitude in each step.)
/// It slides back until the force is at the cap. Sliding takes motion from spring and dashpot
/// alike, so that nothing jumps when it begins: with no dashpot this is the reset of the spring
/// to `cap / k`; with one, a spring that was set to `cap / k` would gain the energy that the
/// dashpot held back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slider {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
}

/// Outcome of [`Slider::load`].
pub(crate) struct Slid<S> {
    /// Force on the first body.
    pub(crate) force: S,
    /// Energy lost in the dashpot over the step.
    pub(crate) damped: f64,
    /// Energy lost by sliding over the step.
    pub(crate) slid: f64,
}

/// How two surfaces pass each other in a step.
pub(crate) struct Motion<S> {
    /// At the middle of the step, as predicted.
    pub(crate) rate: S,
    /// At its start.
    pub(crate) start_rate: S,
    /// Share of the step during which they overlap.
    pub(crate) presence: f64,
    /// Whether they meet within the step.
    pub(crate) enters: bool,
    pub(crate) dt: f64,
    pub(crate) last_dt: f64,
}

impl<S> Motion<S> {
    #[inline(always)]
    pub(crate) fn of<D: Dim>(m: &Meeting<D>, rate: S, start_rate: S) -> Self {
        let enters = m.presence < 1.0 && m.approach > 0.0;
        Self { rate, start_rate, presence: m.presence, enters, dt: m.dt, last_dt: m.last_dt }
    }

    /// Times by which the spring advances before and after the load. Before: from the middle of
    /// the last step to the middle of this one, or of the part in which the surfaces overlap.
    /// After: nothing, but for surfaces that met within the step, so that the next advance ends
    /// at the middle of the next step.
    #[inline(always)]
    pub(crate) fn advances(&self) -> (f64, f64) {
        let time = self.presence * self.dt;
        if self.enters { (0.5 * time, 0.5 * (time - self.dt)) } else { (0.5 * (self.last_dt + time), 0.0) }
    }
}

impl Slider {
    #[inline(always)]
    pub(crate) fn load<S: Linear>(&self, spring: &mut S, motion: &Motion<S>, cap: f64) -> Slid<S> {
        let (before, after) = motion.advances();
        let (rate, dt) = (motion.rate, motion.dt);
        let trial = *spring + motion.start_rate * before;
        let damping = self.damping * motion.presence;
        let stuck = -(trial * self.stiffness + rate * damping);
        let size = stuck.length_squared();
        if size <= cap * cap {
            *spring = trial + motion.start_rate * after;
            return Slid { force: stuck, damped: damping * rate.length_squared() * dt, slid: 0.0 };
        }
        let size = size.sqrt();
        let direction = stuck * (1.0 / size);
        // Without spring and dashpot there is nothing to hold back: the cap is zero or unknown.
        let hold = (self.stiffness + damping / dt).max(f64::MIN_POSITIVE);
        let slip = (size - cap) / hold;
        let left = rate + direction * (slip / dt);
        *spring = trial + direction * slip + motion.start_rate * after;
        let damped = damping * left.length_squared() * dt;
        // The force while it slides is the mean of this step's and the last one's, so that the
        // sum of losses and stored energy follows the work to second order.
        let mean = cap + 0.5 * self.stiffness * (motion.start_rate.dot(direction) * before + slip);
        Slid { force: direction * cap, damped, slid: mean * slip }
    }

    /// Energy held at the end of a contact. The dashpot then lets the spring go; without one the
    /// spring has slid back with the cap already.
    #[inline(always)]
    pub(crate) fn held<S: Linear>(&self, spring: S) -> f64 {
        if self.damping > 0.0 { 0.5 * self.stiffness * spring.length_squared() } else { 0.0 }
    }

    /// Force and stored energy between steps: the spring is half a step behind, and what the next
    /// step will slide is still stored.
    pub(crate) fn at_rest<S: Linear>(&self, spring: S, rate: S, last_dt: f64, cap: f64) -> (S, f64) {
        let spring = spring + rate * (0.5 * last_dt);
        let stuck = -(spring * self.stiffness + rate * self.damping);
        let size = stuck.length();
        let force = if size <= cap { stuck } else { stuck * (cap / size) };
        (force, 0.5 * self.stiffness * spring.length_squared())
    }
}
