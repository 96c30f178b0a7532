//! Obstacles in a fluid that follow grains.

use crate::middle::{Seen, first_seen, later};
use granular_core::{
    Accepts, Coupling, CouplingError, Dim, GrainMotion, ObstacleMotion, Provides, Section, SnapshotError,
    StepError,
};
use std::marker::PhantomData;

/// Each grain carries one obstacle of a fluid: the fluid meets it where it is in the middle of the fluid's step, with the
/// velocity and spin that it has then. The fluid does not act on the grain.
///
/// Reads the motion of grains, writes the motion of obstacles. What holds in the middle of a step follows from the start of it and
/// from how velocity and spin changed in the last two steps: by half of the smaller change, and by none where they differ in
/// sign, so that an impact is not overshot. For smooth motions that is of second order in the step. On a sphere that
/// oscillates in a large vessel drag and added mass are within 1 and 3 % of \[Stokes1851\] at 6 cells to the radius.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedObstacles<D> {
    /// Number of the obstacle that each grain carries; empty when numbers are the identifiers of grains.
    numbers: Vec<usize>,
    /// Half of the fluid's step \[s\].
    half: f64,
    /// Per obstacle: velocity and spin at the start of the last step, and their changes in the step before.
    seen: Vec<Seen>,
    dimension: PhantomData<D>,
}

impl<D: Dim> CarriedObstacles<D> {
    /// The grain with identifier n carries obstacle n.
    pub fn all() -> Self {
        Self::numbered(Vec::new())
    }

    /// The grain with identifier n carries the obstacle with the n-th of these numbers.
    pub fn numbered(numbers: Vec<usize>) -> Self {
        Self { numbers, half: 0.0, seen: Vec::new(), dimension: PhantomData }
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
        slow.enable();
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
        self.seen = vec![[[0.0; 6]; 2]; obstacles];
        for (id, motion, _) in grains.iter() {
            let number = self.number(id);
            self.seen[number] = first_seen(&motion);
        }
        self.forward(fast, slow).map_err(|error| CouplingError::new("carried obstacles", error.to_string()))
    }

    fn begin(&mut self, long_step: f64) {
        self.half = 0.5 * long_step;
    }

    fn forward(&mut self, fast: &Fast, slow: &mut Slow) -> Result<(), StepError> {
        let obstacles = slow.view_mut();
        for (id, motion, _) in fast.view().iter() {
            let number = self.number(id);
            obstacles[number] = later(motion, &mut self.seen[number], self.half);
        }
        Ok(())
    }

    fn save(&self, to: &mut Section) {
        to.put("velocities and spins seen", &self.seen);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let seen: Vec<Seen> = from.array_of("velocities and spins seen", self.seen.len())?;
        if !seen.iter().flatten().flatten().all(|value| value.is_finite()) {
            let found = "a number that is not finite".to_owned();
            return Err(SnapshotError::Damaged {
                place: "carried obstacles/velocities and spins seen".to_owned(),
                found,
            });
        }
        self.seen = seen;
        Ok(())
    }
}
