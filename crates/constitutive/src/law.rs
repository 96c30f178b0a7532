//! The contract of a law.

use crate::axes::Axes;
use granular_core::SymmetricTensor;
use std::fmt::Debug;

/// How a material answers to strain.
///
/// Solvers call [`ConstitutiveLaw::respond`] for many particles side by side, several to a wide register. That works as long as a law
/// and what it calls are inlined, and choose between results instead of branching around them: compute each case, then select.
pub trait ConstitutiveLaw: Clone + Debug + Send + Sync + 'static {
    /// What a particle remembers beside its stress: `[f64; N]`. A law without memory has `[f64; 0]`, and particles keep nothing.
    type Memory: Memory;

    /// The numbers of the memory in their order.
    const KEPT: &'static [Kept];

    /// Memory of a particle that has not been strained.
    fn start(&self) -> Self::Memory;

    /// The stress after an increment of strain, and the work per volume that went into the material and is lost.
    ///
    /// `stress` \[Pa\] is that before the increment, already turned with the material by the solver's objective update. What is
    /// not finite goes in and comes out not finite, so that a solver sees it.
    fn respond<A: Axes>(
        &self,
        stress: SymmetricTensor,
        memory: &mut Self::Memory,
        increment: &Increment,
    ) -> Response;

    /// Energy stored per volume \[J/m^3\] at a stress \[Pa\].
    fn stored_energy(&self, stress: SymmetricTensor, memory: &Self::Memory) -> f64;

    /// Speed \[m/s\] of the fastest wave at a density \[kg/m^3\], whatever the stress; it limits the step.
    fn wave_speed(&self, density: f64) -> f64;

    /// Greatest dynamic viscosity \[Pa s\]; it limits the step. Zero for solids.
    fn greatest_viscosity(&self) -> f64 {
        0.0
    }
}

/// What happens to a particle in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increment {
    /// Symmetric part of the displacement gradient of the step \[-\], positive when the material lengthens.
    pub strain: SymmetricTensor,
    /// Duration \[s\]; for laws that depend on the rate.
    pub dt: f64,
    /// Volume after the step over that at the start of the run \[-\].
    pub volume_ratio: f64,
}

impl Increment {
    /// A strain without duration, of material that has its first volume.
    pub const fn of_strain(strain: SymmetricTensor) -> Self {
        Self { strain, dt: 0.0, volume_ratio: 1.0 }
    }
}

/// What a law answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Stress \[Pa\] after the increment.
    pub stress: SymmetricTensor,
    /// Work per volume lost to plastic strain \[J/m^3\].
    pub plastic_work: f64,
    /// Work per volume lost to viscosity \[J/m^3\].
    pub viscous_work: f64,
}

/// A number that a particle remembers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Name of the field that shows it.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

/// A fixed number of values: `[f64; N]`.
pub trait Memory: Copy + Debug + PartialEq + Send + Sync + 'static + AsRef<[f64]> + AsMut<[f64]> {
    /// How many.
    const LEN: usize;
    /// All zero.
    const ZERO: Self;
}

impl<const N: usize> Memory for [f64; N] {
    const LEN: usize = N;
    const ZERO: Self = [0.0; N];
}
