//! Shapes of obstacles.

use crate::setup::SetupError;
use granular_core::{Dim, Linear, Vector};

/// A solid body.
pub trait Shape<D: Dim>: Send + Sync {
    /// Whether a point \[m\] lies inside.
    fn contains(&self, point: D::Vec) -> bool;
    /// Corners of a box \[m\] around it. A body without end along an axis is not repeated through periodic faces there.
    fn bounds(&self) -> (D::Vec, D::Vec);
    /// Centre \[m\], about which torques are taken.
    fn centre(&self) -> D::Vec {
        let (low, high) = self.bounds();
        (low + high) * 0.5
    }
    /// Largest distance \[m\] of its surface from its centre, or more: how fast a turning body moves.
    fn reach(&self) -> f64 {
        let (low, high) = self.bounds();
        0.5 * (high - low).length()
    }
    /// Whether its numbers make sense.
    ///
    /// # Errors
    /// When they do not; what is wrong is named. By default when the box around it has no inside, or its centre is not finite.
    fn check(&self) -> Result<(), SetupError> {
        let (low, high) = self.bounds();
        if (0..D::N).all(|axis| low.component(axis) < high.component(axis)) && self.centre().is_finite() {
            return Ok(());
        }
        let value = format!("from {low:?} to {high:?}, about {:?}", self.centre());
        Err(SetupError::new("extent", value, "a lowest corner below the highest one, and a finite centre"))
    }
    /// Share of the way from `outside` to `inside` \[m\] at which the surface is met, in (0, 1\].
    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > 1e-14 {
            let middle = 0.5 * (low + high);
            if self.contains(outside + (inside - outside) * middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }
}

/// A disk or sphere.
#[derive(Clone, Copy, Debug)]
pub struct Ball<D: Dim> {
    /// Centre \[m\].
    pub centre: D::Vec,
    /// Radius \[m\].
    pub radius: f64,
}

impl<D: Dim> Shape<D> for Ball<D> {
    fn check(&self) -> Result<(), SetupError> {
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return Err(SetupError::new("radius", format!("{} m", self.radius), "a positive number"));
        }
        if !self.centre.is_finite() {
            return Err(SetupError::new("centre", format!("{:?} m", self.centre), "finite numbers"));
        }
        Ok(())
    }

    fn contains(&self, point: D::Vec) -> bool {
        (point - self.centre).length_squared() <= self.radius * self.radius
    }

    fn bounds(&self) -> (D::Vec, D::Vec) {
        let mut reach = D::Vec::ZERO;
        for axis in 0..D::N {
            reach += D::Vec::along(axis, self.radius);
        }
        (self.centre - reach, self.centre + reach)
    }

    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        let (start, way) = (outside - self.centre, inside - outside);
        let (a, b) = (way.length_squared(), start.dot(way));
        let c = start.length_squared() - self.radius * self.radius;
        // The nearer root, without cancellation: c > 0 and b < 0.
        (c / (-b + (b * b - a * c).max(0.0).sqrt())).clamp(f64::MIN_POSITIVE, 1.0)
    }
}

/// A box with edges along the axes.
#[derive(Clone, Copy, Debug)]
pub struct Block<D: Dim> {
    /// Lowest corner \[m\].
    pub low: D::Vec,
    /// Highest corner \[m\].
    pub high: D::Vec,
}

impl<D: Dim> Shape<D> for Block<D> {
    fn contains(&self, point: D::Vec) -> bool {
        (0..D::N).all(|axis| {
            let x = point.component(axis);
            self.low.component(axis) <= x && x <= self.high.component(axis)
        })
    }

    fn bounds(&self) -> (D::Vec, D::Vec) {
        (self.low, self.high)
    }

    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        // The last of its faces that is passed.
        let passed = (0..D::N).map(|axis| {
            let [from, to] = [outside, inside].map(|point| point.component(axis));
            match from {
                _ if from < self.low.component(axis) => (self.low.component(axis) - from) / (to - from),
                _ if from > self.high.component(axis) => (self.high.component(axis) - from) / (to - from),
                _ => 0.0,
            }
        });
        passed.fold(f64::MIN_POSITIVE, f64::max).min(1.0)
    }
}

/// A polygon in the plane of x and y, its corners in order around it; in space a prism without ends along z.
#[derive(Clone, Debug)]
pub struct Polygon {
    /// Corners \[m\], three or more.
    pub corners: Vec<granular_core::glam::DVec2>,
}

/// Half the length of a prism without ends \[m\].
const ENDLESS: f64 = 1e9;

impl<D: Dim> Shape<D> for Polygon {
    fn check(&self) -> Result<(), SetupError> {
        if self.corners.len() < 3 {
            let value = format!("{} corners", self.corners.len());
            return Err(SetupError::new("polygon", value, "three corners or more"));
        }
        match self.corners.iter().find(|corner| !corner.is_finite()) {
            Some(corner) => Err(SetupError::new("corner", format!("{corner:?} m"), "finite numbers")),
            None => Ok(()),
        }
    }

    fn contains(&self, point: D::Vec) -> bool {
        let [x, y, _] = point.padded();
        let ends = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        let crossed =
            ends.filter(|(a, b)| (a.y > y) != (b.y > y) && x < a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        crossed.count() % 2 == 1
    }

    fn bounds(&self) -> (D::Vec, D::Vec) {
        let of =
            |x: f64, y: f64, z: f64| D::Vec::from_slice(&[x, y, z][..D::N]).expect("one component per axis");
        let low = self.corners.iter().copied().reduce(|a, b| a.min(b)).unwrap_or_default();
        let high = self.corners.iter().copied().reduce(|a, b| a.max(b)).unwrap_or_default();
        (of(low.x, low.y, -ENDLESS), of(high.x, high.y, ENDLESS))
    }
}

/// A shape in the plane, made a body in space along z.
#[derive(Clone, Debug)]
pub struct Extruded<S> {
    /// Cross-section.
    pub shape: S,
    /// Lowest z \[m\].
    pub from: f64,
    /// Highest z \[m\].
    pub to: f64,
}

impl<S: Shape<granular_core::D2>> Shape<granular_core::D3> for Extruded<S> {
    fn check(&self) -> Result<(), SetupError> {
        self.shape.check()?;
        if self.from < self.to && self.from.is_finite() && self.to.is_finite() {
            return Ok(());
        }
        let value = format!("from z = {} to {} m", self.from, self.to);
        Err(SetupError::new("extent", value, "a lowest z below the highest one, both finite"))
    }

    fn contains(&self, point: granular_core::glam::DVec3) -> bool {
        self.from <= point.z && point.z <= self.to && self.shape.contains(point.truncate())
    }

    fn bounds(&self) -> (granular_core::glam::DVec3, granular_core::glam::DVec3) {
        let (low, high) = self.shape.bounds();
        (low.extend(self.from), high.extend(self.to))
    }
}
