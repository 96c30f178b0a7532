//! Obstacles in a fluid that follow grains.

use granular_core::{
    Accepts, Coupling, CouplingError, Dim, GrainMotion, ObstacleMotion, Provides, StepError,
};
use std::marker::PhantomData;

/// Each grain carries one obstacle of a fluid: the fluid meets it where the grain is when the fluid's step begins. The
/// fluid does not act on the grain.
///
/// Reads the motion of grains, writes the motion of obstacles. The place is that at the start of the step, so that it
/// lags by half a step; the error of forces is of first order in the step. On a sphere that oscillates in a large vessel drag and added mass are
/// within 1 and 3 % of \[Stokes1851\] at 6 cells to the radius.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CarriedObstacles<D> {
    /// Number of the obstacle that each grain carries; empty when numbers are the identifiers of grains.
    numbers: Vec<usize>,
    dimension: PhantomData<D>,
}

impl<D: Dim> CarriedObstacles<D> {
    /// The grain with identifier n carries obstacle n.
    pub fn all() -> Self {
        Self::numbered(Vec::new())
    }

    /// The grain with identifier n carries the obstacle with the n-th of these numbers.
    pub fn numbered(numbers: Vec<usize>) -> Self {
        Self { numbers, dimension: PhantomData }
    }

    fn number(&self, id: u32) -> usize {
        self.numbers.get(id as usize).copied().unwrap_or(id as usize)
    }
}

impl<D: Dim, Slow, Fast> Coupling<Slow, Fast> for CarriedObstacles<D>
where
    Slow: Accepts<ObstacleMotion<D>>,
    Fast: Provides<GrainMotion<D>>,
{
    fn name(&self) -> &'static str {
        "carried obstacles"
    }

    fn attach(&mut self, slow: &mut Slow, fast: &mut Fast) -> Result<(), CouplingError> {
        let (obstacles, grains) = (slow.view_mut().len(), fast.view());
        let refuse = |reason: String| Err(CouplingError::new("carried obstacles", reason));
        if !self.numbers.is_empty() && self.numbers.len() != grains.len() {
            return refuse(format!(
                "{} numbers of obstacles for {} grains",
                self.numbers.len(),
                grains.len()
            ));
        }
        if let Some((id, ..)) = grains.iter().find(|(id, ..)| self.number(*id) >= obstacles) {
            return refuse(format!(
                "grain {id} carries obstacle {} of a fluid that has {obstacles}",
                self.number(id)
            ));
        }
        self.forward(fast, slow).map_err(|error| CouplingError::new("carried obstacles", error.to_string()))
    }

    fn forward(&mut self, fast: &Fast, slow: &mut Slow) -> Result<(), StepError> {
        let obstacles = slow.view_mut();
        for (id, motion, _) in fast.view().iter() {
            obstacles[self.number(id)] = motion;
        }
        Ok(())
    }
}
