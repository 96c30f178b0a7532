//! From values to pixels, and the round numbers at an axis.

use super::chart::Scale;

/// Values beyond this are treated as not finite, so that differences stay finite.
const LARGEST: f64 = 1e300;

/// A number at an axis; fine ones have no label.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: String,
}

/// The numbers at an axis and the power of ten that all labels leave out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ticks {
    pub(super) ticks: Vec<Tick>,
    pub(super) fine: Vec<f64>,
    /// As `×10⁻³`, empty for none.
    pub(super) factor: String,
}

/// Whether a value has a place on an axis.
pub(super) fn can_show(scale: Scale, value: f64) -> bool {
    value.abs() <= LARGEST && (scale == Scale::Linear || value >= 1.0 / LARGEST)
}

/// A range of values, from pixel to pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mapping {
    scale: Scale,
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Mapping {
    /// `range` comes from [`range_of`].
    pub(super) fn new(scale: Scale, range: [f64; 2], from: f64, to: f64) -> Self {
        Self { scale, low: forward(scale, range[0]), high: forward(scale, range[1]), from, to }
    }

    /// Pixel of a value that can be shown. Far outside it is kept near enough to draw towards.
    pub(super) fn place(&self, value: f64) -> f64 {
        let share = (forward(self.scale, value) - self.low) / (self.high - self.low);
        self.from + share.clamp(-1e4, 1e4) * (self.to - self.from)
    }
}

fn forward(scale: Scale, value: f64) -> f64 {
    if scale == Scale::Log { value.log10() } else { value }
}

/// The range of an axis: the one that is asked for when it makes sense, or around all values that
/// can be shown with a margin of `pad` of the range.
pub(super) fn range_of(
    scale: Scale,
    asked: Option<[f64; 2]>,
    values: impl Iterator<Item = f64>,
    pad: f64,
) -> [f64; 2] {
    if let Some([low, high]) = asked {
        let shown = can_show(scale, low) && can_show(scale, high);
        if shown && forward(scale, high) - forward(scale, low) > 1e-12 * high.abs().min(1.0) {
            return [low, high];
        }
    }
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|&value| can_show(scale, value)) {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return if scale == Scale::Log { [0.1, 10.0] } else { [0.0, 1.0] };
    }
    match scale {
        Scale::Linear => padded(low, high, pad),
        Scale::Log => {
            let (from, to) = (low.log10(), high.log10());
            let margin = if to - from < 1e-6 { 0.5 } else { pad * (to - from) };
            [10_f64.powf((from - margin).max(-299.9)), 10_f64.powf((to + margin).min(299.9))]
        }
    }
}

fn padded(low: f64, high: f64, pad: f64) -> [f64; 2] {
    let size = low.abs().max(high.abs());
    if high - low <= 1e-10 * size || size < 1e-280 {
        let margin = if size < 1e-280 { 1.0 } else { 0.1 * size };
        return [low - margin, high + margin];
    }
    let margin = pad * (high - low);
    // A margin must not suggest values of the other sign.
    let low_end = if low >= 0.0 { (low - margin).max(0.0) } else { low - margin };
    let high_end = if high <= 0.0 { (high + margin).min(0.0) } else { high + margin };
    [low_end, high_end]
}

/// About `wanted` round numbers in a range.
pub(super) fn ticks(scale: Scale, range: [f64; 2], wanted: usize) -> Ticks {
    // A step of 5 may leave a short axis without two numbers.
    let found = [1, 2, 4].map(|more| match scale {
        Scale::Linear => linear_ticks(range, wanted * more),
        Scale::Log => log_ticks(range, wanted * more),
    });
    found.into_iter().find(|found| found.ticks.len() > 1).unwrap_or_default()
}

/// The next of 1, 2, 5 times a power of ten, or one that is only a little smaller.
fn round_up(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let factors = [1.0, 2.0, 5.0, 10.0];
    factors.map(|factor| factor * power).into_iter().find(|&step| step >= value * 0.85).unwrap_or(value)
}

fn linear_ticks([low, high]: [f64; 2], wanted: usize) -> Ticks {
    let step = round_up((high - low) / wanted.max(1) as f64);
    let slack = 1e-9 * (high - low) / step;
    let (first, last) = ((low / step - slack).ceil(), (high / step + slack).floor());
    if !(step > 0.0 && (0.0..100.0).contains(&(last - first))) {
        return Ticks::default();
    }
    // Counting keeps the last digits right: a running sum would not.
    let values: Vec<f64> = (0..=(last - first) as usize).map(|i| (first + i as f64) * step).collect();
    let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    let exponent = size.log10().floor();
    let shared = size > 0.0 && !(-3.0..5.0).contains(&exponent);
    let power = if shared { (exponent / 3.0).floor() * 3.0 } else { 0.0 };
    let decimals = (power - step.log10() - 1e-9).ceil().clamp(0.0, 12.0) as usize;
    let label = |value: f64| plain(value / 10_f64.powf(power), decimals);
    let factor = if shared { format!("×{}", power_of_ten(power as i32)) } else { String::new() };
    let ticks = values.iter().map(|&value| Tick { value, label: label(value) }).collect();
    Ticks { ticks, fine: Vec::new(), factor }
}

fn log_ticks([low, high]: [f64; 2], wanted: usize) -> Ticks {
    let (first, last) = ((low.log10() - 1e-9).ceil() as i32, (high.log10() + 1e-9).floor() as i32);
    let each = |n: i32| (2..10).map(move |m| f64::from(m) * 10_f64.powi(n));
    let fine = (first - 1..=last).flat_map(each).filter(|value| (low..=high).contains(value));
    if last - first < 2 {
        let few = few_decades([low, high], wanted);
        if last - first < 1 || few.ticks.len() <= wanted + 1 {
            return Ticks { fine: fine.collect(), ..few };
        }
    }
    let stride = ((last - first) as usize / wanted.clamp(2, 9) + 1) as i32;
    let labelled = (first..=last).filter(|n| n.rem_euclid(stride) == 0);
    let ticks = labelled.map(|n| Tick { value: 10_f64.powi(n), label: power_of_ten(n) }).collect();
    let fine: Vec<f64> = if stride == 1 {
        fine.collect()
    } else {
        (first..=last).filter(|n| n.rem_euclid(stride) != 0).map(|n| 10_f64.powi(n)).collect()
    };
    Ticks { ticks, fine, factor: String::new() }
}

/// Less than two powers of ten: 1, 2 and 5 get labels, or round steps as on a linear axis.
fn few_decades([low, high]: [f64; 2], wanted: usize) -> Ticks {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let each = |n: i32| [1.0, 2.0, 5.0].map(|m| m * 10_f64.powi(n));
    let values = (first..=last).flat_map(each);
    let values: Vec<f64> = values.filter(|value| (low..=high).contains(value)).collect();
    if values.len() < 3 {
        return linear_ticks([low, high], wanted);
    }
    let label = |value: f64| {
        let n = (value.log10() + 1e-9).floor() as i32;
        let digit = (value / 10_f64.powi(n)).round();
        match n {
            -3..0 => plain(value, n.unsigned_abs() as usize),
            0..5 => plain(value, 0),
            _ if digit == 1.0 => power_of_ten(n),
            _ => format!("{digit}×{}", power_of_ten(n)),
        }
    };
    let ticks = values.into_iter().map(|value| Tick { value, label: label(value) }).collect();
    Ticks { ticks, fine: Vec::new(), factor: String::new() }
}

/// A number with fixed decimals and a true minus sign; never `-0`.
fn plain(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.chars().all(|sign| matches!(sign, '-' | '0' | '.'));
    if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "\u{2212}") }
}

/// `10⁻⁶`.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let raised = |sign: char| match sign {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// A number with three digits for a sentence.
pub(super) fn three_digits(value: f64) -> String {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    if !value.is_finite() {
        value.to_string()
    } else if (-3.0..5.0).contains(&exponent) {
        plain(value, (2.0 - exponent).max(0.0) as usize)
    } else {
        format!("{}×{}", plain(value / 10_f64.powf(exponent), 2), power_of_ten(exponent as i32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(scale: Scale, range: [f64; 2]) -> Vec<String> {
        ticks(scale, range, 6).ticks.into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn labels_are_round_numbers() {
        assert_eq!(labels(Scale::Linear, [0.0, 1.0]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear, [-3.0, 3.1]), ["−3", "−2", "−1", "0", "1", "2", "3"]);
        assert_eq!(labels(Scale::Linear, [0.0, 2.1e-6]), ["0.0", "0.5", "1.0", "1.5", "2.0"]);
        assert_eq!(ticks(Scale::Linear, [0.0, 2.1e-6], 6).factor, "×10⁻⁶");
        assert_eq!(ticks(Scale::Linear, [0.0, 3e5], 6).factor, "×10³");
        assert_eq!(labels(Scale::Linear, [0.0, 3e5]).last().unwrap(), "300");
        assert_eq!(labels(Scale::Log, [1e-3, 10.0]), ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
        assert_eq!(labels(Scale::Log, [1e-12, 1e3]).len(), 6);
        assert_eq!(labels(Scale::Log, [0.15, 2.5]), ["0.2", "0.5", "1", "2"]);
        assert_eq!(labels(Scale::Log, [1.5e-7, 2.5e-6]), ["2×10⁻⁷", "5×10⁻⁷", "10⁻⁶", "2×10⁻⁶"]);
        assert_eq!(labels(Scale::Log, [1.1, 1.4]), ["1.10", "1.15", "1.20", "1.25", "1.30", "1.35", "1.40"]);
    }

    #[test]
    fn numbers_in_sentences_have_three_digits() {
        let cases =
            [(0.0, "0.00"), (1.234, "1.23"), (-56.78, "−56.8"), (1.5e-7, "1.50×10⁻⁷"), (99999.0, "99999")];
        for (value, text) in cases {
            assert_eq!(three_digits(value), text);
        }
    }

    #[test]
    fn ranges_are_sane_for_any_data() {
        let of = |scale, values: &[f64]| range_of(scale, None, values.iter().copied(), 0.05);
        assert_eq!(of(Scale::Linear, &[]), [0.0, 1.0]);
        assert_eq!(of(Scale::Linear, &[2.0, 2.0]), [1.8, 2.2]);
        assert_eq!(of(Scale::Linear, &[0.0, 10.0, f64::NAN]), [0.0, 10.5]);
        assert_eq!(of(Scale::Log, &[-1.0, 0.0]), [0.1, 10.0]);
        let asked = range_of(Scale::Log, Some([-1.0, 1.0]), [1.0, 10.0].into_iter(), 0.0);
        assert_eq!(asked, [1.0, 10.0]);
    }

    proptest! {
        #[test]
        fn ticks_lie_in_the_range_and_are_few(
            values in proptest::collection::vec(any::<f64>(), 0..6),
            asked in proptest::option::of(any::<[f64; 2]>()),
            wanted in 1_usize..12,
        ) {
            for scale in [Scale::Linear, Scale::Log] {
                let range = range_of(scale, asked, values.iter().copied(), 0.05);
                let mapping = Mapping::new(scale, range, 0.0, 100.0);
                let found = ticks(scale, range, wanted);
                prop_assert!(range[0] < range[1] && found.ticks.len() <= 30, "{range:?}");
                for tick in &found.ticks {
                    let place = mapping.place(tick.value);
                    prop_assert!((-0.1..=100.1).contains(&place), "{tick:?} at {place} of {range:?}");
                }
            }
        }
    }
}
