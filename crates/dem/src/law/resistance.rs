//! Resistance against rolling and twisting, for any law with a tangential spring.

use super::linear::LinearFrictional;
use super::slider::Motion;
use super::{ContactLaw, ContactLoad, Frictional, Kinematics, MaterialLaw};
use crate::ledger::Tally;
use crate::material::{PairProperties, Tension};
use granular_core::Dim;

/// A law with a rolling spring of the same stiffness and damping as its tangential one, its
/// moment capped at `rolling_friction * F_n * effective radius` \[DEM-9; Luding2008, eq. 31-37\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling<F> {
    /// Normal and tangential.
    pub frictional: F,
    /// Rolling resistance \[-\].
    pub rolling_friction: f64,
}

impl<D: Dim, F: Frictional<D>> MaterialLaw<D> for Rolling<F> {
    fn between(properties: &PairProperties, tension: Tension) -> Self {
        Self { frictional: F::between(properties, tension), rolling_friction: properties.rolling_friction }
    }
}

impl<D: Dim, F: Frictional<D>> ContactLaw<D> for Rolling<F> {
    type Memory = (F::Memory, D::Spin);
    const TANGENTIAL: bool = true;
    const NAME: &'static str = F::RESISTING[0];

    fn predicts(&self) -> bool {
        ContactLaw::<D>::predicts(&self.frictional)
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (grip, rolling): &mut (F::Memory, D::Spin),
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let last = *grip;
        let mut load: ContactLoad<D> = self.frictional.load(m, grip, tally);
        let cap = self.rolling_friction * load.normal.max(0.0);
        *rolling = D::follow(*rolling, m.normal, m.twist * m.dt);
        let motion = Motion::of(m, m.roll * m.effective_radius, m.start_roll * m.effective_radius);
        let slider = self.frictional.slider(m);
        let advance = motion.start_rate * motion.advances().0;
        let carried = self.frictional.carry(&last, &slider, rolling, advance);
        let slid = slider.load(rolling, &motion, cap);
        tally.rolling(|| carried + slid.damped + slid.lost(self.rolling_friction));
        load.rolling = slid.force * m.effective_radius;
        load
    }

    #[inline(always)]
    fn release<const LEDGER: bool>(&self, (grip, rolling): &(F::Memory, D::Spin), tally: &mut Tally<LEDGER>) {
        self.frictional.release(grip, tally);
        tally.rolling(|| self.frictional.held(grip, *rolling));
    }

    fn reversed((grip, rolling): (F::Memory, D::Spin)) -> (F::Memory, D::Spin) {
        (F::reversed(grip), -rolling)
    }

    fn spring(&self, m: &Kinematics<D>, memory: &(F::Memory, D::Spin)) -> D::Spin {
        self.frictional.spring(m, &memory.0)
    }

    fn with_spring(
        &self,
        m: &Kinematics<D>,
        (grip, rolling): (F::Memory, D::Spin),
        spring: D::Spin,
    ) -> Option<(F::Memory, D::Spin)> {
        Some((self.frictional.with_spring(m, grip, spring)?, rolling))
    }

    fn at_rest(&self, m: &Kinematics<D>, (grip, rolling): (F::Memory, D::Spin)) -> (ContactLoad<D>, f64) {
        let (mut load, energy) = self.frictional.at_rest(m, grip);
        let cap = self.rolling_friction * load.normal.max(0.0);
        let (rate, last) = (m.roll * m.effective_radius, self.frictional.last_stiffness(&grip));
        let (force, stored) = self.frictional.slider(m).at_rest(rolling, rate, (m.last_dt, last), cap);
        load.rolling = force * m.effective_radius;
        (load, energy + stored)
    }
}

/// [`LinearFrictional`] with rolling resistance.
pub type LinearRolling = Rolling<LinearFrictional>;

/// [`Rolling`] with a spring against twisting, turning of two grains about their normal: again of
/// the same stiffness and damping, its moment capped at `twisting_friction * F_n * effective
/// radius` \[Luding2008\]. Its losses are booked as those of rolling. Only spheres twist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twisting<F> {
    /// Normal, tangential and rolling.
    pub rolling: Rolling<F>,
    /// Twisting resistance \[-\].
    pub twisting_friction: f64,
}

/// Memory of [`Rolling`], and the twisting spring \[m\].
type Twisted<D, F> = (<Rolling<F> as ContactLaw<D>>::Memory, f64);

impl<D: Dim, F: Frictional<D>> MaterialLaw<D> for Twisting<F> {
    fn between(properties: &PairProperties, tension: Tension) -> Self {
        Self {
            rolling: <Rolling<F> as MaterialLaw<D>>::between(properties, tension),
            twisting_friction: properties.twisting_friction,
        }
    }
}

impl<D: Dim, F: Frictional<D>> ContactLaw<D> for Twisting<F> {
    type Memory = Twisted<D, F>;
    const TANGENTIAL: bool = true;
    const TWISTING: bool = true;
    const NAME: &'static str = F::RESISTING[1];

    fn predicts(&self) -> bool {
        ContactLaw::<D>::predicts(&self.rolling)
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (rolling, twisting): &mut Twisted<D, F>,
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let last = rolling.0;
        let mut load: ContactLoad<D> = self.rolling.load(m, rolling, tally);
        let cap = self.twisting_friction * load.normal.max(0.0);
        let radius = m.effective_radius;
        let motion = Motion::of(m, m.twisting * radius, m.start_twisting * radius);
        let frictional = &self.rolling.frictional;
        let slider = frictional.slider(m);
        let advance = motion.start_rate * motion.advances().0;
        let carried = frictional.carry(&last, &slider, twisting, advance);
        let slid = slider.load(twisting, &motion, cap);
        tally.rolling(|| carried + slid.damped + slid.lost(self.twisting_friction));
        load.rolling += D::about(m.normal, slid.force * radius);
        load
    }

    #[inline(always)]
    fn release<const LEDGER: bool>(&self, (rolling, twisting): &Twisted<D, F>, tally: &mut Tally<LEDGER>) {
        ContactLaw::<D>::release(&self.rolling, rolling, tally);
        tally.rolling(|| self.rolling.frictional.held(&rolling.0, *twisting));
    }

    fn reversed((rolling, twisting): Twisted<D, F>) -> Twisted<D, F> {
        // Both the normal and the difference of spins change sign.
        (<Rolling<F> as ContactLaw<D>>::reversed(rolling), twisting)
    }

    fn spring(&self, m: &Kinematics<D>, memory: &Twisted<D, F>) -> D::Spin {
        ContactLaw::<D>::spring(&self.rolling, m, &memory.0)
    }

    fn with_spring(
        &self,
        m: &Kinematics<D>,
        (rolling, twisting): Twisted<D, F>,
        spring: D::Spin,
    ) -> Option<Twisted<D, F>> {
        Some((self.rolling.with_spring(m, rolling, spring)?, twisting))
    }

    fn at_rest(&self, m: &Kinematics<D>, (rolling, twisting): Twisted<D, F>) -> (ContactLoad<D>, f64) {
        let (mut load, energy) = self.rolling.at_rest(m, rolling);
        let cap = self.twisting_friction * load.normal.max(0.0);
        let frictional = &self.rolling.frictional;
        let (rate, last) = (m.twisting * m.effective_radius, frictional.last_stiffness(&rolling.0));
        let (force, stored) = frictional.slider(m).at_rest(twisting, rate, (m.last_dt, last), cap);
        load.rolling += D::about(m.normal, force * m.effective_radius);
        (load, energy + stored)
    }
}
