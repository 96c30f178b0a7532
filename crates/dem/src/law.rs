//! Contact laws: from the motion of two bodies at their contact to the load between them.
//!
//! Symbols of this module: `k` stiffness, `c` damping, `n` the unit normal from the second to
//! the first body, `xi` tangential displacement. Tangential quantities are kept as `n x ...`
//! (see [`granular_core::dim`]), so one source serves disks and spheres.

use crate::ledger::Tally;
use crate::material::{PairProperties, Tension};
use granular_core::{Dim, Linear, Stored};
use std::fmt::Debug;

/// Two bodies at their contact, at the middle of a step.
#[derive(Clone, Copy, Debug)]
pub struct Meeting<D: Dim> {
    /// Unit vector from the second to the first body.
    pub normal: D::Vec,
    /// Overlap \[m\], averaged over the part of the step before and after the surfaces meet.
    pub overlap: f64,
    /// Share of the step during which the surfaces overlap, 0 to 1.
    pub presence: f64,
    /// Speed of approach along the normal \[m/s\].
    pub approach: f64,
    /// `n x` velocity of the first surface past the second \[m/s\].
    pub slip: D::Spin,
    /// Tangential part of the difference of spins \[rad/s\].
    pub roll: D::Spin,
    /// The slip at the start of the step \[m/s\], with which grains move from the middle of the last
    /// step to the middle of this one. Springs follow it; `slip` is a prediction, for dashpots only.
    pub start_slip: D::Spin,
    /// The roll at the start of the step \[rad/s\].
    pub start_roll: D::Spin,
    /// Mean spin about the normal \[rad/s\].
    pub twist: f64,
    /// `m1 m2 / (m1 + m2)` \[kg\].
    pub effective_mass: f64,
    /// `r1 r2 / (r1 + r2)` \[m\].
    pub effective_radius: f64,
    /// The step \[s\].
    pub dt: f64,
    /// The step before \[s\].
    pub last_dt: f64,
}

/// What a contact does to the first body; the second gets the opposite.
#[derive(Clone, Copy, Debug)]
pub struct Load<D: Dim> {
    /// Force along the normal \[N\], positive when it repels.
    pub normal: f64,
    /// `n x` tangential force \[N\].
    pub tangential: D::Spin,
    /// Rolling moment \[N m\].
    pub rolling: D::Spin,
}

impl<D: Dim> Load<D> {
    /// A load along the normal.
    #[inline(always)]
    pub fn along_normal(force: f64) -> Self {
        Self { normal: force, tangential: D::Spin::ZERO, rolling: D::Spin::ZERO }
    }
}

/// A contact law. Statically typed in the kernels: pass any implementation to
/// [`Dem::with_law`](crate::Dem::with_law).
pub trait ContactLaw<D: Dim>: Copy + Debug + Send + Sync + 'static {
    /// What one contact remembers between steps; `()` when nothing. The default is a fresh contact.
    type Memory: Copy + Default + PartialEq + Stored + Debug + Send + Sync + 'static;
    /// Whether tangential motion matters: without it grains do not turn and have no spin.
    const TANGENTIAL: bool;
    /// Name, for reports.
    const NAME: &'static str;

    /// The law between two materials.
    fn between(properties: &PairProperties, tension: Tension) -> Self;
    /// The load over one step; dissipation is told to the tally.
    fn load<const LEDGER: bool>(
        &self,
        meeting: &Meeting<D>,
        memory: &mut Self::Memory,
        tally: &mut Tally<LEDGER>,
    ) -> Load<D>;
    /// Tells the tally of energy that was still stored when a contact ended.
    #[inline(always)]
    fn release<const LEDGER: bool>(&self, memory: &Self::Memory, tally: &mut Tally<LEDGER>) {
        let _ = (memory, tally);
    }
    /// The same contact seen from the second body.
    fn reversed(memory: Self::Memory) -> Self::Memory;
    /// The load between steps and the energy stored in springs \[J\], for output. The step of the
    /// meeting is the last one taken.
    fn at_rest(&self, meeting: &Meeting<D>, memory: Self::Memory) -> (Load<D>, f64);
}

/// Linear spring and dashpot along the normal, `F = k delta + c approach` \[DEM-3\].
///
/// The damping is solved per pair from the restitution asked for, `c = 2 zeta sqrt(m_eff k)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearNormal {
    /// Normal stiffness \[N/m\].
    pub stiffness: f64,
    /// `2 zeta sqrt(k)`: times the root of the effective mass it is the damping.
    pub damping_factor: f64,
    /// Whether parting contacts may pull.
    pub tension: Tension,
}

impl LinearNormal {
    #[inline(always)]
    fn force(&self, overlap: f64, presence: f64, approach: f64, damping: f64) -> f64 {
        let force = self.stiffness * overlap + presence * damping * approach;
        if self.tension == Tension::Cut { force.max(0.0) } else { force }
    }
}

impl<D: Dim> ContactLaw<D> for LinearNormal {
    type Memory = ();
    const TANGENTIAL: bool = false;
    const NAME: &'static str = "linear without friction";

    fn between(properties: &PairProperties, tension: Tension) -> Self {
        let stiffness = properties.normal_stiffness;
        Self { stiffness, damping_factor: 2.0 * properties.zeta(tension) * stiffness.sqrt(), tension }
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(&self, m: &Meeting<D>, (): &mut (), tally: &mut Tally<LEDGER>) -> Load<D> {
        let damping = self.damping_factor * m.effective_mass.sqrt();
        let force = self.force(m.overlap, m.presence, m.approach, damping);
        // Where the cut acts, the dashpot takes up what the spring gives back.
        tally.normal_damping(|| (force - self.stiffness * m.overlap) * m.approach * m.dt);
        Load::along_normal(force)
    }

    fn reversed((): ()) {}

    fn at_rest(&self, m: &Meeting<D>, (): ()) -> (Load<D>, f64) {
        let damping = self.damping_factor * m.effective_mass.sqrt();
        let force = self.force(m.overlap, 1.0, m.approach, damping);
        (Load::along_normal(force), 0.5 * self.stiffness * m.overlap * m.overlap)
    }
}

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
struct Slider {
    stiffness: f64,
    damping: f64,
}

/// Outcome of [`Slider::load`].
struct Slid<S> {
    /// Force on the first body.
    force: S,
    /// Energy lost in the dashpot over the step.
    damped: f64,
    /// Energy lost by sliding over the step.
    slid: f64,
}

/// How two surfaces pass each other in a step.
struct Motion<S> {
    /// At the middle of the step, as predicted.
    rate: S,
    /// At its start.
    start_rate: S,
    /// Share of the step during which they overlap.
    presence: f64,
    /// Whether they meet within the step.
    enters: bool,
    dt: f64,
    last_dt: f64,
}

impl<S> Motion<S> {
    #[inline(always)]
    fn of<D: Dim>(m: &Meeting<D>, rate: S, start_rate: S) -> Self {
        let enters = m.presence < 1.0 && m.approach > 0.0;
        Self { rate, start_rate, presence: m.presence, enters, dt: m.dt, last_dt: m.last_dt }
    }

    /// Times by which the spring advances before and after the load. Before: from the middle of
    /// the last step to the middle of this one, or of the part in which the surfaces overlap.
    /// After: nothing, but for surfaces that met within the step, so that the next advance ends
    /// at the middle of the next step.
    #[inline(always)]
    fn advances(&self) -> (f64, f64) {
        let time = self.presence * self.dt;
        if self.enters { (0.5 * time, 0.5 * (time - self.dt)) } else { (0.5 * (self.last_dt + time), 0.0) }
    }
}

impl Slider {
    #[inline(always)]
    fn load<S: Linear>(&self, spring: &mut S, motion: &Motion<S>, cap: f64) -> Slid<S> {
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
    fn held<S: Linear>(&self, spring: S) -> f64 {
        if self.damping > 0.0 { 0.5 * self.stiffness * spring.length_squared() } else { 0.0 }
    }

    /// Force and stored energy between steps: the spring is half a step behind, and what the next
    /// step will slide is still stored.
    fn at_rest<S: Linear>(&self, spring: S, rate: S, last_dt: f64, cap: f64) -> (S, f64) {
        let spring = spring + rate * (0.5 * last_dt);
        let stuck = -(spring * self.stiffness + rate * self.damping);
        let size = stuck.length();
        let force = if size <= cap { stuck } else { stuck * (cap / size) };
        (force, 0.5 * self.stiffness * spring.length_squared())
    }
}

/// [`LinearNormal`] with a tangential spring under a Coulomb cap \[DEM-6, DEM-7\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearFrictional {
    /// Along the normal.
    pub normal: LinearNormal,
    /// Tangential stiffness \[N/m\].
    pub tangential_stiffness: f64,
    /// Tangential over normal damping coefficient \[-\].
    pub damping_ratio: f64,
    /// Coulomb friction \[-\].
    pub friction: f64,
}

impl LinearFrictional {
    #[inline(always)]
    fn slider(&self, effective_mass: f64) -> Slider {
        let damping = self.damping_ratio * self.normal.damping_factor * effective_mass.sqrt();
        Slider { stiffness: self.tangential_stiffness, damping }
    }
}

impl<D: Dim> ContactLaw<D> for LinearFrictional {
    type Memory = D::Spin;
    const TANGENTIAL: bool = true;
    const NAME: &'static str = "linear with friction";

    fn between(properties: &PairProperties, tension: Tension) -> Self {
        Self {
            normal: <LinearNormal as ContactLaw<D>>::between(properties, tension),
            tangential_stiffness: properties.tangential_stiffness,
            damping_ratio: properties.damping_ratio,
            friction: properties.friction,
        }
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Meeting<D>,
        memory: &mut D::Spin,
        tally: &mut Tally<LEDGER>,
    ) -> Load<D> {
        let mut load: Load<D> = self.normal.load(m, &mut (), tally);
        let cap = self.friction * load.normal.max(0.0);
        *memory = D::follow(*memory, m.normal, m.twist * m.dt);
        let slid = self.slider(m.effective_mass).load(memory, &Motion::of(m, m.slip, m.start_slip), cap);
        tally.tangential_damping(|| slid.damped);
        tally.sliding(|| slid.slid);
        load.tangential = slid.force;
        load
    }

    #[inline(always)]
    fn release<const LEDGER: bool>(&self, memory: &D::Spin, tally: &mut Tally<LEDGER>) {
        tally.tangential_damping(|| self.slider(1.0).held(*memory));
    }

    fn reversed(memory: D::Spin) -> D::Spin {
        // n and xi both change sign, so n x xi does not.
        memory
    }

    fn at_rest(&self, m: &Meeting<D>, memory: D::Spin) -> (Load<D>, f64) {
        let (mut load, energy) = self.normal.at_rest(m, ());
        let cap = self.friction * load.normal.max(0.0);
        let (force, stored) = self.slider(m.effective_mass).at_rest(memory, m.slip, m.last_dt, cap);
        load.tangential = force;
        (load, energy + stored)
    }
}

/// [`LinearFrictional`] with a rolling spring of the same stiffness and damping, its moment
/// capped at `rolling_friction * F_n * effective radius` \[DEM-9; Luding2008, eq. 31-37\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearRolling {
    /// Normal and tangential.
    pub frictional: LinearFrictional,
    /// Rolling resistance \[-\].
    pub rolling_friction: f64,
}

impl<D: Dim> ContactLaw<D> for LinearRolling {
    type Memory = [D::Spin; 2];
    const TANGENTIAL: bool = true;
    const NAME: &'static str = "linear with friction and rolling resistance";

    fn between(properties: &PairProperties, tension: Tension) -> Self {
        Self {
            frictional: <LinearFrictional as ContactLaw<D>>::between(properties, tension),
            rolling_friction: properties.rolling_friction,
        }
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Meeting<D>,
        [sliding, rolling]: &mut [D::Spin; 2],
        tally: &mut Tally<LEDGER>,
    ) -> Load<D> {
        let mut load: Load<D> = self.frictional.load(m, sliding, tally);
        let cap = self.rolling_friction * load.normal.max(0.0);
        *rolling = D::follow(*rolling, m.normal, m.twist * m.dt);
        let motion = Motion::of(m, m.roll * m.effective_radius, m.start_roll * m.effective_radius);
        let slid = self.frictional.slider(m.effective_mass).load(rolling, &motion, cap);
        tally.rolling(|| slid.damped + slid.slid);
        load.rolling = slid.force * m.effective_radius;
        load
    }

    #[inline(always)]
    fn release<const LEDGER: bool>(&self, [sliding, rolling]: &[D::Spin; 2], tally: &mut Tally<LEDGER>) {
        let slider = self.frictional.slider(1.0);
        tally.tangential_damping(|| slider.held(*sliding));
        tally.rolling(|| slider.held(*rolling));
    }

    fn reversed([sliding, rolling]: [D::Spin; 2]) -> [D::Spin; 2] {
        [sliding, -rolling]
    }

    fn at_rest(&self, m: &Meeting<D>, [sliding, rolling]: [D::Spin; 2]) -> (Load<D>, f64) {
        let (mut load, energy) = self.frictional.at_rest(m, sliding);
        let cap = self.rolling_friction * load.normal.max(0.0);
        let rate = m.roll * m.effective_radius;
        let (force, stored) = self.frictional.slider(m.effective_mass).at_rest(rolling, rate, m.last_dt, cap);
        load.rolling = force * m.effective_radius;
        (load, energy + stored)
    }
}
