//! Grading: how much of a sample has grains finer than a diameter.
//!
//! A grading curve $F(d)$ is cumulative by area in the plane and by volume in space (by mass,
//! for one density). Grains are drawn by number: a volume density $F'$ belongs to the number
//! density $p(d) \propto F'(d) / d^N$.

use crate::beta::regularised_incomplete_beta;
use crate::error::GradingError;
use crate::random::Random;
use curve::NumberCurve;
use granular_core::Dim;

mod curve;
mod measure;

pub use measure::{finer_by_volume, median_diameter};

/// Largest shape parameter of a beta curve; beyond, the curve is a step for any sample.
const LARGEST_SHAPE: f64 = 1e4;
/// Largest ratio of diameters; beyond, a sample would need more grains than fit in memory.
const LARGEST_RATIO: f64 = 1e4;

/// A grading curve; all diameters in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grading {
    /// One size.
    Single {
        /// Diameter \[m\].
        diameter: f64,
    },
    /// The cumulative curve is $I_x(a, b)$, $x = (d - d_{min}) / (d_{max} - d_{min})$
    /// \[Kumar2014, eq. 3.53-3.57\].
    Beta {
        /// Smallest diameter \[m\].
        min: f64,
        /// Largest diameter \[m\].
        max: f64,
        /// First shape parameter.
        a: f64,
        /// Second shape parameter.
        b: f64,
    },
    /// The same area (plane) or volume (space) in every interval of diameter
    /// \[Kumar2014, eq. 3.59, 3.60\], which is the beta curve with `a = b = 1`.
    EqualMass {
        /// Smallest diameter \[m\].
        min: f64,
        /// Largest diameter \[m\].
        max: f64,
    },
}

impl Grading {
    /// Refuses diameters that are not positive and ordered, a ratio of diameters above 1e4 and
    /// shape parameters that are not above 0 and at most 1e4.
    pub fn check(&self) -> Result<(), GradingError> {
        let (min, max) = (self.smallest(), self.largest());
        require(min > 0.0 && min.is_finite(), "smallest diameter [m]", min, || "above 0 and finite".into())?;
        require(max >= min && max <= LARGEST_RATIO * min, "largest diameter [m]", max, || {
            format!("{min} (the smallest) to {}", LARGEST_RATIO * min)
        })?;
        let (a, b) = self.shape();
        for (what, value) in [("shape parameter a", a), ("shape parameter b", b)] {
            require(value > 0.0 && value <= LARGEST_SHAPE, what, value, || {
                format!("above 0, at most {LARGEST_SHAPE}")
            })?;
        }
        Ok(())
    }

    /// Smallest diameter \[m\].
    pub fn smallest(&self) -> f64 {
        match *self {
            Self::Single { diameter } => diameter,
            Self::Beta { min, .. } | Self::EqualMass { min, .. } => min,
        }
    }

    /// Largest diameter \[m\].
    pub fn largest(&self) -> f64 {
        match *self {
            Self::Single { diameter } => diameter,
            Self::Beta { max, .. } | Self::EqualMass { max, .. } => max,
        }
    }

    /// Size span $(d_{max} - d_{min}) / (d_{max} + d_{min})$ \[Kumar2014, eq. 3.58\].
    pub fn size_span(&self) -> f64 {
        (self.largest() - self.smallest()) / (self.largest() + self.smallest())
    }

    /// Share of the area (plane) or volume (space) in grains finer than `diameter` \[m\].
    ///
    /// Not a number for a grading that [`check`](Self::check) refuses.
    pub fn cumulative(&self, diameter: f64) -> f64 {
        if self.check().is_err() || diameter.is_nan() {
            return f64::NAN;
        }
        let (min, max) = (self.smallest(), self.largest());
        if diameter >= max {
            return 1.0;
        }
        if diameter <= min { 0.0 } else { self.reduced((diameter - min) / (max - min)) }
    }

    /// Radii \[m\] of `count` grains that follow the curve, in an order drawn from `seed`.
    ///
    /// Stratified by number: the number curve is cut into `count` equal parts, and the grain of
    /// each part has the mean area (volume) of its part. The measured curve then departs from
    /// the demanded one by no more than about one grain's share, the mean area (volume) is exact,
    /// and the seed decides the order only.
    pub fn sample<D: Dim>(&self, count: usize, seed: u64) -> Result<Vec<f64>, GradingError> {
        self.check()?;
        require(count > 0, "number of grains", count as f64, || "at least 1".into())?;
        let (min, ratio) = (self.smallest(), self.largest() / self.smallest());
        if ratio == 1.0 {
            return Ok(vec![0.5 * min; count]);
        }
        let curve = NumberCurve::new::<D>(ratio, |x| self.reduced(x));
        let mut radii: Vec<f64> = curve.strata::<D>(count).into_iter().map(|size| 0.5 * min * size).collect();
        // Halving and multiplying may leave the range by one unit in the last place.
        radii.iter_mut().for_each(|radius| *radius = radius.clamp(0.5 * min, 0.5 * self.largest()));
        Random::new(seed).shuffle(&mut radii);
        Ok(radii)
    }

    /// Both shape parameters of the beta curve that this is.
    fn shape(&self) -> (f64, f64) {
        match *self {
            Self::Beta { a, b, .. } => (a, b),
            Self::Single { .. } | Self::EqualMass { .. } => (1.0, 1.0),
        }
    }

    /// The curve over the reduced diameter, 0 to 1.
    fn reduced(&self, x: f64) -> f64 {
        match *self {
            Self::Beta { a, b, .. } => regularised_incomplete_beta(x, a, b),
            Self::Single { .. } | Self::EqualMass { .. } => x,
        }
    }
}

fn require(
    accepted: bool,
    what: &'static str,
    value: f64,
    allowed: impl FnOnce() -> String,
) -> Result<(), GradingError> {
    if accepted { Ok(()) } else { Err(GradingError { what, value, allowed: allowed() }) }
}

#[cfg(test)]
mod tests;
