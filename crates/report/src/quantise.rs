//! Numbers as whole numbers of few bits.

/// Bits of a quantised number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bits {
    /// One byte.
    Eight,
    /// Two bytes, the lower one first.
    Sixteen,
}

impl Bits {
    /// Bytes of a number.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Eight => 1,
            Self::Sixteen => 2,
        }
    }

    /// The largest whole number; it stands for what is no number, or larger than 1e300.
    pub fn missing(self) -> u16 {
        match self {
            Self::Eight => u8::MAX.into(),
            Self::Sixteen => u16::MAX,
        }
    }

    /// The whole number of the highest value.
    fn top(self) -> f64 {
        f64::from(self.missing() - 1)
    }
}

/// Whether a number is kept: finite, and so far from the largest there are that differences are finite too.
pub(crate) fn is_kept(value: f64) -> bool {
    value.abs() <= 1e300
}

/// Maps numbers from `low` on to whole numbers of steps, rounded to the nearest.
///
/// ```
/// use granular_report::{Bits, Quantiser};
/// let quantiser = Quantiser::new(-1.0, 3.0, Bits::Sixteen);
/// let back = quantiser.value(quantiser.level(0.1234)).unwrap_or(f64::NAN);
/// assert!((back - 0.1234).abs() <= quantiser.largest_error());
/// assert_eq!(quantiser.value(quantiser.level(f64::NAN)), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantiser {
    /// The lowest value.
    pub low: f64,
    /// Distance of neighbouring values; zero when all are the same.
    pub step: f64,
    /// Bits of a number.
    pub bits: Bits,
}

impl Quantiser {
    /// For values from `low` to `high`, both at most 1e300 in size.
    pub fn new(low: f64, high: f64, bits: Bits) -> Self {
        let step = (high - low) / bits.top();
        Self { low, step: step.max(0.0), bits }
    }

    /// The whole number of a value. Values beyond the ends go to the ends.
    pub fn level(&self, value: f64) -> u16 {
        if !is_kept(value) {
            return self.bits.missing();
        }
        if self.step == 0.0 {
            return 0;
        }
        ((value - self.low) / self.step).round().clamp(0.0, self.bits.top()) as u16
    }

    /// The value of a whole number; none where there was no finite number.
    pub fn value(&self, level: u16) -> Option<f64> {
        (level != self.bits.missing()).then(|| self.low + f64::from(level) * self.step)
    }

    /// How far a value between the ends may be from the one that is kept, up to round-off.
    pub fn largest_error(&self) -> f64 {
        0.5 * self.step * (1.0 + 1e-9) + 4.0 * f64::EPSILON * self.low.abs()
    }

    /// Values as bytes.
    pub(crate) fn bytes(&self, values: impl Iterator<Item = f64>) -> Vec<u8> {
        match self.bits {
            Bits::Eight => values.map(|value| self.level(value) as u8).collect(),
            Bits::Sixteen => values.flat_map(|value| self.level(value).to_le_bytes()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_value_is_off_by_more_than_half_a_step() {
        for (low, high) in [(0.0, 1.0), (-3e-7, 5e-7), (1e6, 1e6 + 1.0), (-1e300, 1e300)] {
            for bits in [Bits::Eight, Bits::Sixteen] {
                let quantiser = Quantiser::new(low, high, bits);
                for k in 0..=1000 {
                    let share = f64::from(k) / 1000.0;
                    let value = low * (1.0 - share) + high * share;
                    let back = quantiser.value(quantiser.level(value)).unwrap();
                    let error = (back - value).abs();
                    assert!(error <= quantiser.largest_error(), "{low} to {high}, {value}: off by {error}");
                }
                let share = quantiser.step / (high - low);
                assert!((share * bits.top() - 1.0).abs() < 1e-12, "the steps fill the range");
            }
        }
    }

    #[test]
    fn what_is_no_number_is_missing_and_equal_values_stay_as_they_are() {
        let quantiser = Quantiser::new(0.1, 0.1, Bits::Eight);
        assert_eq!(quantiser.value(quantiser.level(0.1)), Some(0.1));
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
            assert_eq!(quantiser.level(value), 255);
            assert_eq!(Quantiser::new(0.0, 1.0, Bits::Sixteen).level(value), 65535);
        }
        let quantiser = Quantiser::new(0.0, 1.0, Bits::Eight);
        assert_eq!((quantiser.level(-1.0), quantiser.level(2.0)), (0, 254));
    }
}
