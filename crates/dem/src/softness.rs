//! By how much contacts must be stiffer.

/// Power of the overlap of an impact with which its stiffness falls: a linear contact has `overlap ~ k^(-1/2)`.
pub(crate) const LINEAR: f64 = 2.0;
/// A Hertz contact has `overlap ~ E^(-2/5)`.
pub(crate) const HERTZ: f64 = 2.5;

/// By which factor contacts must be stiffer for an overlap that is `too_much` times what is allowed.
pub(crate) fn softer_than(too_much: f64, power: f64) -> f64 {
    rounded_up(too_much.powf(power))
}

/// Rounded up to two digits, so that advice which is followed is enough.
pub(crate) fn rounded_up(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return value;
    }
    let unit = 10.0_f64.powi(value.log10().floor() as i32 - 1);
    // Printed and read, so that no digits of round-off are shown.
    format!("{:.1e}", (value / unit).ceil() * unit).parse().unwrap_or(value)
}
