//! Walls that move: at a steady velocity, to and fro, turning, or under a force. They know no solver: whatever touches
//! them says how it pushed.
//!
//! A prescribed motion is a closed form of the time for which it has run, never a running sum: the wall is at
//! the same place after any split of a run and after any restart. A servo is a body of its own, see [`Servo`].
//!
//! A solver holds [`MovingWalls`]. In a step of a leapfrog it calls, in this order, [`MovingWalls::place_in_step`],
//! takes its forces with the [poses](MovingWalls::poses) found there, and tells the walls by
//! [`MovingWalls::take_reactions`] how they were pushed; after its last step it calls [`MovingWalls::place`].

mod moving;
mod pose;
mod servo;

pub use moving::{MovingWalls, Reaction, WallGeometry};
pub use pose::{Pose, Rate, Turned};
pub use servo::{PressureBetween, Servo};

use crate::dim::{Dim, Linear};
use crate::setup_error::SetupError;
use std::f64::consts::TAU;

/// How a wall moves, from where its shape was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WallMotion<D: Dim> {
    /// At a constant velocity.
    Steady {
        /// Velocity \[m/s\].
        velocity: D::Vec,
    },
    /// To and fro along a direction: shifted by `amplitude * (sin(2 pi f t + phase) - sin(phase))`, so that it
    /// begins where its shape was given.
    Oscillating {
        /// Greatest displacement \[m\], with its direction.
        amplitude: D::Vec,
        /// Frequency f \[Hz\].
        frequency: f64,
        /// Phase \[rad\] at which it begins.
        phase: f64,
    },
    /// Turning about a point.
    Turning {
        /// A point of the axis \[m\].
        about: D::Vec,
        /// Angular velocity \[rad/s\].
        spin: D::Spin,
    },
    /// Pressed by a force along a direction.
    Servo(Servo<D>),
}

impl<D: Dim> WallMotion<D> {
    /// Refuses values that are not finite and directions that are none.
    ///
    /// # Errors
    /// With the value that is out of range.
    pub fn check(&self, wall: &str) -> Result<(), SetupError> {
        let refuse = |what: &str, value: f64, allowed| {
            Err(SetupError::new(what, value, allowed).of(format_args!("wall `{wall}`")))
        };
        match self {
            Self::Steady { velocity } if !velocity.is_finite() => refuse("velocity", f64::NAN, "finite"),
            Self::Oscillating { amplitude, .. } if !amplitude.is_finite() => {
                refuse("amplitude", f64::NAN, "finite")
            }
            Self::Oscillating { frequency, .. } if !(frequency.is_finite() && *frequency >= 0.0) => {
                refuse("frequency", *frequency, "zero or more, and finite")
            }
            Self::Oscillating { phase, .. } if !phase.is_finite() => refuse("phase", *phase, "finite"),
            Self::Turning { about, spin } if !(about.is_finite() && spin.is_finite()) => {
                refuse("axis or spin", f64::NAN, "finite")
            }
            Self::Servo(servo) => servo.check(wall),
            _ => Ok(()),
        }
    }

    /// Greatest speed of a point at this distance \[m\] from where the wall was given; that of a servo follows
    /// from its state.
    pub(crate) fn fastest(&self, distance: impl FnOnce(D::Vec) -> f64) -> f64 {
        match self {
            Self::Steady { velocity } => velocity.length(),
            Self::Oscillating { amplitude, frequency, .. } => amplitude.length() * frequency * TAU,
            Self::Turning { about, spin } => spin.length() * distance(*about),
            Self::Servo(_) => 0.0,
        }
    }
}
