//! Mohr-Coulomb plasticity.

mod cut;
mod pyramid;
#[cfg(test)]
mod tests;

use crate::axes::Axes;
use crate::elastic::LinearElastic;
use crate::gap;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use cut::Cut;
use granular_core::{SetupError, SymmetricTensor};
use pyramid::Pyramid;

/// Linear elasticity up to the strength of Mohr-Coulomb, `s1 - s3 = -(s1 + s3) sin(phi) + 2 c cos(phi)`, then perfectly plastic flow
/// with the angle of dilation.
///
/// Written with `k = (1 + sin phi) / (1 - sin phi)` the yield function is `f = k s1 - s3 - 2 c sqrt(k)`, for principal stresses
/// `s1 >= s2 >= s3`, positive in tension. The return of the trial stress to plane, edges and apex is exact for any
/// size of the increment \[Clausen2006\], \[DeSouzaNeto2008, section 8.2\]; it keeps the principal directions.
///
/// `CUT` adds a tensile strength `s1 <= T` with associated flow ([`MohrCoulomb::with_tensile_strength`]); its faces, edges and
/// corners are exact as well.
///
/// Where no tension at all is carried (no cohesion, or a tensile strength of zero), material that is pulled from all sides separates:
/// the volumetric strain of the gap is kept and must be closed before anything is carried again. Without it, material that was
/// pulled apart would push as soon as it moves back.
///
/// Plastic work is that of the stress after the increment on the plastic strain of the increment: exact while the stress stays, of first order in the
/// increment otherwise, and never negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MohrCoulomb<const CUT: bool = false> {
    elastic: LinearElastic,
    pyramid: Pyramid,
    cut: Cut,
}

/// What a Mohr-Coulomb material is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    /// Angle of friction phi \[rad\], 0 or more and less than a right angle. At zero the law is that of Tresca.
    pub friction_angle: f64,
    /// Angle of dilation psi \[rad\], from 0 to the angle of friction.
    pub dilation_angle: f64,
    /// Cohesion c \[Pa\], 0 or more; above 0 where there is no friction.
    pub cohesion: f64,
}

impl Strength {
    /// Of dry grains that neither stick together nor dilate, by the angle of friction \[rad\].
    pub const fn of_friction(friction_angle: f64) -> Self {
        Self { friction_angle, dilation_angle: 0.0, cohesion: 0.0 }
    }

    /// Refuses what no material has.
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let Self { friction_angle, dilation_angle, cohesion } = *self;
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&friction_angle) {
            let degrees = friction_angle.to_degrees();
            return Err(SetupError::new(
                "angle of friction in degrees",
                degrees,
                "0 or more, and less than 90",
            ));
        }
        if !(0.0..=friction_angle).contains(&dilation_angle) {
            let degrees = dilation_angle.to_degrees();
            let allowed = "0 or more, and no more than the angle of friction";
            return Err(SetupError::new("angle of dilation in degrees", degrees, allowed));
        }
        if !(cohesion >= 0.0 && cohesion.is_finite()) {
            return Err(SetupError::new("cohesion", cohesion, "0 Pa or more, and finite"));
        }
        if friction_angle == 0.0 && cohesion == 0.0 {
            return Err(SetupError::new("cohesion", 0.0, "above 0 Pa where there is no friction"));
        }
        Ok(())
    }

    /// The mean stress \[Pa\] of the apex, `c / tan(phi)`: the greatest tension from all sides; infinite without friction.
    pub fn apex(&self) -> f64 {
        if self.friction_angle > 0.0 { self.cohesion / self.friction_angle.tan() } else { f64::INFINITY }
    }
}

impl MohrCoulomb {
    /// By elastic constants and strength.
    ///
    /// # Errors
    /// When an angle or the cohesion is out of its range.
    pub fn new(elastic: LinearElastic, strength: Strength) -> Result<Self, SetupError> {
        strength.check()?;
        let pyramid = Pyramid::new(&elastic, &strength);
        Ok(Self { elastic, pyramid, cut: Cut::at(f64::INFINITY, &elastic) })
    }

    /// The same material that carries no tension above `tensile_strength` \[Pa\] in any direction.
    ///
    /// # Errors
    /// When it is negative, or not less than the tension at the apex, `c / tan(phi)`.
    pub fn with_tensile_strength(self, tensile_strength: f64) -> Result<MohrCoulomb<true>, SetupError> {
        let Self { elastic, pyramid, .. } = self;
        if !(tensile_strength >= 0.0 && tensile_strength < pyramid.apex) {
            let allowed = "0 Pa or more, and less than cohesion over the tangent of the angle of friction";
            return Err(SetupError::new("tensile strength", tensile_strength, allowed));
        }
        Ok(MohrCoulomb { elastic, pyramid, cut: Cut::at(tensile_strength, &elastic) })
    }
}

/// Stress in principal values after a return.
#[derive(Clone, Copy, Debug)]
struct Returned {
    values: [f64; 3],
    /// All principal stresses are at the greatest tension.
    at_tip: bool,
}

impl<const CUT: bool> MohrCoulomb<CUT> {
    /// The elastic law below the strength.
    pub const fn elastic(&self) -> &LinearElastic {
        &self.elastic
    }

    /// By how much \[Pa\] a stress is beyond the strength; the strength of a stress in principal values is `f <= 0`.
    #[inline(always)]
    pub fn excess(&self, values: [f64; 3]) -> f64 {
        let shear = self.pyramid.excess(values);
        let tension = values[0] - self.cut.tension;
        if CUT && tension > shear { tension } else { shear }
    }

    /// Greatest tension \[Pa\] from all sides.
    #[inline(always)]
    fn tip(&self) -> f64 {
        if CUT { self.cut.tension } else { self.pyramid.apex }
    }

    #[inline(always)]
    fn returned(&self, trial: [f64; 3]) -> Returned {
        if CUT { self.cut.returned(&self.pyramid, trial) } else { self.pyramid.returned(trial) }
    }
}

const GAP: usize = 0;
const PLASTIC: usize = 1;

impl<const CUT: bool> ConstitutiveLaw for MohrCoulomb<CUT> {
    type Memory = [f64; 2];

    /// The gap, and the sum of the differences of the largest and the smallest principal plastic strain.
    const KEPT: &'static [Kept] =
        &[Kept { name: "gap_strain", unit: "1" }, Kept { name: "plastic_strain", unit: "1" }];

    fn start(&self) -> [f64; 2] {
        [0.0; 2]
    }

    #[inline(always)]
    fn respond<A: Axes>(
        &self,
        stress: SymmetricTensor,
        memory: &mut [f64; 2],
        increment: &Increment,
    ) -> Response {
        let (strain, gap) = gap::close(memory[GAP], increment.strain);
        let trial = stress + self.elastic.stress_of(strain);
        let principal = A::principal(trial);
        let before = principal.values;
        let yields = self.excess(before) > 0.0;
        let back = self.returned(before);
        let after = A::with_values(&principal.directions, back.values);
        let values: [f64; 3] = std::array::from_fn(|i| if yields { back.values[i] } else { before[i] });
        let [lost_1, lost_2, lost_3]: [f64; 3] = std::array::from_fn(|i| before[i] - values[i]);
        let opened = (lost_1 + lost_2 + lost_3) * self.pyramid.volumetric_compliance;
        let separates = yields && back.at_tip && self.tip() == 0.0;
        memory[GAP] = if separates { opened } else { gap };
        memory[PLASTIC] += (lost_1 - lost_3) * self.pyramid.shear_compliance;
        Response {
            stress: select(yields, after, trial),
            plastic_work: self.pyramid.work(values, [lost_1, lost_2, lost_3]),
            viscous_work: 0.0,
        }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _memory: &[f64; 2]) -> f64 {
        self.elastic.energy_at(stress)
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.elastic.compression_speed(density)
    }
}

/// One of two tensors, component by component, so that no branch is needed.
#[inline(always)]
pub(crate) fn select(first: bool, a: SymmetricTensor, b: SymmetricTensor) -> SymmetricTensor {
    SymmetricTensor {
        xx: if first { a.xx } else { b.xx },
        yy: if first { a.yy } else { b.yy },
        zz: if first { a.zz } else { b.zz },
        xy: if first { a.xy } else { b.xy },
        yz: if first { a.yz } else { b.yz },
        xz: if first { a.xz } else { b.xz },
    }
}
