//! Bodies on prescribed paths, as a solver.

use crate::path::{Body, PathError};
use granular_core::solver::check_step;
use granular_core::{
    Dim, FieldRef, FieldSink, GrainMotion, Grains, Limits, Linear, Location, Memory, Provides, Section,
    Shown, ShownAs, SnapshotError, Solver, StepError,
};

/// Bodies whose paths are known beforehand. The n-th body is the grain with identifier n.
#[derive(Clone, Debug)]
pub struct PrescribedMotion<D: Dim> {
    bodies: Vec<Body<D>>,
    /// Time is `start + steps * dt` as long as the step stays the same.
    start: f64,
    dt: f64,
    steps: u64,
    position: Vec<D::Vec>,
    velocity: Vec<D::Vec>,
    spin: Vec<D::Spin>,
    orientation: Vec<D::Spin>,
    radius: Vec<f64>,
}

impl<D: Dim> PrescribedMotion<D> {
    /// Bodies at time zero.
    ///
    /// # Errors
    /// When a radius is not positive or a path not finite.
    pub fn new(bodies: Vec<Body<D>>) -> Result<Self, PathError> {
        bodies.iter().enumerate().try_for_each(|(number, body)| body.check(number))?;
        let mut this = Self {
            radius: bodies.iter().map(|body| body.radius).collect(),
            bodies,
            start: 0.0,
            dt: 0.0,
            steps: 0,
            position: Vec::new(),
            velocity: Vec::new(),
            spin: Vec::new(),
            orientation: Vec::new(),
        };
        this.follow();
        Ok(this)
    }

    /// Time \[s\].
    pub fn time(&self) -> f64 {
        self.start + self.steps as f64 * self.dt
    }

    /// Fastest speed of any surface at any time \[m/s\].
    pub fn fastest(&self) -> f64 {
        self.bodies.iter().map(Body::fastest).fold(0.0, f64::max)
    }

    /// Puts all bodies where they are at the present time.
    fn follow(&mut self) {
        let time = self.time();
        self.position.clear();
        self.velocity.clear();
        self.spin.clear();
        self.orientation.clear();
        for body in &self.bodies {
            let motion = body.motion(time);
            self.position.push(motion.position);
            self.velocity.push(motion.velocity);
            self.spin.push(motion.spin);
            self.orientation.push(motion.orientation);
        }
    }
}

impl<D: Dim> Provides<GrainMotion<D>> for PrescribedMotion<D> {
    fn view(&self) -> Grains<'_, D> {
        Grains::new(&self.position, &self.velocity, &self.spin, &self.radius, &[])
            .with_orientations(&self.orientation)
    }
}

impl<D: Dim> Solver for PrescribedMotion<D> {
    fn name(&self) -> &'static str {
        "prescribed motion"
    }

    fn size(&self) -> (usize, &'static str) {
        (self.bodies.len(), "body")
    }

    fn limits(&self, _: &mut Limits) {}

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        check_step(dt)?;
        if dt != self.dt {
            (self.start, self.dt, self.steps) = (self.time(), dt, 0);
        }
        self.steps += steps;
        self.follow();
        let lost = self
            .position
            .iter()
            .zip(&self.velocity)
            .position(|(position, velocity)| !(position.is_finite() && velocity.is_finite()));
        lost.map_or(Ok(()), |id| {
            let (solver, id, step) = (self.name(), id as u64, self.steps);
            Err(StepError::NotFinite { solver, quantity: "place on the path", id, step })
        })
    }

    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("bodies", Location::Points(D::vector_field(&self.position)))]
    }

    fn shown(&self) -> Vec<Shown> {
        let field = |name, unit, meaning| Shown::new(name, unit, meaning, ShownAs::Field);
        vec![field("velocity", "m/s", "velocity of the centre"), field("radius", "m", "radius")]
    }

    fn show(&self, sink: &mut dyn FieldSink) {
        if sink.wants("velocity") {
            sink.field("velocity", "m/s", D::vector_field(&self.velocity));
        }
        if sink.wants("radius") {
            sink.field("radius", "m", FieldRef::Scalar(&self.radius));
        }
    }

    fn save(&self, to: &mut Section) {
        to.put("start and dt", &[self.start, self.dt]);
        to.put_one("steps", self.steps);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let times: Vec<f64> = from.array_of("start and dt", 2)?;
        let steps = from.one("steps")?;
        if !times.iter().all(|time| time.is_finite()) {
            let found = "a number that is not finite".to_owned();
            return Err(SnapshotError::Damaged { place: "solver/start and dt".to_owned(), found });
        }
        (self.start, self.dt, self.steps) = (times[0], times[1], steps);
        self.follow();
        Ok(())
    }

    fn memory(&self) -> Memory {
        let per_body = size_of::<Body<D>>() + 2 * size_of::<D::Vec>() + 2 * size_of::<D::Spin>() + 8;
        Memory { bytes: self.bodies.len() * per_body, bytes_per_item: per_body, left_out: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::Path;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    #[test]
    fn bodies_are_turned_as_they_spin() {
        let mut disk = Body::<D2>::new(DVec2::ZERO, 0.1, Path::Steady(DVec2::X));
        disk.spin = -0.5;
        let mut disks =
            PrescribedMotion::new(vec![disk, Body::new(DVec2::ONE, 0.1, Path::Steady(DVec2::X))]).unwrap();
        disks.advance(0.25, 8).unwrap();
        let orientation = |index| disks.view().motion(index).orientation;
        assert_eq!([0, 1].map(orientation), [-1.0, 0.0]);
        let mut ball = Body::<D3>::new(DVec3::ZERO, 0.1, Path::Steady(DVec3::X));
        ball.spin = DVec3::new(0.3, -0.2, 0.6);
        let arm = DVec3::new(0.0, 0.1, 0.02);
        // The velocity of a point of the body is the derivative of where it is.
        let step = 1e-5;
        let [low, high] =
            [2.0 - step, 2.0 + step].map(|time| D3::rotated(arm, ball.motion(time).orientation));
        let now = D3::rotated(arm, ball.motion(2.0).orientation);
        assert!(((high - low) * (0.5 / step) - D3::turn(ball.spin, now)).length() < 1e-10);
    }
}
