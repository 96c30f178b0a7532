//! Parts of a ball cut off by planes along the axes.

mod in_box;

pub(crate) use in_box::{disk_in_box, sphere_in_box};

use core::f64::consts::{FRAC_PI_2, PI};

/// Positive nodes and weights of the Gauss-Legendre rule of 16 points on \[-1, 1\].
const GAUSS: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_5),
    (0.617_876_244_402_643_7, 0.149_595_988_816_576_7),
    (0.755_404_408_355_003, 0.124_628_971_255_533_9),
    (0.865_631_202_387_831_7, 0.095_158_511_682_492_8),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_9),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_1),
];

/// Area \[m^2\] of the points of a disk about the origin below `x` and below `y` \[m\]. Exact.
pub(crate) fn disk_below(radius: f64, x: f64, y: f64) -> f64 {
    let square = radius * radius;
    let (x, y) = (x.clamp(-radius, radius), y.clamp(-radius, radius));
    // Area between the middle line and the line at `h`, over two.
    let slice = |h: f64| 0.5 * (h * (square - h * h).max(0.0).sqrt() + square * (h / radius).asin());
    let below = |h: f64| FRAC_PI_2 * square + 2.0 * slice(h);
    if x * x + y * y < square {
        return 0.25 * PI * square + x * y + slice(x) + slice(y);
    }
    // The corner is outside: the part is bounded by one line, by two apart, or empty.
    match (x < 0.0, y < 0.0) {
        (true, true) => 0.0,
        (true, false) => below(x),
        (false, true) => below(y),
        (false, false) => below(x) + below(y) - PI * square,
    }
}

/// Volume \[m^3\] of the points of a sphere about the origin below `x`, `y` and `z` \[m\]: disks
/// integrated along one axis, piece by piece between the heights at which an edge is met; to about 1e-11 of
/// the sphere.
pub(crate) fn sphere_below(radius: f64, corner: [f64; 3]) -> f64 {
    if corner.iter().any(|&h| h <= -radius) {
        return 0.0;
    }
    let mut corner = corner.map(|h| h.min(radius));
    // The axis of the integral is the one whose plane cuts least.
    corner.sort_by(f64::total_cmp);
    let [x, y, z] = corner;
    if y >= radius {
        // One plane cuts: a cap.
        return PI * (2.0 * radius.powi(3) / 3.0 + x * (radius * radius - x * x / 3.0));
    }
    let end = (z / radius).asin();
    let mut bounds = vec![-FRAC_PI_2, end];
    for reach in [x.abs(), y.abs(), x.hypot(y)] {
        let angle = (reach / radius).min(1.0).acos();
        bounds.extend([-angle, angle].into_iter().filter(|angle| *angle < end));
    }
    bounds.sort_by(f64::total_cmp);
    let slice = |angle: f64| {
        let across = radius * angle.cos();
        if across > 0.0 { disk_below(across, x, y) * across } else { 0.0 }
    };
    // In halves, which takes the error of a long piece from 1e-9 below 1e-11.
    let halves = |from: f64, to: f64| {
        let middle = 0.5 * (from + to);
        integral(from, middle, slice) + integral(middle, to, slice)
    };
    bounds.windows(2).map(|pair| halves(pair[0], pair[1])).sum()
}

/// Integral of a function that is smooth but for square roots at the ends.
fn integral(from: f64, to: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    // t -> t (3 - t^2)/2 has no slope at the ends and takes the roots away.
    let at = |t: f64| function(middle + half * 0.5 * t * (3.0 - t * t)) * 1.5 * (1.0 - t * t);
    half * GAUSS.iter().map(|&(node, weight)| weight * (at(node) + at(-node))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_disk_match_a_fine_raster() {
        let count = 2000;
        let step = 2.0 / f64::from(count);
        for (x, y) in [
            (0.3_f64, 0.4_f64),
            (-0.3, 0.4),
            (-0.5, -0.6),
            (0.9, 0.8),
            (-0.9, 0.8),
            (2.0, -0.2),
            (-0.8, -0.9),
        ] {
            let mut inside = 0.0;
            for i in 0..count {
                let px = -1.0 + (f64::from(i) + 0.5) * step;
                if px < x {
                    let reach = (1.0_f64 - px * px).sqrt();
                    inside += (y.min(reach) + reach).max(0.0) * step;
                }
            }
            assert!((disk_below(1.0, x, y) - inside).abs() < 2e-3, "{x} {y}: {inside}");
        }
    }

    #[test]
    fn eight_parts_make_a_sphere_and_symmetric_parts_are_known() {
        let whole = 4.0 / 3.0 * PI;
        assert!((sphere_below(1.0, [0.0; 3]) - whole / 8.0).abs() < 1e-11);
        assert!((sphere_below(1.0, [0.0, 0.0, 2.0]) - whole / 4.0).abs() < 1e-11);
        assert!((sphere_below(1.0, [5.0; 3]) - whole).abs() < 1e-11);
        for point in
            [[0.2, -0.4, 0.6], [0.5, 0.5, 0.5], [-0.1, 0.95, 0.3], [0.7, 0.7, 0.1], [0.99, -0.99, 0.0]]
        {
            // Inclusion and exclusion over the eight octants, by reflection.
            let mut sum = 0.0;
            for octant in 0..8 {
                let flip = |axis: usize| octant >> axis & 1 == 1;
                let sign = |axis: usize| if flip(axis) { -point[axis] } else { point[axis] };
                sum += sphere_below(1.0, [sign(0), sign(1), sign(2)]);
            }
            assert!((sum - whole).abs() < 2e-11, "{point:?}: {}", sum - whole);
        }
    }
}
