//! Linear springs and dashpots.

use super::slider::{Motion, Slider};
use super::{ContactLaw, ContactLoad, Frictional, Kinematics, MaterialLaw};
use crate::ledger::Tally;
use crate::material::{PairProperties, Tension};
use granular_core::{Dim, Linear};

/// Linear spring and dashpot along the normal, `F = k delta + c approach` \[DEM-3\].
///
/// The damping is solved per pair from the restitution asked for, `c = 2 zeta sqrt(m_eff k)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearNormal {
    /// Normal stiffness \[N/m\].
    pub stiffness: f64,
    /// `2 zeta sqrt(k)`: times the root of the effective mass it is the damping that follows from the restitution; zero where
    /// the damping is given.
    pub damping_factor: f64,
    /// Damping that is given, whatever the masses \[N s/m\]; else zero.
    pub damping: f64,
    /// Whether parting contacts may pull.
    pub tension: Tension,
}

impl LinearNormal {
    /// Damping of a contact of this effective mass.
    #[inline(always)]
    fn damping(&self, effective_mass: f64) -> f64 {
        self.damping_factor * effective_mass.sqrt() + self.damping
    }

    #[inline(always)]
    fn force(&self, overlap: f64, presence: f64, approach: f64, damping: f64) -> f64 {
        let force = self.stiffness * overlap + presence * damping * approach;
        if self.tension == Tension::Cut { force.max(0.0) } else { force }
    }
}

impl<D: Dim> MaterialLaw<D> for LinearNormal {
    fn between(properties: &PairProperties, tension: Tension) -> Self {
        let stiffness = properties.normal_stiffness;
        let given = properties.normal_damping;
        let factor = || 2.0 * properties.zeta(tension) * stiffness.sqrt();
        Self {
            stiffness,
            damping_factor: if given.is_some() { 0.0 } else { factor() },
            damping: given.unwrap_or(0.0),
            tension,
        }
    }
}

impl<D: Dim> ContactLaw<D> for LinearNormal {
    type Memory = ();
    const TANGENTIAL: bool = false;
    const NAME: &'static str = "linear without friction";

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (): &mut (),
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let damping = self.damping(m.effective_mass);
        let force = self.force(m.overlap, m.presence, m.approach, damping);
        tally
            .normal_damping(|| m.damped(force, self.stiffness * m.overlap, damping) + m.kept(self.stiffness));
        ContactLoad::along_normal(force)
    }

    fn reversed((): ()) {}

    fn at_rest(&self, m: &Kinematics<D>, (): ()) -> (ContactLoad<D>, f64) {
        let damping = self.damping(m.effective_mass);
        let force = self.force(m.overlap, 1.0, m.approach, damping);
        (ContactLoad::along_normal(force), 0.5 * self.stiffness * m.overlap * m.overlap)
    }
}

/// [`LinearNormal`] with a tangential spring under a Coulomb cap \[DEM-6, DEM-7\]. How the spring of spheres turns about
/// their normal is a choice: [`SpringTurning`](crate::SpringTurning).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearFrictional {
    /// Along the normal.
    pub normal: LinearNormal,
    /// Tangential stiffness \[N/m\].
    pub tangential_stiffness: f64,
    /// Tangential over normal damping coefficient \[-\]; zero where the tangential damping is given.
    pub damping_ratio: f64,
    /// Tangential damping that is given \[N s/m\]; else zero.
    pub damping: f64,
    /// Coulomb friction \[-\].
    pub friction: f64,
}

impl LinearFrictional {
    #[inline(always)]
    fn slider(&self, effective_mass: f64) -> Slider {
        let of_ratio = self.damping_ratio * self.normal.damping_factor * effective_mass.sqrt();
        let damping = of_ratio + (self.damping_ratio * self.normal.damping + self.damping);
        Slider { stiffness: self.tangential_stiffness, damping }
    }
}

impl<D: Dim> Frictional<D> for LinearFrictional {
    const RESISTING: [&'static str; 2] = [
        "linear with friction and rolling resistance",
        "linear with friction, rolling and twisting resistance",
    ];

    #[inline(always)]
    fn slider(&self, kinematics: &Kinematics<D>) -> Slider {
        self.slider(kinematics.effective_mass)
    }

    #[inline(always)]
    fn last_stiffness(&self, _: &D::Spin) -> f64 {
        self.tangential_stiffness
    }

    #[inline(always)]
    fn held<S: Linear>(&self, _: &D::Spin, spring: S) -> f64 {
        0.5 * self.tangential_stiffness * spring.length_squared()
    }
}

impl<D: Dim> MaterialLaw<D> for LinearFrictional {
    fn between(properties: &PairProperties, tension: Tension) -> Self {
        Self {
            normal: <LinearNormal as MaterialLaw<D>>::between(properties, tension),
            tangential_stiffness: properties.tangential_stiffness,
            damping_ratio: if properties.tangential_damping.is_some() {
                0.0
            } else {
                properties.damping_ratio
            },
            damping: properties.tangential_damping.unwrap_or(0.0),
            friction: properties.friction,
        }
    }
}

impl<D: Dim> ContactLaw<D> for LinearFrictional {
    type Memory = D::Spin;
    const TANGENTIAL: bool = true;
    const NAME: &'static str = "linear with friction";

    fn predicts(&self) -> bool {
        self.damping_ratio > 0.0 || self.damping > 0.0
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        memory: &mut D::Spin,
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let mut load: ContactLoad<D> = self.normal.load(m, &mut (), tally);
        let cap = self.friction * load.normal.max(0.0);
        *memory = D::follow(*memory, m.normal, m.twist * m.dt);
        let slid = self.slider(m.effective_mass).load(memory, &Motion::of(m, m.slip, m.start_slip), cap);
        tally.tangential_damping(|| slid.damped);
        tally.sliding(|| slid.lost(self.friction));
        load.tangential = slid.force;
        load
    }

    #[inline(always)]
    fn release<const LEDGER: bool>(&self, memory: &D::Spin, tally: &mut Tally<LEDGER>) {
        let held = || Frictional::<D>::held(self, memory, *memory);
        // A dashpot lets the spring go; without one it slides back.
        if self.damping_ratio > 0.0 || self.damping > 0.0 {
            tally.tangential_damping(held);
        } else if self.friction > 0.0 {
            tally.sliding(held);
        }
    }

    fn reversed(memory: D::Spin) -> D::Spin {
        // n and xi both change sign, so n x xi does not.
        memory
    }

    fn spring(&self, m: &Kinematics<D>, memory: &D::Spin) -> D::Spin {
        Slider::now(*memory, m)
    }

    fn with_spring(&self, m: &Kinematics<D>, _: D::Spin, spring: D::Spin) -> Option<D::Spin> {
        Some(Slider::half_a_step_ago(spring, m))
    }

    fn at_rest(&self, m: &Kinematics<D>, memory: D::Spin) -> (ContactLoad<D>, f64) {
        let (mut load, energy) = self.normal.at_rest(m, ());
        let cap = self.friction * load.normal.max(0.0);
        let slider = self.slider(m.effective_mass);
        let (force, stored) = slider.at_rest(memory, m.slip, (m.last_dt, self.tangential_stiffness), cap);
        load.tangential = force;
        (load, energy + stored)
    }
}
