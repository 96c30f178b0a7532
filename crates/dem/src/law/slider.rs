//! Springs that slide at a cap.

use super::Kinematics;
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
pub struct Slider {
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping while the surfaces overlap \[N s/m\].
    pub damping: f64,
}

/// Outcome of [`Slider::load`].
#[derive(Clone, Copy, Debug)]
pub struct Slid<S> {
    /// Force on the first body.
    pub force: S,
    /// Energy lost in the dashpot over the step.
    pub damped: f64,
    /// Energy lost by sliding over the step, with friction.
    pub slid: f64,
}

impl<S> Slid<S> {
    /// Energy lost by sliding over the step at this coefficient of friction: without friction the force is zero, and so
    /// is its work, where the sums over a contact that `slid` is a part of are zero to the second order only.
    #[inline(always)]
    pub fn lost(&self, friction: f64) -> f64 {
        if friction > 0.0 { self.slid } else { 0.0 }
    }
}

/// How two surfaces pass each other in a step.
#[derive(Clone, Copy, Debug)]
pub struct Motion<S> {
    /// At the middle of the step, as predicted.
    pub rate: S,
    /// At its start.
    pub start_rate: S,
    /// Share of the step during which they overlap.
    pub presence: f64,
    /// Whether they meet within the step.
    pub enters: bool,
    /// The step \[s\].
    pub dt: f64,
    /// The step before \[s\].
    pub last_dt: f64,
}

impl<S> Motion<S> {
    /// At these rates in the middle and at the start of the step.
    #[inline(always)]
    pub fn of<D: Dim>(m: &Kinematics<D>, rate: S, start_rate: S) -> Self {
        let enters = m.presence < 1.0 && m.approach > 0.0;
        Self { rate, start_rate, presence: m.presence, enters, dt: m.dt, last_dt: m.last_dt }
    }

    /// Times by which the spring advances before and after the load. Before: from the middle of
    /// the last step to the middle of this one, or of the part in which the surfaces overlap.
    /// After: nothing, but for surfaces that met within the step, so that the next advance ends
    /// at the middle of the next step.
    #[inline(always)]
    pub fn advances(&self) -> (f64, f64) {
        let time = self.presence * self.dt;
        if self.enters { (0.5 * time, 0.5 * (time - self.dt)) } else { (0.5 * (self.last_dt + time), 0.0) }
    }
}

impl Slider {
    /// The load over one step under a cap \[N\]; the spring moves on.
    #[inline(always)]
    pub fn load<S: Linear>(&self, spring: &mut S, motion: &Motion<S>, cap: f64) -> Slid<S> {
        let (before, after) = motion.advances();
        let (rate, dt) = (motion.rate, motion.dt);
        let trial = *spring + motion.start_rate * before;
        let damping = self.damping * motion.presence;
        let stuck = -(trial * self.stiffness + rate * damping);
        let size = stuck.length_squared();
        if size <= cap * cap {
            let slid = self.at_ends(*spring, trial, motion);
            *spring = trial + motion.start_rate * after;
            // What the prediction adds to the rate counts against it: see `Kinematics::damped`.
            let gained = rate - motion.start_rate;
            let squared = rate.length_squared() - 2.0 * gained.length_squared();
            return Slid { force: stuck, damped: damping * squared * dt, slid };
        }
        let size = size.sqrt();
        let direction = stuck * (1.0 / size);
        // Without spring and dashpot there is nothing to hold back: the cap is zero or unknown.
        let hold = (self.stiffness + damping / dt).max(f64::MIN_POSITIVE);
        let slip = (size - cap) / hold;
        let left = rate + direction * (slip / dt);
        let slid_back = trial + direction * slip;
        let at_ends = self.at_ends(*spring, slid_back, motion);
        *spring = slid_back + motion.start_rate * after;
        let damped = damping * left.length_squared() * dt;
        // The force while it slides is the mean of this step's and the last one's, so that the
        // sum of losses and stored energy follows the work to second order.
        let mean = cap + 0.5 * self.stiffness * (motion.start_rate.dot(direction) * before + slip);
        Slid { force: direction * cap, damped, slid: mean * slip + at_ends }
    }

    /// Work of the force in the first and the last step of a contact beyond what goes into the spring and is lost by
    /// sliding, while the spring goes from `last` to `now`.
    ///
    /// Over a contact the work is that of the mean of two steps' forces over the way from the middle of the one to
    /// that of the other. Surfaces that overlap in a part of a step only move the spring by a part of that way.
    #[inline(always)]
    fn at_ends<S: Linear>(&self, last: S, now: S, motion: &Motion<S>) -> f64 {
        if motion.presence >= 1.0 {
            return 0.0;
        }
        let (before, after) = motion.advances();
        let Motion { start_rate: rate, dt, last_dt, enters, .. } = *motion;
        let missed = 0.5 * (dt + last_dt) - before;
        let work = 0.5 * missed * rate.dot(last + now);
        let beside = if enters {
            // What the next step will miss, since the spring begins it further back.
            -after * rate.dot(now) - 0.5 * after * (dt + after) * rate.length_squared()
        } else {
            // The way from the last force to none.
            0.5 * dt * rate.dot(now)
        };
        self.stiffness * (work + beside)
    }

    /// Carries a spring over from another stiffness, `last`, and returns the energy lost \[J\].
    ///
    /// Where the contact stiffens the force stays, where it softens the displacement does: either
    /// way the spring loses energy and none is created \[Thornton2013\]. The loss at softening
    /// is taken half way through the `advance` that follows, so that work, stored energy and
    /// losses balance to the second order.
    #[inline(always)]
    pub fn carry<S: Linear>(&self, spring: &mut S, last: f64, advance: S) -> f64 {
        let now = self.stiffness;
        if now > last {
            let ratio = last / now;
            let lost = 0.5 * last * (1.0 - ratio) * spring.length_squared();
            *spring = *spring * ratio;
            lost
        } else {
            0.5 * (last - now) * spring.dot(*spring + advance)
        }
    }

    /// A spring of the middle of the last step as it is between steps.
    pub(crate) fn now<D: Dim>(spring: D::Spin, m: &Kinematics<D>) -> D::Spin {
        spring + m.slip * (0.5 * m.last_dt)
    }

    /// A spring between steps as it was in the middle of the last step.
    pub(crate) fn half_a_step_ago<D: Dim>(spring: D::Spin, m: &Kinematics<D>) -> D::Spin {
        spring - m.slip * (0.5 * m.last_dt)
    }

    /// Force and stored energy between steps: the spring is half a step behind, and what the next
    /// step will slide is still stored.
    ///
    /// The energy is that of the stiffness at the last step: what a change since will take is
    /// still stored.
    pub fn at_rest<S: Linear>(&self, spring: S, rate: S, last: (f64, f64), cap: f64) -> (S, f64) {
        let (last_dt, last_stiffness) = last;
        let spring = spring + rate * (0.5 * last_dt);
        let stuck = -(spring * self.stiffness + rate * self.damping);
        let size = stuck.length();
        let force = if size <= cap { stuck } else { stuck * (cap / size) };
        (force, 0.5 * last_stiffness * spring.length_squared())
    }
}
