//! Obstacles in a fluid that follow grains.

use granular_core::{
    Accepts, Coupling, CouplingError, Dim, GrainMotion, Motion, ObstacleMotion, Provides, Section,
    SnapshotError, Spin, StepError, Vector,
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

/// Velocity and spin, and their changes.
type Seen = [[f64; 6]; 2];

/// The motion half a step later than `motion`, which is taken note of.
fn later<D: Dim>(motion: Motion<D>, seen: &mut Seen, half: f64) -> Motion<D> {
    let ([u, v, w], [a, b, c]) = (motion.velocity.padded(), motion.spin.components());
    let now = [u, v, w, a, b, c];
    let change: [f64; 6] = std::array::from_fn(|i| now[i] - seen[0][i]);
    let smaller = |i: usize| {
        let [new, old] = [change[i], seen[1][i]];
        if new * old > 0.0 { new.abs().min(old.abs()).copysign(new) } else { 0.0 }
    };
    let by: [f64; 6] = std::array::from_fn(|i| 0.5 * smaller(i));
    *seen = [now, change];
    let faster: D::Vec = Vector::from_slice(&by[..D::N]).expect("one component per axis");
    let turning = D::Spin::of_components([by[3], by[4], by[5]]);
    Motion {
        position: motion.position + (motion.velocity + faster * 0.5) * half,
        velocity: motion.velocity + faster,
        spin: motion.spin + turning,
        orientation: D::rotation_after(motion.orientation, (motion.spin + turning * 0.5) * half),
    }
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
            later(motion, &mut self.seen[number], 0.0);
            self.seen[number][1] = [0.0; 6];
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

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    #[test]
    fn an_impact_is_not_overshot_and_a_steady_acceleration_is_met() {
        let mut seen = [[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 6]];
        for velocity in [-1.0, -1.0, 0.8, 0.8, 0.8] {
            let motion = Motion::<D2>::new(DVec2::ZERO, DVec2::new(velocity, 0.0), 0.0);
            let found = later(motion, &mut seen, 0.5);
            assert_eq!((found.velocity.x, found.position.x), (velocity, 0.5 * velocity));
        }
        let at = |time: f64| Motion::<D2> {
            position: DVec2::new(0.5 * time * time, 0.0),
            velocity: DVec2::new(time, 0.0),
            spin: -2.0 * time,
            orientation: -time * time,
        };
        let mut seen = [[0.0; 6]; 2];
        for step in 0..3 {
            later(at(f64::from(step)), &mut seen, 0.5);
        }
        assert_eq!(later(at(3.0), &mut seen, 0.5), at(3.5));
    }

    #[test]
    fn an_obstacle_is_turned_as_its_body_is_in_the_middle_of_the_step() {
        let spin = DVec3::new(0.4, -1.0, 0.7);
        let at = |time: f64| Motion::<D3> {
            orientation: spin * time,
            ..Motion::new(DVec3::ZERO, DVec3::ZERO, spin)
        };
        let mut seen = [[0.0, 0.0, 0.0, spin.x, spin.y, spin.z], [0.0; 6]];
        let found = later(at(0.5), &mut seen, 0.125);
        assert!((found.orientation - spin * 0.625).length() < 1e-15);
    }
}
