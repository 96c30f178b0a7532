//! The spectrum of a series, and its highest peak.

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection};
use std::f64::consts::TAU;

/// Length of the transform over that of the series: finer steps of frequency, no more resolution.
const PADDING: usize = 4;
/// Periods that the lowest frequency of a peak must have within the series; below are drift and mean.
const PERIODS: f64 = 1.5;

/// Amplitudes over frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Frequency \[1/s\] and amplitude, in the unit of the series.
    pub points: Vec<[f64; 2]>,
    /// Frequency of the highest peak \[1/s\]; none when the series is too short or still.
    pub peak: Option<f64>,
}

/// The spectrum of values at increasing times \[s\], through a Hann window, about their mean.
pub fn spectrum(times: &[f64], values: &[f64]) -> Option<Spectrum> {
    let count = times.len().min(values.len());
    let (first, last) = (*times.first()?, *times.get(count.checked_sub(1)?)?);
    let duration = last - first;
    if count < 8 || !(duration > 0.0 && values.iter().all(|value| value.is_finite())) {
        return None;
    }
    let step = duration / (count - 1) as f64;
    let even = resampled(&times[..count], &values[..count], first, step);
    let mean = even.iter().sum::<f64>() / count as f64;
    let window = |k: usize| 0.5 * (1.0 - (TAU * (k as f64 + 0.5) / count as f64).cos());
    let weight: f64 = (0..count).map(window).sum();
    let length = (PADDING * count).next_power_of_two();
    let mut waves = vec![Complex::default(); length];
    for (k, value) in even.iter().enumerate() {
        waves[k].re = (value - mean) * window(k);
    }
    // A planner would compile transforms of all lengths, for several instruction sets.
    Radix4::new(length, FftDirection::Forward).process(&mut waves);
    let frequency = |k: f64| k / (length as f64 * step);
    let points: Vec<[f64; 2]> = waves[..=length / 2]
        .iter()
        .enumerate()
        .map(|(k, wave)| [frequency(k as f64), 2.0 * wave.norm() / weight])
        .collect();
    let lowest = points.iter().position(|point| point[0] >= PERIODS / duration)?;
    let highest = (lowest..points.len() - 1).max_by(|a, b| points[*a][1].total_cmp(&points[*b][1]))?;
    let peak = (highest > 0 && points[highest][1] > 1e-12 * mean.abs()).then(|| {
        let [a, b, c] = [highest - 1, highest, highest + 1].map(|k| points[k][1].max(f64::MIN_POSITIVE).ln());
        // The vertex of the parabola through the logarithms.
        let offset = 0.5 * (a - c) / (a - 2.0 * b + c);
        frequency(highest as f64 + if offset.is_finite() { offset.clamp(-1.0, 1.0) } else { 0.0 })
    });
    Some(Spectrum { points, peak })
}

/// Values at equal steps, linear between those given.
fn resampled(times: &[f64], values: &[f64], first: f64, step: f64) -> Vec<f64> {
    let mut after = 1;
    (0..times.len())
        .map(|k| {
            let time = first + k as f64 * step;
            while after + 1 < times.len() && times[after] < time {
                after += 1;
            }
            let (a, b) = (times[after - 1], times[after]);
            let share = if b > a { ((time - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
            values[after - 1] * (1.0 - share) + values[after] * share
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_wave_is_its_frequency_and_amplitude() {
        let times: Vec<f64> = (0..2000).map(|k| 3.0 + 0.01 * f64::from(k)).collect();
        let wave = |t: &f64| 7.0 + 0.4 * (TAU * 1.234 * t).sin() + 0.05 * (TAU * 5.0 * t).cos();
        let values: Vec<f64> = times.iter().map(wave).collect();
        let found = spectrum(&times, &values).unwrap();
        assert!((found.peak.unwrap() - 1.234).abs() < 1e-4, "{:?}", found.peak);
        let highest = found.points.iter().map(|point| point[1]).fold(0.0, f64::max);
        assert!((highest - 0.4).abs() < 0.01, "{highest}");
    }

    #[test]
    fn what_has_no_peak_says_so() {
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        assert_eq!(spectrum(&times, &vec![2.0; 100]).unwrap().peak, None);
        assert_eq!(spectrum(&times[..5], &[1.0; 5]), None);
        assert_eq!(spectrum(&times, &vec![f64::NAN; 100]), None);
        assert_eq!(spectrum(&[], &[]), None);
    }
}
