//! What may be chosen.

use granular_core::{Dim, Linear, SetupError};

/// Largest edge of a cell over the hydrodynamic radius of a grain.
pub(super) const COARSEST: f64 = 0.5;

/// Choices for [`ResolvedGrains`](super::ResolvedGrains).
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedOptions<D: Dim> {
    /// What gives the fluid its weight \[m/s^2\], and grains their buoyancy, where the fluid itself has none: its own pressure is then that above the one
    /// at rest. `None` for the acceleration of the fluid, which may change.
    pub gravity: Option<D::Vec>,
    /// Radius at which the fluid meets grains over their own, above 0 and at most 1: below 1 in the plane, where grains that touch would leave no way
    /// through. 0.7 to 0.95 in \[Kumar2014, section 6.2\]. Weights are those of the whole grain.
    pub radius_factor: f64,
    /// Factors of single grains by their identifiers, from 0 on, in place of [`radius_factor`](Self::radius_factor); those beyond have that one.
    pub own_factors: Vec<f64>,
    /// What of the load is held over the next step of the fluid.
    pub held: HeldLoad,
}

/// The fluid meets grains at their own radius, and gives them the buoyancy of its own weight.
impl<D: Dim> Default for ResolvedOptions<D> {
    fn default() -> Self {
        Self { gravity: None, radius_factor: 1.0, own_factors: Vec::new(), held: HeldLoad::default() }
    }
}

impl<D: Dim> ResolvedOptions<D> {
    /// The factor of a grain.
    pub(super) fn factor(&self, id: u32) -> f64 {
        self.own_factors.get(id as usize).copied().unwrap_or(self.radius_factor)
    }

    pub(super) fn check(&self) -> Result<(), SetupError> {
        if self.gravity.is_some_and(|gravity| !gravity.is_finite()) {
            return Err(SetupError::new("gravity on the fluid", f64::NAN, "finite numbers"));
        }
        let mut factors = std::iter::once(&self.radius_factor).chain(&self.own_factors);
        match factors.find(|factor| !(**factor > 0.0 && **factor <= 1.0)) {
            Some(factor) => {
                let what = "hydrodynamic radius over that of the grain";
                Err(SetupError::new(what, *factor, "above 0 and at most 1"))
            }
            None => Ok(()),
        }
    }
}

/// What of the loads of the fluid is held over its next step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, schemars::JsonSchema))]
pub enum HeldLoad {
    /// That of the last step.
    #[default]
    OneStep,
    /// The mean of those of the last two steps: what changes its sign from step to step is not felt.
    TwoSteps,
}
