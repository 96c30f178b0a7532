//! The convex domain to which cells are cut.

use crate::error::TessellationError;
use granular_core::glam::DVec2;

/// A convex polygon, counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    sides: Vec<Line>,
    area: f64,
}

/// A side, from a corner to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) from: DVec2,
    pub(crate) along: DVec2,
    pub(crate) length: f64,
    /// Unit normal, outward.
    pub(crate) normal: DVec2,
}

impl Line {
    /// Distance of a point beyond the line; negative inside.
    #[inline(always)]
    pub(crate) fn beyond(&self, point: DVec2) -> f64 {
        (point - self.from).dot(self.normal)
    }

    /// The point at a distance from the start of the side.
    pub(crate) fn at(&self, distance: f64) -> DVec2 {
        self.from + self.along * distance
    }
}

impl Domain {
    /// The rectangle between two corners.
    ///
    /// # Errors
    /// When `high` is not above `low` on both axes.
    pub fn rectangle(low: DVec2, high: DVec2) -> Result<Self, TessellationError> {
        Self::polygon(&[low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)])
    }

    /// The polygon with these corners, counter-clockwise.
    ///
    /// # Errors
    /// When it has fewer than three corners or does not turn left at each of them.
    pub fn polygon(corners: &[DVec2]) -> Result<Self, TessellationError> {
        let count = corners.len();
        let refuse = |corner: usize| TessellationError::Domain {
            corner,
            position: corners.get(corner).map(|p| vec![p.x, p.y]).unwrap_or_default(),
        };
        if count < 3 {
            return Err(refuse(count));
        }
        let mut turned = 0.0;
        for k in 0..count {
            let [a, b, c] = [corners[(k + count - 1) % count], corners[k], corners[(k + 1) % count]];
            let coordinate = |p: DVec2| robust::Coord { x: p.x, y: p.y };
            let left = robust::orient2d(coordinate(a), coordinate(b), coordinate(c)) > 0.0;
            if !left || !(b - a).length_squared().is_finite() {
                return Err(refuse(k));
            }
            turned += (b - a).angle_to(c - b);
        }
        // A star turns left everywhere too, but more than once around.
        if turned > 1.5 * std::f64::consts::TAU {
            return Err(refuse(count - 1));
        }
        let side = |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % count]);
            let length = (to - from).length();
            let along = (to - from) / length;
            Line { from, along, length, normal: DVec2::new(along.y, -along.x) }
        };
        let area =
            (1..count - 1).map(|k| 0.5 * (corners[k] - corners[0]).perp_dot(corners[k + 1] - corners[0]));
        Ok(Self { sides: (0..count).map(side).collect(), area: area.sum() })
    }

    /// Area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Corners, counter-clockwise.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = DVec2> {
        self.sides.iter().map(|side| side.from)
    }

    /// Whether a point lies in the domain or on its boundary, to rounding.
    pub fn contains(&self, point: DVec2) -> bool {
        self.sides.iter().all(|side| side.beyond(point) <= 0.0)
    }

    pub(crate) fn sides(&self) -> &[Line] {
        &self.sides
    }

    /// Distance of a point to the nearest side; negative outside.
    #[inline(always)]
    pub(crate) fn depth(&self, point: DVec2) -> f64 {
        -self.sides.iter().fold(f64::NEG_INFINITY, |most, side| most.max(side.beyond(point)))
    }
}
