//! Resistance against rolling.

use super::linear::LinearFrictional;
use super::slider::Motion;
use super::{ContactLaw, Load, Meeting};
use crate::ledger::Tally;
use crate::material::{PairProperties, Tension};
use granular_core::Dim;

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
