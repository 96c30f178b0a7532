//! The part of a ball in a box along the axes, for the many boxes that the surface of a ball cuts: a box at a time, quick and
//! without differences of large numbers.

use std::f64::consts::FRAC_1_SQRT_2;

/// Positive nodes and weights of the Gauss-Legendre rule of 6 points on \[-1, 1\].
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_3),
];

/// Area of the points of a disk about the origin in a rectangle. Exact.
pub(crate) fn disk_in_box(radius: f64, low: [f64; 2], high: [f64; 2]) -> f64 {
    let parts = |axis: usize| {
        let (from, to) = (low[axis], high[axis]);
        if to <= 0.0 {
            [(-to, -from), (0.0, 0.0)]
        } else if from >= 0.0 {
            [(from, to), (0.0, 0.0)]
        } else {
            [(0.0, -from), (0.0, to)]
        }
    };
    let mut area = 0.0;
    for x in parts(0).into_iter().filter(|(from, to)| to > from) {
        for y in parts(1).into_iter().filter(|(from, to)| to > from) {
            area += in_quarter(radius * radius, x, y);
        }
    }
    area
}

/// The same where no coordinate is negative, from the square of the radius: what lies left of where the upper side leaves the
/// disk, and what lies below the arc from there on.
fn in_quarter(square: f64, (left, right): (f64, f64), (lower, upper): (f64, f64)) -> f64 {
    let squared = |x: f64, y: f64| x * x + y * y;
    if squared(left, lower) >= square {
        return 0.0;
    }
    if squared(right, upper) <= square {
        return (right - left) * (upper - lower);
    }
    let on_arc = |other: f64| (square - other * other).max(0.0).sqrt();
    let from = on_arc(upper).clamp(left, right);
    let to = on_arc(lower).clamp(from, right);
    let (start, end) = (on_arc(from), on_arc(to));
    // Sine and cosine of the angle between the ends of the arc.
    let (sine, cosine) = ((to * start - from * end) / square, (start * end + from * to) / square);
    let angle = if sine < FRAC_1_SQRT_2 && cosine > 0.0 { sine.asin() } else { sine.atan2(cosine) };
    let below = 0.5 * (to * end - from * start + square * angle) - lower * (to - from);
    (from - left) * (upper - lower) + below
}

/// Volume of the points of a sphere about the origin in a box: disks integrated along the axis along which their part in
/// the box changes least.
pub(crate) fn sphere_in_box(radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
    let off = |axis: usize| (low[axis] + high[axis]).abs();
    let along = (0..3).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(0);
    let (a, b) = ((along + 1) % 3, (along + 2) % 3);
    // Farther along than this no disk reaches the box.
    let nearest = |axis: usize| low[axis].max(-high[axis]).max(0.0).powi(2);
    let reach = (radius * radius - nearest(a) - nearest(b)).max(0.0).sqrt();
    let (from, to) = (low[along].max(-reach), high[along].min(reach));
    if to <= from {
        return 0.0;
    }
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let slice = |at: f64| {
        let across = (radius * radius - at * at).max(0.0).sqrt();
        if across > 0.0 { disk_in_box(across, [low[a], low[b]], [high[a], high[b]]) } else { 0.0 }
    };
    let pair =
        |(node, weight): (f64, f64)| weight * (slice(middle + half * node) + slice(middle - half * node));
    half * GAUSS.into_iter().map(pair).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::sphere_below;
    use crate::random::Chance;
    use std::f64::consts::PI;

    #[test]
    fn boxes_that_fill_the_plane_share_a_disk_between_them() {
        for (radius, x, y) in [(9.3, 0.2, 0.7), (0.3, 0.5, 0.5), (1.0, 0.0, 0.0), (0.8, 0.01, 0.99)] {
            let mut area = 0.0;
            for (i, k) in (-11..11).flat_map(|i| (-11..11).map(move |k| (i, k))) {
                let low = [f64::from(i) - x, f64::from(k) - y];
                let part = disk_in_box(radius, low, low.map(|at| at + 1.0));
                assert!((-1e-15..=1.0 + 1e-14).contains(&part), "{part}");
                area += part;
            }
            assert!((area - PI * radius * radius).abs() < 1e-12 * radius * radius, "{radius}: {area}");
        }
    }

    /// By sampling: along each of many lines the part below the arc is known.
    #[test]
    fn parts_of_a_disk_match_samples() {
        let count = 20_000;
        for (low, high) in [
            ([0.3, 0.4], [1.3, 1.4]),
            ([-1.5, -0.5], [-0.5, 0.5]),
            ([-0.2, 0.6], [0.8, 1.6]),
            ([-1.2, -1.2], [1.2, 0.1]),
            ([0.6, -0.9], [0.9, -0.2]),
        ] {
            let width = (high[0] - low[0]) / f64::from(count);
            let part = |k: i32| {
                let x = low[0] + (f64::from(k) + 0.5) * width;
                let reach = (1.0_f64 - x * x).max(0.0).sqrt();
                (high[1].min(reach) - low[1].max(-reach)).max(0.0) * width
            };
            let sampled: f64 = (0..count).map(part).sum();
            let found = disk_in_box(1.0, low, high);
            assert!((found - sampled).abs() < 1e-6, "{low:?}: {found} {sampled}");
        }
    }

    /// By inclusion and exclusion of its corners, which is good to 1e-11.
    fn by_corners(radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
        let corner = |k: usize| {
            let upper: [bool; 3] = std::array::from_fn(|axis| k >> axis & 1 == 1);
            let at = std::array::from_fn(|axis| if upper[axis] { high[axis] } else { low[axis] });
            let sign = if upper.iter().filter(|upper| !**upper).count() % 2 == 0 { 1.0 } else { -1.0 };
            sign * sphere_below(radius, at)
        };
        (0..8).map(corner).sum()
    }

    #[test]
    fn parts_of_a_sphere_are_right_to_a_few_parts_in_ten_thousand() {
        let mut random = Chance::new(1);
        for (radius, allowed) in [(1.0, 2e-3), (3.0, 3e-4), (9.0, 3e-4)] {
            let (mut worst, mut cut) = (0.0_f64, 0);
            for _ in 0..20_000 {
                let mut coordinate = || (2.0 * random.uniform() - 1.0) * (radius + 1.0) - 0.5;
                let low = [coordinate(), coordinate(), coordinate()];
                let high = low.map(|at| at + 1.0);
                let near = |at: f64| at.max(-at - 1.0).max(0.0).powi(2);
                let far = |at: f64| (at + 1.0).max(-at).powi(2);
                let [nearest, farthest] = [low.map(near), low.map(far)].map(|all| all.iter().sum::<f64>());
                if nearest < radius * radius && farthest > radius * radius && cut < 2000 {
                    cut += 1;
                    let error = sphere_in_box(radius, low, high) - by_corners(radius, low, high);
                    worst = worst.max(error.abs());
                }
            }
            println!("radius {radius}: {worst:.2e} of a cell in {cut}");
            assert!(worst < allowed && cut > 500, "radius {radius}: {worst}, {cut}");
        }
    }

    #[test]
    fn a_sphere_is_the_sum_of_its_parts() {
        let (radius, mut volume) = (4.2, 0.0);
        for k in 0..11_i32.pow(3) {
            let low = [k % 11, k / 11 % 11, k / 121].map(|at| f64::from(at) - 5.37);
            volume += sphere_in_box(radius, low, low.map(|at| at + 1.0));
        }
        let whole = 4.0 / 3.0 * PI * radius * radius * radius;
        assert!((volume / whole - 1.0).abs() < 1e-5, "{}", volume / whole - 1.0);
    }
}
