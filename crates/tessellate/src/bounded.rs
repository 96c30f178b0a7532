//! A number with a bound on its error: the filter before exact arithmetic.

use std::ops::{Add, Mul, Neg, Sub};

/// What the predicates are written in: bounded numbers first, exact ones if those do not decide.
pub(crate) trait Ring: Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A small whole number.
    fn whole(value: i32) -> Self;
}

/// A value and a bound on its distance to the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounded {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

/// Twice the relative error of one rounding: the other half pays for the rounding of the bounds.
const ROUNDING: f64 = f64::EPSILON;

/// More than what underflow can lose in one product.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

impl Bounded {
    /// An exact value.
    pub(crate) fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// Sign, if it is certain. Zero is certain only without error.
    pub(crate) fn sign(self) -> Option<i8> {
        // The bounds were added with rounding too, in fewer than a thousand operations.
        let error = self.error * (1.0 + 1e-12);
        if self.value > error {
            Some(1)
        } else if -self.value > error {
            Some(-1)
        } else {
            None
        }
    }

    /// Square root of a number that is known not to be negative.
    pub(crate) fn root(self) -> Self {
        let value = self.value.max(0.0).sqrt();
        let error = if self.value > self.error {
            self.error / value
        } else {
            // The true number lies in 0 to value + error.
            (self.value.max(0.0) + self.error).sqrt()
        };
        Self { value, error: error + ROUNDING * value }
    }

    /// Quotient; the bound is infinite if the divisor may be zero.
    pub(crate) fn over(self, divisor: Self) -> Self {
        let least = divisor.value.abs() * (1.0 - ROUNDING) - divisor.error;
        if least <= 0.0 || !least.is_finite() {
            return Self { value: self.value / divisor.value, error: f64::INFINITY };
        }
        let value = self.value / divisor.value;
        let error = (self.error + value.abs() * divisor.error) / least;
        Self { value, error: error + 2.0 * ROUNDING * value.abs() + UNDERFLOW }
    }
}

impl Add for Bounded {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + ROUNDING * value.abs() }
    }
}

impl Sub for Bounded {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let value = self.value - other.value;
        Self { value, error: self.error + other.error + ROUNDING * value.abs() }
    }
}

impl Mul for Bounded {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + (other.value.abs() + other.error) * self.error;
        Self { value, error: error + ROUNDING * value.abs() + UNDERFLOW }
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

impl Ring for Bounded {
    fn whole(value: i32) -> Self {
        Self::exact(f64::from(value))
    }
}
