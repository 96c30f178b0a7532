//! The curve by volume, tabulated over the curve by number.

use granular_core::Dim;

/// Intervals of the table.
const INTERVALS: usize = 8192;

/// Volume finer over number finer. Sizes are diameters over the smallest diameter.
pub(super) struct NumberCurve {
    ratio: f64,
    /// Share of the number finer than each node, 0 to 1.
    number: Vec<f64>,
    /// Share of the volume finer than each node, 0 to 1.
    volume: Vec<f64>,
    /// Slope of volume over number at each node: `size^N / mean`.
    slope: Vec<f64>,
    /// Mean of `size^N` over all grains.
    mean: f64,
}

/// Place of a node in the logarithm of the size, 0 to 1. Nodes crowd at both ends, where a curve
/// with a shape parameter below one rises without bound.
fn part(node: usize) -> f64 {
    let u = node as f64 / INTERVALS as f64;
    u.powi(4) * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)))
}

impl NumberCurve {
    /// `reduced` is the curve by volume over the reduced diameter, `ratio` largest over smallest.
    pub(super) fn new<D: Dim>(ratio: f64, reduced: impl Fn(f64) -> f64) -> Self {
        let power = D::N as i32;
        let logarithm = ratio.ln();
        // The difference of exponentials keeps its digits when both diameters nearly agree.
        let size = |part: f64| (part * logarithm).exp();
        let reduced_diameter = |part: f64| (part * logarithm).exp_m1() / (ratio - 1.0);
        let mut volume: Vec<f64> =
            (0..=INTERVALS).map(|node| reduced(reduced_diameter(part(node)))).collect();
        volume[INTERVALS] = 1.0;
        let mut number = vec![0.0; INTERVALS + 1];
        for node in 0..INTERVALS {
            let middle = size(0.5 * (part(node) + part(node + 1)));
            let grains = (volume[node + 1] - volume[node]).max(0.0) / middle.powi(power);
            number[node + 1] = number[node] + grains;
        }
        let mean = 1.0 / number[INTERVALS];
        number.iter_mut().for_each(|share| *share *= mean);
        let slope = (0..=INTERVALS).map(|node| size(part(node)).powi(power) / mean).collect();
        Self { ratio, number, volume, slope, mean }
    }

    /// One size per stratum of equal number, each with the mean volume of its stratum; rising.
    pub(super) fn strata<D: Dim>(&self, count: usize) -> Vec<f64> {
        let mut below = 0.0;
        (1..=count)
            .map(|stratum| {
                let upto = if stratum == count { 1.0 } else { self.volume_at(stratum as f64 / count as f64) };
                let volume = (upto - below) * count as f64 * self.mean;
                below = upto;
                volume.powf(1.0 / D::N as f64).clamp(1.0, self.ratio)
            })
            .collect()
    }

    /// Volume finer where `share` of the number is finer: cubic between nodes, since the slope
    /// there is known exactly.
    fn volume_at(&self, share: f64) -> f64 {
        let above = self.number.partition_point(|&number| number <= share).clamp(1, INTERVALS);
        let below = above - 1;
        let width = self.number[above] - self.number[below];
        if width <= 0.0 {
            return self.volume[below];
        }
        let t = ((share - self.number[below]) / width).clamp(0.0, 1.0);
        let rise = self.volume[above] - self.volume[below];
        let (start, end) = (self.slope[below] * width - rise, rise - self.slope[above] * width);
        self.volume[below] + t * rise + t * (1.0 - t) * ((1.0 - t) * start + t * end)
    }
}
