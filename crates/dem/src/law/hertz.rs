//! Elastic spheres: Hertz along the normal, Mindlin across it.
//!
//! Symbols: `E* = effective modulus`, `G*` effective shear modulus, `R` effective radius, `m`
//! effective mass, `delta` overlap, `a = sqrt(R delta)` radius of the contact area.

use super::slider::{Motion, Slider};
use super::{ContactLaw, ContactLoad, Frictional, Kinematics, MaterialLaw};
use crate::ledger::Tally;
use crate::material::{PairProperties, Tension};
use granular_core::{Dim, Linear};
use std::f64::consts::FRAC_1_SQRT_2;

/// Hertz contact of two spheres with a dashpot whose restitution does not depend on the speed
/// \[DEM-12; Tsuji1992; AntypovElliott2011\],
///
/// ```text
/// F = 4/3 E* sqrt(R) delta^(3/2) + c approach        c = sqrt(5) zeta sqrt(4/3 E* sqrt(R) m) delta^(1/4)
/// ```
///
/// With `z = delta^(5/4)` in place of the overlap, the speed as a function of `z` is that of a
/// linear spring and dashpot of damping ratio `zeta` \[AntypovElliott2011\], and the force
/// vanishes where it does there. Restitution and `zeta` are therefore linked exactly as in the
/// linear law, for both treatments of tension. (The closed form usually quoted, `zeta = -ln e /
/// sqrt(ln^2 e + pi^2)`, is that of the tension kept.)
///
/// The dashpot starts like the fourth root of time. Its coefficient is therefore the mean over
/// the step for a uniform motion, not the value in the middle: the restitution is of second
/// order in the step, where the value in the middle leaves an error of order 5/4.
///
/// In the plane the same law holds per metre of depth, with the radius of the disk as that of a
/// sphere. It is a study of the form of the law: real cylinders touch along a line, and that
/// contact is almost linear (see [`Elasticity::cylinder_stiffness`](crate::Elasticity)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzNormal {
    /// Effective modulus `E*` \[Pa\].
    pub modulus: f64,
    /// `c / sqrt(m a)`: `sqrt(5) zeta sqrt(4/3 E*)`.
    pub damping_factor: f64,
    /// Whether parting contacts may pull.
    pub tension: Tension,
}

/// A contact area in one step.
struct Area {
    /// Radius for the tangential stiffness \[m\].
    radius: f64,
    /// Elastic force, mean over the step \[N\].
    force: f64,
    /// Normal damping, mean over the part of the step with overlap \[N s/m\].
    damping: f64,
}

impl HertzNormal {
    #[inline(always)]
    fn area<D: Dim>(&self, m: &Kinematics<D>) -> Area {
        let stiffness = 4.0 / 3.0 * self.modulus;
        if m.presence < 1.0 {
            // The overlap runs from zero to `deepest` or back.
            let deepest = 2.0 * m.overlap / m.presence;
            let radius = (m.effective_radius * deepest).sqrt();
            let force = 0.4 * m.presence * stiffness * radius * deepest;
            let damping = 0.8 * self.damping_factor * (m.effective_mass * radius).sqrt();
            return Area { radius: radius * FRAC_1_SQRT_2, force, damping };
        }
        let radius = (m.effective_radius * m.overlap).sqrt();
        let damping = self.damping_factor * (m.effective_mass * radius).sqrt();
        let change = 0.5 * m.approach.abs() * m.dt;
        let mean = if change > 0.0 { mean_fourth_root(change / m.overlap) } else { 1.0 };
        Area { radius, force: stiffness * radius * m.overlap, damping: damping * mean }
    }

    #[inline(always)]
    fn force(&self, area: &Area, presence: f64, approach: f64) -> f64 {
        let force = area.force + presence * area.damping * approach;
        if self.tension == Tension::Cut { force.max(0.0) } else { force }
    }

    #[inline(always)]
    fn load_on<D: Dim, const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        area: &Area,
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let force = self.force(area, m.presence, m.approach);
        // Of what the prediction adds, the spring keeps half (see `Kinematics::kept`) in a linear contact, and nearly so in an
        // impact of this one: the balance is better by 4 to 40 times.
        tally.normal_damping(|| m.damped(force, area.force, 0.5 * area.damping));
        ContactLoad::along_normal(force)
    }

    fn rest<D: Dim>(&self, m: &Kinematics<D>) -> (ContactLoad<D>, f64) {
        let area = self.area(m);
        (ContactLoad::along_normal(self.force(&area, 1.0, m.approach)), 0.4 * area.force * m.overlap)
    }
}

/// Mean of `(1 + x)^(1/4)` over `-s < x < s`, for `s` up to 1.
#[inline(always)]
fn mean_fourth_root(s: f64) -> f64 {
    if s < 0.25 {
        // The series of the other branch, to 1e-9.
        let q = s * s;
        return 1.0
            - q * (0.03125 + q * (0.007_519_531_25 + q * (0.003_189_086_914 + q * 0.001_719_117_165)));
    }
    let power = |x: f64| x * x.sqrt().sqrt();
    (power(1.0 + s) - power(1.0 - s)) * 0.4 / s
}

impl<D: Dim> MaterialLaw<D> for HertzNormal {
    fn between(properties: &PairProperties, tension: Tension) -> Self {
        let modulus = properties.effective_modulus;
        let damping_factor = (20.0 / 3.0 * modulus).sqrt() * properties.zeta(tension);
        Self { modulus, damping_factor, tension }
    }
}

impl<D: Dim> ContactLaw<D> for HertzNormal {
    type Memory = ();
    const TANGENTIAL: bool = false;
    const NAME: &'static str = "Hertz without friction";

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (): &mut (),
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        self.load_on(m, &self.area(m), tally)
    }

    fn reversed((): ()) {}

    fn at_rest(&self, m: &Kinematics<D>, (): ()) -> (ContactLoad<D>, f64) {
        self.rest(m)
    }
}

/// [`HertzNormal`] with the tangential spring of \[Mindlin1949\] without partial slip, `k = 8 G*
/// a`, under a Coulomb cap.
///
/// The stiffness changes with the overlap, and the spring with it: see [`Slider::carry`]. What
/// that takes stands for the slip in the outer ring of the area, and is booked as sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzMindlin {
    /// Along the normal.
    pub normal: HertzNormal,
    /// Effective shear modulus `G*` \[Pa\].
    pub shear_modulus: f64,
    /// Tangential over normal damping coefficient \[-\].
    pub damping_ratio: f64,
    /// Coulomb friction \[-\].
    pub friction: f64,
}

impl HertzMindlin {
    #[inline(always)]
    fn slider_on(&self, area: &Area) -> Slider {
        Slider {
            stiffness: 8.0 * self.shear_modulus * area.radius,
            damping: self.damping_ratio * area.damping,
        }
    }
}

impl<D: Dim> Frictional<D> for HertzMindlin {
    const RESISTING: [&'static str; 2] =
        ["Hertz-Mindlin with rolling resistance", "Hertz-Mindlin with rolling and twisting resistance"];

    #[inline(always)]
    fn slider(&self, kinematics: &Kinematics<D>) -> Slider {
        self.slider_on(&self.normal.area(kinematics))
    }

    #[inline(always)]
    fn last_stiffness(&self, &(_, stiffness): &(D::Spin, f64)) -> f64 {
        stiffness
    }

    #[inline(always)]
    fn carry<S: Linear>(&self, last: &(D::Spin, f64), slider: &Slider, spring: &mut S, advance: S) -> f64 {
        slider.carry(spring, last.1, advance)
    }

    #[inline(always)]
    fn held<S: Linear>(&self, &(_, stiffness): &(D::Spin, f64), spring: S) -> f64 {
        0.5 * stiffness * spring.length_squared()
    }
}

impl<D: Dim> MaterialLaw<D> for HertzMindlin {
    fn between(properties: &PairProperties, tension: Tension) -> Self {
        Self {
            normal: <HertzNormal as MaterialLaw<D>>::between(properties, tension),
            shear_modulus: properties.effective_shear_modulus,
            damping_ratio: properties.damping_ratio,
            friction: properties.friction,
        }
    }
}

impl<D: Dim> ContactLaw<D> for HertzMindlin {
    /// The spring \[m\] and its stiffness at the last step \[N/m\].
    type Memory = (D::Spin, f64);
    const TANGENTIAL: bool = true;
    const NAME: &'static str = "Hertz-Mindlin";

    fn predicts(&self) -> bool {
        self.damping_ratio > 0.0
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (spring, stiffness): &mut (D::Spin, f64),
        tally: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        let area = self.normal.area(m);
        let mut load: ContactLoad<D> = self.normal.load_on(m, &area, tally);
        let cap = self.friction * load.normal.max(0.0);
        *spring = D::follow(*spring, m.normal, m.twist * m.dt);
        let (motion, slider) = (Motion::of(m, m.slip, m.start_slip), self.slider_on(&area));
        let carried = slider.carry(spring, *stiffness, motion.start_rate * motion.advances().0);
        *stiffness = slider.stiffness;
        let slid = slider.load(spring, &motion, cap);
        tally.tangential_damping(|| slid.damped);
        tally.sliding(|| carried + slid.lost(self.friction));
        load.tangential = slid.force;
        load
    }

    #[inline(always)]
    fn release<const LEDGER: bool>(&self, memory: &(D::Spin, f64), tally: &mut Tally<LEDGER>) {
        tally.tangential_damping(|| Frictional::<D>::held(self, memory, memory.0));
    }

    fn reversed(memory: (D::Spin, f64)) -> (D::Spin, f64) {
        memory
    }

    fn spring(&self, m: &Kinematics<D>, memory: &(D::Spin, f64)) -> D::Spin {
        Slider::now(memory.0, m)
    }

    /// The stiffness is that of the present overlap.
    fn with_spring(&self, m: &Kinematics<D>, _: (D::Spin, f64), spring: D::Spin) -> Option<(D::Spin, f64)> {
        let stiffness = self.slider_on(&self.normal.area(m)).stiffness;
        Some((Slider::half_a_step_ago(spring, m), stiffness))
    }

    fn at_rest(&self, m: &Kinematics<D>, (spring, stiffness): (D::Spin, f64)) -> (ContactLoad<D>, f64) {
        let (mut load, energy): (ContactLoad<D>, f64) = self.normal.rest(m);
        let cap = self.friction * load.normal.max(0.0);
        let slider = self.slider_on(&self.normal.area(m));
        let (force, stored) = slider.at_rest(spring, m.slip, (m.last_dt, stiffness), cap);
        load.tangential = force;
        (load, energy + stored)
    }
}

#[cfg(test)]
mod tests {
    use super::mean_fourth_root;

    #[test]
    fn the_mean_of_the_fourth_root_is_right_on_both_branches() {
        for s in [1e-6, 0.01, 0.1, 0.2499, 0.2501, 0.5, 0.9, 1.0] {
            let parts = 200_000;
            let at = |k: i32| 1.0 + s * (2.0 * (f64::from(k) + 0.5) / f64::from(parts) - 1.0);
            let mean = (0..parts).map(|k| at(k).powf(0.25)).sum::<f64>() / f64::from(parts);
            assert!((mean_fourth_root(s) - mean).abs() < 2e-8, "{s}: {} {mean}", mean_fourth_root(s));
        }
    }
}
