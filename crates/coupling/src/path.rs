//! Paths known beforehand.

use granular_core::{Dim, Linear, Motion};
use std::f64::consts::TAU;
use std::fmt;

/// Where a body is at each time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path<D: Dim> {
    /// From its place at a velocity \[m/s\].
    Steady(D::Vec),
    /// About its place: displacement `amplitude sin(2 pi frequency t + phase)`.
    Oscillation {
        /// Largest displacement \[m\].
        amplitude: D::Vec,
        /// Frequency \[1/s\].
        frequency: f64,
        /// Phase at the start \[rad\].
        phase: f64,
    },
    /// On a circle about a centre, from its place on.
    Orbit {
        /// Centre \[m\].
        centre: D::Vec,
        /// Angular velocity on the circle \[rad/s\]; in space about the axis that it points along.
        rate: D::Spin,
    },
}

/// A ball on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<D: Dim> {
    /// Centre at the start, or mean centre of an oscillation \[m\].
    pub place: D::Vec,
    /// Radius \[m\].
    pub radius: f64,
    /// Path of the centre.
    pub path: Path<D>,
    /// Angular velocity about the centre \[rad/s\]; the body is not turned at the start.
    pub spin: D::Spin,
}

impl<D: Dim> Body<D> {
    /// A body that does not turn.
    pub fn new(place: D::Vec, radius: f64, path: Path<D>) -> Self {
        Self { place, radius, path, spin: D::Spin::ZERO }
    }

    /// Motion at a time \[s\].
    pub fn motion(&self, time: f64) -> Motion<D> {
        let (position, velocity) = match self.path {
            Path::Steady(velocity) => (self.place + velocity * time, velocity),
            Path::Oscillation { amplitude, frequency, phase } => {
                let (sine, cosine) = (TAU * frequency * time + phase).sin_cos();
                (self.place + amplitude * sine, amplitude * (TAU * frequency * cosine))
            }
            Path::Orbit { centre, rate } => {
                let arm = centre + turned::<D>(self.place - centre, rate, time);
                (arm, D::turn(rate, arm - centre))
            }
        };
        Motion { orientation: self.spin * time, ..Motion::new(position, velocity, self.spin) }
    }

    /// Fastest speed of its surface \[m/s\].
    pub fn fastest(&self) -> f64 {
        let centre = match self.path {
            Path::Steady(velocity) => velocity.length(),
            Path::Oscillation { amplitude, frequency, .. } => (amplitude * (TAU * frequency)).length(),
            Path::Orbit { centre, rate } => D::turn(rate, self.place - centre).length(),
        };
        centre + self.radius * self.spin.length()
    }

    pub(crate) fn check(&self, number: usize) -> Result<(), PathError> {
        let refuse = |what: &str, value: f64, allowed: &'static str| {
            Err(PathError { what: format!("{what} of body {number}"), value, allowed })
        };
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return refuse("radius", self.radius, "a positive length");
        }
        if !self.place.is_finite() {
            return refuse("place", self.place.length(), "finite numbers");
        }
        if !self.fastest().is_finite() || !self.motion(0.0).is_finite() {
            return refuse("speed", self.fastest(), "a finite path");
        }
        Ok(())
    }
}

/// An arm turned by `rate * time`, about the axis of the rate.
fn turned<D: Dim>(arm: D::Vec, rate: D::Spin, time: f64) -> D::Vec {
    let speed = rate.length();
    if speed == 0.0 {
        return arm;
    }
    let axis = rate * (1.0 / speed);
    let across = D::turn(axis, arm);
    let (sine, cosine) = (speed * time).sin_cos();
    arm + across * sine + D::turn(axis, across) * (1.0 - cosine)
}

/// Why a body cannot follow its path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathError {
    /// What is wrong.
    pub what: String,
    /// The value found.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; allowed: {}", self.what, self.value, self.allowed)
    }
}

impl std::error::Error for PathError {}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    /// Velocity is the derivative of the position, by central differences.
    fn assert_consistent<D: Dim>(body: &Body<D>) {
        let step = 1e-5;
        for time in [0.0, 0.3, 1.7] {
            let [low, high] = [time - step, time + step].map(|time| body.motion(time).position);
            let difference = (high - low) * (0.5 / step) - body.motion(time).velocity;
            assert!(difference.length() < 1e-7 * body.fastest(), "{body:?} at {time}: {difference:?}");
            assert!(body.motion(time).velocity.length() <= body.fastest() * (1.0 + 1e-12));
        }
    }

    #[test]
    fn velocities_are_those_of_the_positions() {
        let place = DVec2::new(0.3, -0.2);
        for path in [
            Path::Steady(DVec2::new(0.1, 0.7)),
            Path::Oscillation { amplitude: DVec2::new(0.2, 0.1), frequency: 0.8, phase: 0.4 },
            Path::Orbit { centre: DVec2::new(0.1, 0.1), rate: -2.0 },
        ] {
            assert_consistent(&Body::<D2>::new(place, 0.1, path));
        }
        let path = Path::Orbit { centre: DVec3::new(0.1, 0.0, 0.2), rate: DVec3::new(1.0, 2.0, -0.5) };
        assert_consistent(&Body::<D3>::new(DVec3::new(0.4, 0.3, 0.1), 0.1, path));
    }

    #[test]
    fn an_orbit_closes_and_keeps_its_radius() {
        let centre = DVec3::new(0.1, 0.0, 0.2);
        let rate = DVec3::new(0.0, 3.0, 4.0);
        let body = Body::<D3>::new(DVec3::new(0.4, 0.3, 0.1), 0.1, Path::Orbit { centre, rate });
        let round = TAU / 5.0;
        assert!((body.motion(round).position - body.place).length() < 1e-14);
        let [start, later] = [0.0, 0.37].map(|time| body.motion(time).position - centre);
        assert!((start.length() - later.length()).abs() < 1e-15);
        assert!((start.dot(rate) - later.dot(rate)).abs() < 1e-15);
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let steady = Path::Steady(DVec2::X);
        let error = Body::<D2>::new(DVec2::ZERO, -1.0, steady).check(3).unwrap_err().to_string();
        assert_eq!(error, "radius of body 3 is -1; allowed: a positive length");
        let endless = Path::Oscillation { amplitude: DVec2::X, frequency: f64::INFINITY, phase: 0.0 };
        assert!(Body::<D2>::new(DVec2::ZERO, 1.0, endless).check(0).is_err());
    }
}
