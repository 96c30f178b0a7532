//! The root of a function between bounds.

/// Where a function that falls from above zero at `low` to zero or less at `high` is within `negligible` of zero, by the Illinois variant of
/// the rule of false position: never outside of the bounds, however the function bends.
pub(super) fn between(
    (mut low, mut at_low): (f64, f64),
    (mut high, mut at_high): (f64, f64),
    negligible: f64,
    function: impl Fn(f64) -> f64,
) -> f64 {
    // How often in a row the lower bound (above zero) or the upper one (below) was moved.
    let mut moved = 0;
    for _ in 0..100 {
        let secant = (low * at_high - high * at_low) / (at_high - at_low);
        let middle = if secant > low && secant < high { secant } else { 0.5 * (low + high) };
        let value = function(middle);
        if value.abs() <= negligible || high - low <= 1e-15 * high {
            return middle;
        }
        // A bound that stays twice counts half, so that it does not stay for ever.
        if value > 0.0 {
            (low, at_low) = (middle, value);
            moved = if moved > 0 { moved + 1 } else { 1 };
            at_high *= if moved > 1 { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (middle, value);
            moved = if moved < 0 { moved - 1 } else { -1 };
            at_low *= if moved < -1 { 0.5 } else { 1.0 };
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn roots_of_bent_functions_are_found() {
        let found =
            |function: fn(f64) -> f64| between((0.0, function(0.0)), (2.0, function(2.0)), 1e-15, function);
        assert!((found(|x| 1.0 - x) - 1.0).abs() < 1e-15);
        assert!((found(|x| (-9.0 * x).exp() - 1e-4) - 4.0 * 10.0_f64.ln() / 9.0).abs() < 1e-11);
        assert!((found(|x| if x < 0.3 { 1.0 - x } else { 0.7 - 1e3 * (x - 0.3) }) - 0.3007).abs() < 1e-12);
        assert!((found(|x| 1e-3 - x.powi(9)) - 0.1_f64.powf(1.0 / 3.0)).abs() < 1e-12);
    }
}
