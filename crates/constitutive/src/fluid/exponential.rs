//! `(1 - exp(-x)) / x` without a call, so that a loop over particles stays in wide registers.

/// `(1 - exp(-x)) / x` for x of 0 or more, 1 at 0; right to a few units of the last place.
///
/// With `-x = n ln 2 + r` and `|r| <= ln(2) / 2`, `exp(-x) - 1 = 2^n (exp(r) - 1) + (2^n - 1)`, and `exp(r) - 1` is its series.
#[inline(always)]
pub(super) fn relative_decay(x: f64) -> f64 {
    /// Adding it rounds to a whole number, which its lowest bits then hold.
    const ROUNDING: f64 = 6_755_399_441_055_744.0;
    /// The logarithm of 2 in two parts, of which the first has zeros at its end.
    const HIGH: f64 = 6.931_471_803_691_238e-1;
    const LOW: f64 = 1.908_214_929_270_587_7e-10;
    let bounded = if x > 700.0 { 700.0 } else { x };
    let shifted = ROUNDING - bounded * std::f64::consts::LOG2_E;
    let n = shifted - ROUNDING;
    let r = (-bounded - n * HIGH) - n * LOW;
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
    let decay = power * (r + r * r * series(r)) + (power - 1.0);
    let small = x < 1e-300;
    if small { 1.0 } else { -decay / x }
}

/// `(exp(r) - 1 - r) / r^2`.
#[inline(always)]
fn series(r: f64) -> f64 {
    const FACTORS: [f64; 12] = [
        1.0 / 6_227_020_800.0,
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
    ];
    let mut sum = 0.0;
    for factor in FACTORS {
        sum = sum * r + factor;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::relative_decay;

    #[test]
    fn it_is_that_of_the_library() {
        let mut worst: f64 = 0.0;
        for step in 0..200_000 {
            let x = 10.0_f64.powf(-20.0 + 23.5 * f64::from(step) / 200_000.0);
            let wanted = -(-x).exp_m1() / x;
            worst = worst.max((relative_decay(x) / wanted - 1.0).abs());
        }
        assert!(worst < 6e-16, "{worst}");
        assert_eq!(relative_decay(0.0), 1.0);
        assert_eq!(relative_decay(f64::INFINITY), 0.0);
        assert!(relative_decay(f64::NAN).is_nan());
    }
}
