//! What a scene says of this method (feature `serde`).

use crate::collision::Operator;
use granular_core::units::{Length, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// The lattice Boltzmann method, such as `Lbm((spacing: "1 mm"))`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LbmSpec {
    /// Edge of a cell; the sizes of the fluid must be whole multiples of it.
    pub spacing: Length,
    /// What sets the step.
    #[serde(default)]
    pub step: StepSpec,
    /// Collision operator; `TwoRelaxation(0.1875)` by default.
    #[serde(default)]
    pub operator: OperatorSpec,
    /// Smagorinsky constant C, such as 0.1, of the eddy viscosity `(C spacing)^2 sqrt(2 S:S)`; none by default.
    #[serde(default)]
    pub smagorinsky: Option<f64>,
    /// Numbers in which the fluid is stored and computed.
    #[serde(default)]
    pub precision: PrecisionSpec,
}

/// What sets the step.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum StepSpec {
    /// The Mach number of the largest speed expected, at most 0.3; errors fall with its square.
    Mach(f64),
    /// The relaxation time in steps, above 1/2.
    RelaxationTime(f64),
    /// The step itself.
    Time(Time),
}

impl Default for StepSpec {
    fn default() -> Self {
        Self::Mach(0.1)
    }
}

/// A collision operator. Flat walls along the lattice are exact if `Lambda` is 3/16; inclined and round ones are exact
/// with no operator.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum OperatorSpec {
    /// Multiple relaxation times with `Lambda` 3/16: flat walls along the lattice lie exactly half-way between cells at
    /// any viscosity; unstable in shear layers in which all others are stable.
    ExactWalls,
    /// One relaxation time (BGK): positions of walls depend on the viscosity.
    SingleRelaxation,
    /// Two relaxation times with this `Lambda`. By default 3/16 = 0.1875: flat walls along the lattice lie exactly
    /// half-way between cells, and the error at others, if half-way, does not depend on the viscosity in slow flow.
    TwoRelaxation(f64),
    /// Multiple relaxation times with the rates of the thesis: positions of walls depend on the viscosity; among the
    /// most accurate in free flow.
    Kumar,
    /// Regularised: stable at high Reynolds numbers and accurate away from walls, whose positions depend on the
    /// viscosity.
    Regularised,
}

impl Default for OperatorSpec {
    fn default() -> Self {
        Self::TwoRelaxation(3.0 / 16.0)
    }
}

/// Numbers in which the fluid is stored and computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum PrecisionSpec {
    /// 64 bits.
    #[default]
    Double,
    /// 32 bits: half the memory, up to twice the speed, and errors of about 1e-5.
    Single,
}

impl From<OperatorSpec> for Operator {
    fn from(spec: OperatorSpec) -> Self {
        match spec {
            OperatorSpec::ExactWalls => Self::EXACT_WALLS,
            OperatorSpec::SingleRelaxation => Self::SingleRelaxation,
            OperatorSpec::TwoRelaxation(magic) => Self::TwoRelaxation { magic },
            OperatorSpec::Kumar => Self::KUMAR,
            OperatorSpec::Regularised => Self::Regularised,
        }
    }
}

impl LbmSpec {
    /// The step \[s\] for a fluid of this viscosity \[m^2/s\] and largest speed \[m/s\].
    pub fn time_step(&self, viscosity: f64, speed: f64) -> f64 {
        let spacing = self.spacing.value();
        match self.step {
            StepSpec::Mach(mach) => mach * spacing / (3.0_f64.sqrt() * speed),
            StepSpec::RelaxationTime(tau) => (tau - 0.5) * spacing * spacing / (3.0 * viscosity),
            StepSpec::Time(time) => time.value(),
        }
    }
}
