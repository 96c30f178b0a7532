//! Exact numbers: whole numbers of any length times a power of two. Sums, differences and products
//! of floating-point numbers are such numbers, so a sign taken here is the true one.

use crate::bounded::Ring;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// `± magnitude * 2^exponent`, the magnitude in words of 64 bits, lowest first, without zeros at its top.
#[derive(Clone, Debug, Default)]
pub(crate) struct Dyadic {
    negative: bool,
    magnitude: Vec<u64>,
    exponent: i64,
}

impl Dyadic {
    /// The number, which must be finite.
    pub(crate) fn of(value: f64) -> Self {
        if value == 0.0 {
            return Self::default();
        }
        let bits = value.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i64;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        // Few bits make short products.
        let zeros = mantissa.trailing_zeros();
        Self {
            negative: value < 0.0,
            magnitude: vec![mantissa >> zeros],
            exponent: exponent + i64::from(zeros),
        }
    }

    /// Sign: -1, 0 or 1.
    pub(crate) fn sign(&self) -> i8 {
        match (self.magnitude.is_empty(), self.negative) {
            (true, _) => 0,
            (false, true) => -1,
            (false, false) => 1,
        }
    }

    /// The nearest floating-point number, to a few units in the last place, as `value * 2^exponent`
    /// with a value of order one: products of many factors overflow otherwise.
    pub(crate) fn scaled(&self) -> (f64, i64) {
        let words = &self.magnitude;
        let Some(&top) = words.last() else {
            return (0.0, 0);
        };
        let below = if words.len() > 1 { words[words.len() - 2] } else { 0 };
        let value = (top as f64) + (below as f64) * 2f64.powi(-64);
        let shift = 64 - i64::from(top.leading_zeros());
        let value = value * 2f64.powi(-(shift as i32));
        let exponent = self.exponent + 64 * (words.len() as i64 - 1) + shift;
        (if self.negative { -value } else { value }, exponent)
    }

    /// The magnitude times `2^bits`.
    fn shifted(&self, bits: i64) -> Vec<u64> {
        let (words, bits) = ((bits / 64) as usize, (bits % 64) as u32);
        let mut out = vec![0; words];
        out.reserve(self.magnitude.len() + 1);
        if bits == 0 {
            out.extend_from_slice(&self.magnitude);
            return out;
        }
        let mut carry = 0;
        for &word in &self.magnitude {
            out.push(word << bits | carry);
            carry = word >> (64 - bits);
        }
        if carry > 0 {
            out.push(carry);
        }
        out
    }

    fn plus(&self, other: &Self, negate: bool) -> Self {
        let other_negative = other.negative != negate;
        if other.magnitude.is_empty() {
            return self.clone();
        }
        if self.magnitude.is_empty() {
            return Self { negative: other_negative, ..other.clone() };
        }
        let exponent = self.exponent.min(other.exponent);
        let a = self.shifted(self.exponent - exponent);
        let b = other.shifted(other.exponent - exponent);
        if self.negative == other_negative {
            return Self { negative: self.negative, magnitude: sum(a, &b), exponent };
        }
        match compare(&a, &b) {
            Ordering::Equal => Self::default(),
            Ordering::Greater => Self { negative: self.negative, magnitude: difference(a, &b), exponent },
            Ordering::Less => Self { negative: other_negative, magnitude: difference(b, &a), exponent },
        }
    }
}

fn compare(a: &[u64], b: &[u64]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}

fn sum(mut a: Vec<u64>, b: &[u64]) -> Vec<u64> {
    if a.len() < b.len() {
        a.resize(b.len(), 0);
    }
    let mut carry = false;
    for (k, word) in a.iter_mut().enumerate() {
        let (once, first) = word.overflowing_add(b.get(k).copied().unwrap_or(0));
        let (twice, second) = once.overflowing_add(u64::from(carry));
        *word = twice;
        carry = first || second;
    }
    if carry {
        a.push(1);
    }
    a
}

/// `a - b` for `a >= b`.
fn difference(mut a: Vec<u64>, b: &[u64]) -> Vec<u64> {
    let mut borrow = false;
    for (k, word) in a.iter_mut().enumerate() {
        let (once, first) = word.overflowing_sub(b.get(k).copied().unwrap_or(0));
        let (twice, second) = once.overflowing_sub(u64::from(borrow));
        *word = twice;
        borrow = first || second;
    }
    while a.last() == Some(&0) {
        a.pop();
    }
    a
}

impl Add for Dyadic {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.plus(&other, false)
    }
}

impl Sub for Dyadic {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.plus(&other, true)
    }
}

impl Mul for Dyadic {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self.magnitude.is_empty() || other.magnitude.is_empty() {
            return Self::default();
        }
        let mut magnitude = vec![0_u64; self.magnitude.len() + other.magnitude.len()];
        for (i, &a) in self.magnitude.iter().enumerate() {
            let mut carry = 0_u128;
            for (j, &b) in other.magnitude.iter().enumerate() {
                let word = u128::from(a) * u128::from(b) + u128::from(magnitude[i + j]) + carry;
                magnitude[i + j] = word as u64;
                carry = word >> 64;
            }
            magnitude[i + other.magnitude.len()] = carry as u64;
        }
        while magnitude.last() == Some(&0) {
            magnitude.pop();
        }
        Self {
            negative: self.negative != other.negative,
            magnitude,
            exponent: self.exponent + other.exponent,
        }
    }
}

impl Neg for Dyadic {
    type Output = Self;
    fn neg(self) -> Self {
        Self { negative: !self.negative, ..self }
    }
}

impl Ring for Dyadic {
    fn whole(value: i32) -> Self {
        Self::of(f64::from(value))
    }
}

/// Sign of `p + q sqrt(g)`, `g >= 0`.
pub(crate) fn sign_with_root(p: &Dyadic, q: &Dyadic, g: &Dyadic) -> i8 {
    let (first, second) = (p.sign(), q.sign() * g.sign());
    if first == second || second == 0 {
        return first;
    }
    if first == 0 {
        return second;
    }
    let square = p.clone() * p.clone() - q.clone() * q.clone() * g.clone();
    first * square.sign()
}

/// Sign of `p + q sqrt(g) + r sqrt(h) + s sqrt(g h)`, `g, h >= 0`.
pub(crate) fn sign_with_roots([p, q, r, s]: [&Dyadic; 4], g: &Dyadic, h: &Dyadic) -> i8 {
    let first = sign_with_root(p, q, g);
    let second = sign_with_root(r, s, g) * h.sign();
    if first == second || second == 0 {
        return first;
    }
    if first == 0 {
        return second;
    }
    let of = |a: &Dyadic, b: &Dyadic| a.clone() * b.clone();
    // (p + q sqrt g)^2 - h (r + s sqrt g)^2
    let plain = of(p, p) + of(&of(q, q), g) - of(h, &(of(r, r) + of(&of(s, s), g)));
    let root = Dyadic::whole(2) * (of(p, q) - of(h, &of(r, s)));
    first * sign_with_root(&plain, &root, g)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(value: f64) -> Dyadic {
        Dyadic::of(value)
    }

    #[test]
    fn sums_and_products_are_those_of_whole_numbers() {
        let values = [0_i64, 1, -1, 3, -7, 1 << 40, -(1 << 40) + 1, (1 << 53) - 1, -(1 << 52) - 3];
        for a in values {
            for b in values {
                let (x, y) = (number(a as f64), number(b as f64));
                let wide = |value: i128| {
                    let part =
                        |shift: u32| (value >> shift & ((1 << 40) - 1)) as f64 * 2f64.powi(shift as i32);
                    number((value >> 80) as f64 * 2f64.powi(80)) + number(part(40)) + number(part(0))
                };
                let (a, b) = (i128::from(a), i128::from(b));
                assert_eq!((x.clone() + y.clone() - wide(a + b)).sign(), 0, "{a} + {b}");
                assert_eq!((x.clone() * y.clone() - wide(a * b)).sign(), 0, "{a} * {b}");
                assert_eq!((x - y).sign(), (a - b).signum() as i8, "{a} - {b}");
            }
        }
    }

    #[test]
    fn extremes_of_the_format_keep_their_place() {
        let (tiny, huge) = (5e-324, f64::MAX);
        assert_eq!((number(huge) + number(tiny) - number(huge) - number(tiny)).sign(), 0);
        assert_eq!((number(huge) + number(tiny) - number(huge)).sign(), 1);
        let (value, exponent) = (number(huge) * number(huge)).scaled();
        assert!((0.5..=1.0).contains(&value) && (2047..=2049).contains(&exponent));
    }

    #[test]
    fn signs_with_roots_tell_what_rounding_hides() {
        // (1 + sqrt 2)^2 = 3 + 2 sqrt 2, and 2^-40 more or less.
        let two = number(2.0);
        for (shift, sign) in [(0.0, 0), (2f64.powi(-300), 1), (-(2f64.powi(-300)), -1)] {
            // sqrt(8) - 2 sqrt(2) + shift
            let nought = number(0.0);
            let terms = [&number(shift), &number(-2.0), &number(1.0), &nought];
            assert_eq!(sign_with_roots(terms, &two, &number(8.0)), sign);
            assert_eq!(sign_with_root(&number(3.0 * shift), &number(0.0), &two), sign);
        }
        // sqrt 2 sqrt 3 = sqrt 6: 5 - 2 sqrt 6 > 0 > 4.8 - 2 sqrt 6
        for (p, sign) in [(5.0, 1), (4.8, -1)] {
            let terms = [&number(p), &number(0.0), &number(0.0), &number(-2.0)];
            assert_eq!(sign_with_roots(terms, &two, &number(3.0)), sign);
        }
    }
}
