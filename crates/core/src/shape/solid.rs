//! Bodies: what fills space, such as obstacles in a fluid, and where a ray enters it.

mod hole;
mod surfaces;
#[cfg(test)]
mod tests;

pub use hole::Hole;

use crate::dim::{D2, D3, Dim, Linear, Vector};
use glam::{DVec2, DVec3};
use std::fmt;

/// Why a body makes no sense.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapeError {
    /// What is wrong.
    pub what: String,
    /// The value found.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

impl ShapeError {
    /// That `what` is `value`, where something else is allowed.
    pub fn new(what: impl Into<String>, value: String, allowed: impl Into<String>) -> Self {
        Self { what: what.into(), value, allowed: allowed.into() }
    }
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; allowed: {}", self.what, self.value, self.allowed)
    }
}

impl std::error::Error for ShapeError {}

/// A solid body.
pub trait SolidShape<D: Dim>: Send + Sync {
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
    fn check(&self) -> Result<(), ShapeError> {
        let (low, high) = self.bounds();
        if (0..D::N).all(|axis| low.component(axis) < high.component(axis)) && self.centre().is_finite() {
            return Ok(());
        }
        let value = format!("from {low:?} to {high:?}, about {:?}", self.centre());
        Err(ShapeError::new("extent", value, "a lowest corner below the highest one, and a finite centre"))
    }
    /// Distance \[m\] of a point from the surface, negative inside, and the unit normal out of the body at the nearest
    /// place; none for a body that knows only what it contains.
    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        let _ = point;
        None
    }
    /// Share of the way from `outside` to `inside` \[m\] at which the surface is met, in (0, 1\].
    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        by_halving(|at| self.contains(outside + (inside - outside) * at))
    }
}

/// The share of a way, from 0 outside to 1 inside, at which a body is entered.
fn by_halving(is_inside: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > 1e-14 {
        let middle = 0.5 * (low + high);
        if is_inside(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

impl<D: Dim> SolidShape<D> for std::sync::Arc<dyn SolidShape<D>> {
    fn contains(&self, point: D::Vec) -> bool {
        (**self).contains(point)
    }

    fn check(&self) -> Result<(), ShapeError> {
        (**self).check()
    }

    fn bounds(&self) -> (D::Vec, D::Vec) {
        (**self).bounds()
    }

    fn centre(&self) -> D::Vec {
        (**self).centre()
    }

    fn reach(&self) -> f64 {
        (**self).reach()
    }

    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        (**self).distance(point)
    }

    fn crossing(&self, outside: D::Vec, inside: D::Vec) -> f64 {
        (**self).crossing(outside, inside)
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

impl<D: Dim> SolidShape<D> for Ball<D> {
    fn check(&self) -> Result<(), ShapeError> {
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return Err(ShapeError::new("radius", format!("{} m", self.radius), "a positive number"));
        }
        if !self.centre.is_finite() {
            return Err(ShapeError::new("centre", format!("{:?} m", self.centre), "finite numbers"));
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

    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        let arm = point - self.centre;
        let length = arm.length();
        // In the centre every direction is as good as another.
        let normal = if length > 0.0 { arm * (1.0 / length) } else { D::Vec::along(0, 1.0) };
        Some((length - self.radius, normal))
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

impl<D: Dim> SolidShape<D> for Block<D> {
    fn contains(&self, point: D::Vec) -> bool {
        (0..D::N).all(|axis| {
            let x = point.component(axis);
            self.low.component(axis) <= x && x <= self.high.component(axis)
        })
    }

    fn bounds(&self) -> (D::Vec, D::Vec) {
        (self.low, self.high)
    }

    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        let arm = point - point.max(self.low).min(self.high);
        let outside = arm.length();
        if outside > 0.0 {
            return Some((outside, arm * (1.0 / outside)));
        }
        // Inside the nearest face counts.
        let faces = (0..D::N).flat_map(|axis| {
            let x = point.component(axis);
            [(self.low.component(axis) - x, axis, -1.0), (x - self.high.component(axis), axis, 1.0)]
        });
        let deeper = |a: (f64, usize, f64), b: (f64, usize, f64)| if b.0 > a.0 { b } else { a };
        faces.reduce(deeper).map(|(distance, axis, sign)| (distance, D::Vec::along(axis, sign)))
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
    pub corners: Vec<DVec2>,
}

impl Polygon {
    fn distance_in_plane(&self, point: DVec2) -> (f64, DVec2) {
        let ends = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        let arm = |(&from, &to): (&DVec2, &DVec2)| {
            let along = to - from;
            let share = (point - from).dot(along) / along.length_squared();
            let nearest = if share.is_nan() { from } else { from + along * share.clamp(0.0, 1.0) };
            (point - nearest, along)
        };
        let nearer = |a: (DVec2, DVec2), b: (DVec2, DVec2)| {
            if b.0.length_squared() < a.0.length_squared() { b } else { a }
        };
        let (arm, along) = ends.map(arm).reduce(nearer).unwrap_or_default();
        let (length, inside) = (arm.length(), <Self as SolidShape<D2>>::contains(self, point));
        let sign = if inside { -1.0 } else { 1.0 };
        // On the edge itself its own normal serves; it points out of a body whose corners go round to the left.
        let area: f64 =
            self.corners.iter().zip(self.corners.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum();
        let normal = if length > 0.0 {
            arm * (sign / length)
        } else {
            -along.perp().normalize_or_zero() * area.signum()
        };
        (sign * length, normal)
    }
}

/// Half the length of a prism without ends \[m\].
const ENDLESS: f64 = 1e9;

impl<D: Dim> SolidShape<D> for Polygon {
    fn check(&self) -> Result<(), ShapeError> {
        if self.corners.len() < 3 {
            let value = format!("{} corners", self.corners.len());
            return Err(ShapeError::new("polygon", value, "three corners or more"));
        }
        match self.corners.iter().find(|corner| !corner.is_finite()) {
            Some(corner) => Err(ShapeError::new("corner", format!("{corner:?} m"), "finite numbers")),
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

    fn distance(&self, point: D::Vec) -> Option<(f64, D::Vec)> {
        let [x, y, _] = point.padded();
        let (distance, normal) = self.distance_in_plane(DVec2::new(x, y));
        Some((
            distance,
            D::Vec::from_slice(&[normal.x, normal.y, 0.0][..D::N]).expect("one component per axis"),
        ))
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

impl<S: SolidShape<D2>> SolidShape<D3> for Extruded<S> {
    fn check(&self) -> Result<(), ShapeError> {
        self.shape.check()?;
        if self.from < self.to && self.from.is_finite() && self.to.is_finite() {
            return Ok(());
        }
        let value = format!("from z = {} to {} m", self.from, self.to);
        Err(ShapeError::new("extent", value, "a lowest z below the highest one, both finite"))
    }

    fn contains(&self, point: DVec3) -> bool {
        self.from <= point.z && point.z <= self.to && self.shape.contains(point.truncate())
    }

    fn distance(&self, point: DVec3) -> Option<(f64, DVec3)> {
        let (across, direction) = self.shape.distance(point.truncate())?;
        let (below, above) = (self.from - point.z, point.z - self.to);
        let (along, up) = if below > above { (below, -1.0) } else { (above, 1.0) };
        let (side, end) = (direction.extend(0.0), DVec3::new(0.0, 0.0, up));
        Some(match (across > 0.0, along > 0.0) {
            (true, true) => {
                let arm = side * across + end * along;
                (arm.length(), arm.normalize())
            }
            // Between the ends, or inside: the nearer of side and end.
            _ if across > along => (across, side),
            _ => (along, end),
        })
    }

    fn bounds(&self) -> (DVec3, DVec3) {
        let (low, high) = self.shape.bounds();
        (low.extend(self.from), high.extend(self.to))
    }
}
