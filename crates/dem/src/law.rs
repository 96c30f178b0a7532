//! Contact laws: from the motion of two bodies at their contact to the load between them.
//!
//! Symbols of this module: `k` stiffness, `c` damping, `n` the unit normal from the second to
//! the first body, `xi` tangential displacement. Tangential quantities are kept as `n x ...`
//! (see [`granular_core::dim`]), so one source serves disks and spheres.
//!
//! The spring of a contact is laid into the tangent plane as the normal turns, its length kept. What turns about the
//! normal is a convention: here the spring of two spheres turns about it with the mean of both spins, so that the force
//! in a pair that turns as one stays what it is in the frame of the pair. Other codes leave this turn out; results differ
//! where spheres that stick spin about their normal, and [`SpringTurning`](crate::SpringTurning) offers both.

mod hertz;
mod linear;
mod resistance;
mod slider;

pub use hertz::{HertzMindlin, HertzNormal};
pub use linear::{LinearFrictional, LinearNormal};
pub use resistance::{LinearRolling, Rolling, Twisting};
pub use slider::{Motion, Slid, Slider};

use crate::ledger::Tally;
use crate::material::{PairProperties, Tension};
use granular_core::{Dim, Linear, Stored};
use std::fmt::Debug;

/// Two bodies at their contact, at the middle of a step.
#[derive(Clone, Copy, Debug)]
pub struct Kinematics<D: Dim> {
    /// Unit vector from the second to the first body.
    pub normal: D::Vec,
    /// Distance of the surfaces in the middle of the step \[m\]; negative where they overlap.
    pub gap: f64,
    /// Overlap \[m\], averaged over the part of the step before and after the surfaces meet.
    pub overlap: f64,
    /// Share of the step during which the surfaces overlap, 0 to 1.
    pub presence: f64,
    /// Speed of approach along the normal \[m/s\].
    pub approach: f64,
    /// The same at the start of the step \[m/s\]; only for the ledger.
    pub start_approach: f64,
    /// `n x` velocity of the first surface past the second \[m/s\].
    pub slip: D::Spin,
    /// Tangential part of the difference of spins \[rad/s\].
    pub roll: D::Spin,
    /// The slip at the start of the step \[m/s\], with which grains move from the middle of the last
    /// step to the middle of this one. Springs follow it; `slip` is a prediction, for dashpots only.
    pub start_slip: D::Spin,
    /// The roll at the start of the step \[rad/s\].
    pub start_roll: D::Spin,
    /// Spin about the normal with which tangential springs turn \[rad/s\]: the mean of both at the start of the step, or
    /// nothing, see [`SpringTurning`](crate::SpringTurning).
    pub twist: f64,
    /// Difference of the spins about the normal \[rad/s\]; only for laws that resist twisting.
    pub twisting: f64,
    /// The same at the start of the step \[rad/s\].
    pub start_twisting: f64,
    /// `m1 m2 / (m1 + m2)` \[kg\].
    pub effective_mass: f64,
    /// `r1 r2 / (r1 + r2)` \[m\].
    pub effective_radius: f64,
    /// The step \[s\].
    pub dt: f64,
    /// The step before \[s\].
    pub last_dt: f64,
}

impl<D: Dim> Kinematics<D> {
    /// Energy lost over the step \[J\] in a normal dashpot of damping `c` \[N s/m\], in a contact that pushes with
    /// `force`, of which `elastic` by its spring \[N\]. Where the cut of tension acts, the force is zero, and the dashpot
    /// takes up what the spring gives back.
    ///
    /// The dashpot acts with the predicted speed `p`, but grains move by the mean `u` of the speeds at both ends of the
    /// step, which is known when it is over: it takes `c p u`. With `a` the acceleration at the middle, `u - p` is `dt/2`
    /// times the change of `a` since the last step, and `p` changes by `a dt` from step to step, so that, summed by
    /// parts over a contact, `c p (u - p)` is `-c (a dt)^2 / 2`, where `a dt/2` of the last step is `p` less the speed at
    /// the start. The terms at both ends are there because a dashpot acts at once.
    #[inline(always)]
    pub fn damped(&self, force: f64, elastic: f64, damping: f64) -> f64 {
        let (dt, approach, presence) = (self.dt, self.approach, self.presence);
        let gained = approach - self.start_approach;
        let damping = if force == 0.0 { 0.0 } else { damping };
        let lost = (force - elastic) * approach - 2.0 * presence * damping * gained * gained;
        if presence >= 1.0 {
            return lost * dt;
        }
        let absent = 1.0 - presence;
        let jump = if approach > 0.0 {
            absent * force
        } else {
            -(absent + presence * presence) * damping * approach
        };
        (lost + 0.5 * dt / self.effective_mass * damping * approach * jump) * dt
    }

    /// What a linear spring `k` keeps of the motion over a contact \[J\], booked in its first and last step.
    ///
    /// It acts with the overlap after half a step at the speed of its start, which is less than the mean overlap of the
    /// step by `a dt^2 / 4`. Over a contact `k a dt^2 / 4` at the speed `v` adds up to `k dt^2 / 8` times the change of
    /// `v^2`, nothing when the contact is elastic.
    #[inline(always)]
    pub fn kept(&self, stiffness: f64) -> f64 {
        if self.presence < 1.0 {
            0.125 * stiffness * self.dt * self.dt * self.approach * self.approach.abs()
        } else {
            0.0
        }
    }
}

/// What a contact does to the first body; the second gets the opposite.
#[derive(Clone, Copy, Debug)]
pub struct ContactLoad<D: Dim> {
    /// Force along the normal \[N\], positive when it repels.
    pub normal: f64,
    /// `n x` tangential force \[N\].
    pub tangential: D::Spin,
    /// Rolling and twisting moment \[N m\].
    pub rolling: D::Spin,
}

impl<D: Dim> ContactLoad<D> {
    /// A load along the normal.
    #[inline(always)]
    pub fn along_normal(force: f64) -> Self {
        Self { normal: force, tangential: D::Spin::ZERO, rolling: D::Spin::ZERO }
    }
}

/// What bounds the step of a contact: its stiffest state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawLimits {
    /// Normal stiffness \[N/m\].
    pub normal_stiffness: f64,
    /// Normal damping \[N s/m\].
    pub normal_damping: f64,
    /// Tangential stiffness \[N/m\]; zero without a tangential spring.
    pub tangential_stiffness: f64,
    /// Tangential damping \[N s/m\].
    pub tangential_damping: f64,
}

/// A contact law, a value with its own parameters. Statically typed in the kernels: pass any implementation to
/// [`Dem::with_law`](crate::Dem::with_law).
///
/// A law that acts before surfaces overlap (cohesion, capillary bridges) says so by [`REACHES`](Self::REACHES) and
/// [`reach`](Self::reach); then `load` is also called for surfaces that are apart by less, with their distance as
/// [`Kinematics::gap`], and a contact lasts as long as the law [`acts`](Self::acts).
pub trait ContactLaw<D: Dim>: Copy + Debug + Send + Sync + 'static {
    /// What one contact remembers between steps; `()` when nothing. The default is a fresh contact.
    type Memory: Copy + Default + PartialEq + Stored + Debug + Send + Sync + 'static;
    /// Whether tangential motion matters: without it grains do not turn and have no spin.
    const TANGENTIAL: bool;
    /// Whether the law reads [`Kinematics::twisting`].
    const TWISTING: bool = false;
    /// Name, for reports.
    const NAME: &'static str;

    /// Whether the law may act on surfaces that do not overlap. What serves such laws is not in the kernels of others.
    const REACHES: bool = false;

    /// The law as it is between two materials; the same for all unless it takes something from them.
    fn for_pair(&self, properties: &PairProperties, tension: Tension) -> Self {
        let _ = (properties, tension);
        *self
    }
    /// Distance of surfaces \[m\] up to which the law may act.
    fn reach(&self) -> f64 {
        0.0
    }
    /// Whether the law acts on surfaces at this distance \[m\], negative where they overlap, with what the contact
    /// remembers; only asked of laws with a reach. What it answers for overlapping surfaces does not matter.
    #[inline(always)]
    fn acts(&self, gap: f64, memory: &Self::Memory) -> bool {
        let _ = memory;
        gap < self.reach()
    }
    /// The stiffest state of a contact of this effective mass \[kg\], from which the limits on the step follow; none where
    /// those of the materials hold.
    fn limits(&self, effective_mass: f64) -> Option<LawLimits> {
        let _ = effective_mass;
        None
    }
    /// Whether the law reads `slip` and `roll` of a [`Kinematics`], the motion across the contact in the
    /// middle of the step as predicted. They are zero, and cost nothing, when no law of a
    /// simulation does.
    fn predicts(&self) -> bool {
        true
    }
    /// The load over one step; dissipation is told to the tally.
    fn load<const LEDGER: bool>(
        &self,
        kinematics: &Kinematics<D>,
        memory: &mut Self::Memory,
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D>;
    /// Tells the tally of energy that was still stored when a contact ended.
    #[inline(always)]
    fn release<const LEDGER: bool>(&self, memory: &Self::Memory, tally: &mut Tally<LEDGER>) {
        let _ = (memory, tally);
    }
    /// The same contact seen from the second body.
    fn reversed(memory: Self::Memory) -> Self::Memory;
    /// The tangential spring \[m\] that a contact remembers, as `n x` the displacement of the first body, at the time between
    /// steps; zero for laws without one.
    fn spring(&self, kinematics: &Kinematics<D>, memory: &Self::Memory) -> D::Spin {
        let _ = (kinematics, memory);
        D::Spin::ZERO
    }
    /// The memory with such a spring in place of its own; none for laws that remember none.
    fn with_spring(
        &self,
        kinematics: &Kinematics<D>,
        memory: Self::Memory,
        spring: D::Spin,
    ) -> Option<Self::Memory> {
        let _ = (kinematics, memory, spring);
        None
    }
    /// The load between steps and the energy stored in springs \[J\], for output. The step of the
    /// kinematics is the last one taken.
    fn at_rest(&self, kinematics: &Kinematics<D>, memory: Self::Memory) -> (ContactLoad<D>, f64);
}

/// A law that follows from the properties of materials.
pub trait MaterialLaw<D: Dim>: ContactLaw<D> {
    /// The law between two materials.
    fn between(properties: &PairProperties, tension: Tension) -> Self;
}

/// A law with a tangential spring, whose stiffness and damping may also resist rolling and
/// twisting ([`Rolling`], [`Twisting`]).
pub trait Frictional<D: Dim>: MaterialLaw<D> {
    /// Names of the law with rolling resistance, and with rolling and twisting resistance.
    const RESISTING: [&'static str; 2];
    /// Stiffness and damping of the tangential spring in these kinematics.
    fn slider(&self, kinematics: &Kinematics<D>) -> Slider;
    /// Stiffness that springs had at the last step \[N/m\].
    fn last_stiffness(&self, last: &Self::Memory) -> f64;
    /// Carries a spring from the last step over to a stiffness that changed since; returns the
    /// energy that this takes \[J\]. `advance` is how far the spring will move in this step.
    #[inline(always)]
    fn carry<S: Linear>(&self, last: &Self::Memory, slider: &Slider, spring: &mut S, advance: S) -> f64 {
        let _ = (last, slider, spring, advance);
        0.0
    }
    /// Energy that a spring holds when its contact ends \[J\].
    fn held<S: Linear>(&self, last: &Self::Memory, spring: S) -> f64;
}
