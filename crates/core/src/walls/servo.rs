//! Walls under a force: a body with a mass and a dashpot, which moves along one direction only.
//!
//! ```text
//! m X'' = F_target + F_push . d - c X'        |X'| <= v_max
//! ```
//!
//! with `d` the unit direction of the target force, `X` the displacement along it and `F_push` the push of
//! what it touches, such as grains. The wall stands still where that pushes back with the target. It is moved by a
//! leapfrog, the dashpot implicitly, so that it never limits the step.

use super::WallMotion;
use super::pose::Pose;
use crate::dim::{Dim, Linear};
use crate::setup_error::SetupError;
use crate::shape::Shape;

/// A wall pressed by a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo<D: Dim> {
    /// Direction of the force on the wall; a unit vector.
    pub direction: D::Vec,
    /// Force on the wall along the direction \[N; N/m in the plane\]: pressure times an area that stays.
    pub force: f64,
    /// A pressure on an area that changes, beside the force.
    pub pressure: Option<PressureBetween>,
    /// Mass of the wall \[kg; kg/m in the plane\].
    pub mass: f64,
    /// Dashpot between wall and frame \[N s/m\].
    pub damping: f64,
    /// Greatest speed of the wall \[m/s\].
    pub max_speed: f64,
}

/// A pressure on the area that walls leave between them as they stand, such as that of a lid between moving sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureBetween {
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Indices of planes that face one another: the area is the distance of the first pair, in space times that of
    /// the second.
    pub walls: [[usize; 2]; 2],
}

/// One side of the area under a pressure: two planes and their distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<D: Dim> {
    walls: [usize; 2],
    normal: D::Vec,
    /// Distance where the planes were given \[m\].
    given: f64,
}

impl PressureBetween {
    /// Whether there is such an area beside a wall of this name.
    ///
    /// # Errors
    /// When the pressure is not finite, or a pair is not one of planes that face one another.
    pub fn check<D: Dim>(&self, wall: &str, walls: &[impl AsRef<Shape<D>>]) -> Result<(), SetupError> {
        let shapes: Vec<&Shape<D>> = walls.iter().map(AsRef::as_ref).collect();
        self.sides(wall, &shapes).map(|_| ())
    }

    /// The sides of the area.
    ///
    /// # Errors
    /// As [`PressureBetween::check`].
    pub(crate) fn sides<D: Dim>(&self, wall: &str, walls: &[&Shape<D>]) -> Result<Vec<Side<D>>, SetupError> {
        if !self.pressure.is_finite() {
            return Err(SetupError::new(format!("pressure on wall `{wall}`"), self.pressure, "finite"));
        }
        let side = |pair: &[usize; 2]| {
            let planes = pair.map(|index| match walls.get(index) {
                Some(Shape::Plane { point, normal }) => Some((*point, *normal)),
                _ => None,
            });
            if let [Some((point, normal)), Some((other, against))] = planes {
                let given = (other - point).dot(normal);
                if normal.dot(against) < -1.0 + 1e-9 && given > 0.0 {
                    return Ok(Side { walls: *pair, normal, given });
                }
            }
            let what = format!("walls beside `{wall}`, between which a pressure acts");
            Err(SetupError::new(what, pair[0] as f64, "two planes that face one another"))
        };
        self.walls[..D::N - 1].iter().map(side).collect()
    }
}

impl<D: Dim> Side<D> {
    /// Distance of the planes now \[m\]; none when they have passed each other.
    pub(crate) fn length(&self, poses: &[Pose<D>]) -> f64 {
        let [first, second] = self.walls.map(|wall| poses[wall].shift);
        (self.given + (second - first).dot(self.normal)).max(0.0)
    }
}

impl<D: Dim> Servo<D> {
    pub(crate) fn check(&self, wall: &str) -> Result<(), SetupError> {
        let refuse = |what: &str, value: f64, allowed| {
            Err(SetupError::new(format!("{what} of wall `{wall}`"), value, allowed))
        };
        if (self.direction.length() - 1.0).abs() > 1e-9 || !self.direction.is_finite() {
            return refuse("length of the direction of the force", self.direction.length(), "1");
        }
        if !self.force.is_finite() {
            return refuse("force", self.force, "finite");
        }
        if !(self.mass.is_finite() && self.mass > 0.0) {
            return refuse("mass", self.mass, "positive and finite");
        }
        if !(self.damping.is_finite() && self.damping >= 0.0) {
            return refuse("damping", self.damping, "zero or more, and finite");
        }
        if self.max_speed.is_nan() || self.max_speed <= 0.0 {
            return refuse("greatest speed", self.max_speed, "positive");
        }
        Ok(())
    }
}

/// State of a servo; zero for walls that are not under a force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Drive {
    /// Displacement along the direction \[m\]; at the middle of the step between its halves.
    pub(crate) offset: f64,
    /// Velocity along the direction at the start of the step \[m/s\].
    velocity: f64,
    /// Acceleration of the last step \[m/s^2\].
    acceleration: f64,
    /// Velocity at the instant of `offset`: predicted at the middle of the step \[m/s\].
    pub(crate) now: f64,
}

impl Drive {
    pub(crate) fn to_array(self) -> [f64; 3] {
        [self.offset, self.velocity, self.acceleration]
    }

    pub(crate) fn from_array([offset, velocity, acceleration]: [f64; 3]) -> Self {
        Self { offset, velocity, acceleration, now: velocity }
    }

    /// At rest where it is.
    pub(crate) fn halted(self) -> Self {
        Self { offset: self.offset, ..Self::default() }
    }

    /// Bound on the speed over a step \[m/s\].
    pub(crate) fn fastest(self, dt: f64) -> f64 {
        self.velocity.abs() + self.acceleration.abs() * dt
    }

    /// Drifts to the middle of the step and predicts the velocity there.
    pub(crate) fn half_a_step<D: Dim>(self, dt: f64, motion: &WallMotion<D>, runs: bool) -> Self {
        let WallMotion::Servo(servo) = motion else { return self };
        if !runs {
            return self;
        }
        let now = self.velocity + 0.5 * dt * self.acceleration;
        let now = now.clamp(-servo.max_speed, servo.max_speed);
        Self { offset: self.offset + 0.5 * dt * self.velocity, now, ..self }
    }

    /// Takes the push on the wall and what a pressure adds to the force of the servo, and drifts the other half.
    pub(crate) fn other_half<D: Dim>(
        self,
        dt: f64,
        motion: &WallMotion<D>,
        (push, pressed): (D::Vec, f64),
    ) -> Self {
        let WallMotion::Servo(servo) = motion else { return self };
        let force = servo.force + pressed + push.dot(servo.direction);
        // The dashpot acts on the mean of old and new velocity: stable for any damping.
        let drag = 0.5 * dt * servo.damping / servo.mass;
        let free = (self.velocity * (1.0 - drag) + dt * force / servo.mass) / (1.0 + drag);
        let velocity = free.clamp(-servo.max_speed, servo.max_speed);
        let acceleration = (velocity - self.velocity) / dt;
        Self { offset: self.offset + 0.5 * dt * velocity, velocity, acceleration, now: velocity }
    }
}
