//! Drucker-Prager plasticity.

#[cfg(test)]
mod tests;

use crate::axes::Axes;
use crate::elastic::LinearElastic;
use crate::gap;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use crate::mohr_coulomb::Strength;
use granular_core::{SetupError, SymmetricTensor};

/// Linear elasticity up to a cone, `sqrt(J2) + A I1 = B`, then perfectly plastic flow with dilation \[DruckerPrager1952\].
///
/// Here `I1` is the trace of the stress, positive in tension, and `J2 = s:s / 2` of its deviator. Friction and cohesion give A and B such that the
/// cone fits Mohr-Coulomb where [`ConeMatch`] says. The return is radial and in closed form, to the cone or to its apex; it needs no principal
/// stresses. Separation and plastic work are those of [`MohrCoulomb`](crate::MohrCoulomb).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DruckerPrager {
    elastic: LinearElastic,
    friction: f64,
    /// Greatest shear stress \[Pa\] without mean stress.
    cohesion: f64,
    /// Trace \[Pa\] of the stress at the apex.
    apex: f64,
    /// Change of shear stress over the excess.
    shear_fall: f64,
    /// Change of the trace over the excess.
    trace_fall: f64,
}

/// For which stress states the cone of Drucker-Prager has the strength of Mohr-Coulomb.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConeMatch {
    /// Collapse in plane strain, where dilation is as large as friction:
    /// `A = tan(phi) / sqrt(9 + 12 tan^2(phi))`.
    #[default]
    PlaneStrain,
    /// Collapse in plane strain with the angle of dilation given. Without dilation `A = sin(phi) / 3`.
    PlaneStrainDilation,
    /// Triaxial compression, the outer edges of the pyramid: `A = 2 sin(phi) / (sqrt(3) (3 - sin(phi)))`.
    Compression,
    /// Triaxial extension, its inner edges: `A = 2 sin(phi) / (sqrt(3) (3 + sin(phi)))`.
    Extension,
}

impl ConeMatch {
    /// A of the friction, and B over the cohesion times the cosine of the angle of friction, by the sine of the angle of friction and A of the dilation.
    fn slopes(self, sine: f64, dilation: f64) -> (f64, f64) {
        let root_3 = 3.0_f64.sqrt();
        let of_plane = |divisor: f64| (sine / (3.0 * divisor), 1.0 / divisor);
        match self {
            // sqrt(1 + sin^2 / 3) = sqrt(1 + 4/3 tan^2) cos
            Self::PlaneStrain => of_plane((1.0 + sine * sine / 3.0).sqrt()),
            Self::PlaneStrainDilation => of_plane((1.0 - 3.0 * dilation * dilation).sqrt() + dilation * sine),
            Self::Compression => {
                let divisor = root_3 * (3.0 - sine);
                (2.0 * sine / divisor, 6.0 / divisor)
            }
            Self::Extension => {
                let divisor = root_3 * (3.0 + sine);
                (2.0 * sine / divisor, 6.0 / divisor)
            }
        }
    }
}

impl DruckerPrager {
    /// By elastic constants, strength, and where the cone has this strength.
    ///
    /// # Errors
    /// When an angle or the cohesion is out of its range.
    pub fn new(elastic: LinearElastic, strength: Strength, cone: ConeMatch) -> Result<Self, SetupError> {
        strength.check()?;
        // Dilation in plane strain is that of its angle when the cone is that of plane strain.
        let of_dilation = if cone == ConeMatch::PlaneStrainDilation { ConeMatch::PlaneStrain } else { cone };
        let (dilation, _) = of_dilation.slopes(strength.dilation_angle.sin(), 0.0);
        let (friction, per_cohesion) = cone.slopes(strength.friction_angle.sin(), dilation);
        let cohesion = per_cohesion * strength.cohesion * strength.friction_angle.cos();
        let (bulk, shear) = (elastic.bulk(), elastic.shear());
        let stiffness = shear + 9.0 * bulk * friction * dilation;
        Ok(Self {
            elastic,
            friction,
            cohesion,
            apex: if friction > 0.0 { cohesion / friction } else { f64::INFINITY },
            shear_fall: shear / stiffness,
            trace_fall: 9.0 * bulk * dilation / stiffness,
        })
    }

    /// The elastic law below the strength.
    pub const fn elastic(&self) -> &LinearElastic {
        &self.elastic
    }

    /// Slope A of the cone.
    pub const fn slope(&self) -> f64 {
        self.friction
    }

    /// Shear strength B \[Pa\] without mean stress.
    pub const fn shear_strength(&self) -> f64 {
        self.cohesion
    }

    /// By how much \[Pa\] a stress is beyond the strength.
    #[inline(always)]
    pub fn excess(&self, stress: SymmetricTensor) -> f64 {
        crate::measures::shear_stress(stress) + self.friction * stress.trace() - self.cohesion
    }
}

const GAP: usize = 0;
const PLASTIC: usize = 1;

impl ConstitutiveLaw for DruckerPrager {
    type Memory = [f64; 2];

    /// The gap, and the plastic shear strain, that of simple shear.
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
        let trace = trial.trace();
        let deviator = trial - SymmetricTensor::IDENTITY * (trace * (1.0 / 3.0));
        let shear = (0.5 * deviator.contract(deviator)).sqrt();
        let excess = shear + self.friction * trace - self.cohesion;
        let excess = if excess < 0.0 { 0.0 } else { excess };
        let on_cone = shear - self.shear_fall * excess;
        let at_apex = on_cone < 0.0;
        let on_cone_trace = trace - self.trace_fall * excess;
        // The product keeps what is not finite.
        let after_trace = if at_apex { self.apex + 0.0 * trace } else { on_cone_trace };
        let after_shear = if at_apex { 0.0 } else { on_cone };
        let scale = after_shear / if shear > 0.0 { shear } else { 1.0 };
        // An elastic trial keeps its bits.
        let change =
            deviator * (scale - 1.0) + SymmetricTensor::IDENTITY * ((after_trace - trace) * (1.0 / 3.0));
        let yields = excess > 0.0;
        let tip = SymmetricTensor::IDENTITY * (after_trace * (1.0 / 3.0));
        let returned = crate::mohr_coulomb::select(at_apex, tip, trial + change);
        let (lost_shear, lost_trace) = (shear - after_shear, trace - after_trace);
        let (strain_shear, strain_trace) =
            (lost_shear * (1.0 / self.elastic.shear()), lost_trace * (1.0 / (3.0 * self.elastic.bulk())));
        memory[GAP] = if at_apex && self.apex == 0.0 { strain_trace } else { gap };
        memory[PLASTIC] += strain_shear;
        Response {
            stress: crate::mohr_coulomb::select(yields, returned, trial),
            plastic_work: after_shear * strain_shear + after_trace * strain_trace * (1.0 / 3.0),
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
