//! What the sweep asks: which disk hides which, on which side of a break of the beach line a site
//! lies, whether an arc vanishes. The answers are those of exact arithmetic.
//!
//! All is polynomial in the differences of `x`, `low = y - r` and `high = y + r`. With
//! $k = s - low$ the height of the sweep line $s$ above the lowest point of a disk, the points
//! nearer to the disk than to the sweep line (distances minus radius) lie below the parabola
//! $2 y = high + low + k - (x - x_i)^2 / k$ \[Fortune1987, section 4\]; the beach line is the upper envelope of the
//! parabolas.

use crate::bounded::{Bounded, Ring};
use crate::dyadic::{Dyadic, sign_with_root, sign_with_roots};
use crate::site::{Seen, Site, difference, exact_difference, order};
use std::cmp::Ordering;

/// Square of the distance of the centres minus that of the difference of radii.
#[inline(always)]
pub(crate) fn separation<R: Ring>(seen: &Seen<R>) -> R {
    seen.x.clone() * seen.x.clone() + seen.low.clone() * seen.high.clone()
}

/// The same, exactly until it is rounded once.
pub(crate) fn exact_separation(a: &Site, b: &Site) -> f64 {
    let (value, exponent) = separation(&Seen::exactly(a, b)).scaled();
    value * 2f64.powi(exponent.clamp(-1074, 1023) as i32)
}

/// Whether one of two disks lies within the other.
pub(crate) fn nested(a: &Site, b: &Site) -> bool {
    let sign = separation(&Seen::of(a, b)).sign();
    sign.unwrap_or_else(|| separation(&Seen::exactly(a, b)).sign()) <= 0
}

/// The two polynomials that tell the side of a break: `k` and `x` of the new site as seen from the
/// site at the left (0) and right (1), and the difference of their highest points.
#[inline(always)]
fn side<R: Ring>(k: [R; 2], x: [R; 2], high: R) -> [R; 2] {
    let [i, j] = k;
    let [x_i, x_j] = x;
    let slope = j.clone() * x_i.clone() - i.clone() * x_j.clone();
    // Positive where the parabola at the right is the upper one.
    let upper = j.clone() * x_i.clone() * x_i - i.clone() * x_j.clone() * x_j - i * j * high;
    [slope, upper]
}

/// Whether the new site lies to the right of the break between the arcs of `left` and `right`, when
/// the sweep line meets the site.
pub(crate) fn beyond_break(site: &Site, left: &Site, right: &Site) -> bool {
    let filtered = || {
        let k = [left, right].map(|other| difference(site.low, other.low));
        let x = [left, right].map(|other| Bounded::exact(site.x) - Bounded::exact(other.x));
        let [slope, upper] = side(k, x, difference(left.high, right.high));
        Some((slope.sign()?, upper.sign()?))
    };
    let (slope, upper) = filtered().unwrap_or_else(|| {
        let k = [left, right].map(|other| exact_difference(site.low, other.low));
        let x = [left, right].map(|other| Dyadic::of(site.x) - Dyadic::of(other.x));
        let [slope, upper] = side(k, x, exact_difference(left.high, right.high));
        (slope.sign(), upper.sign())
    });
    // The later of the two has the narrower parabola: above the other one between two breaks.
    if order(left.low, right.low) == Ordering::Less { slope < 0 || upper > 0 } else { slope > 0 && upper > 0 }
}

/// Whether the arc of `middle` between those of `left` and `right` ever vanishes: whether the
/// breaks at its ends run towards each other in the end.
pub(crate) fn vanishes(left: &Site, middle: &Site, right: &Site) -> bool {
    if left.radius == middle.radius && middle.radius == right.radius {
        let [a, b, c] = [left, middle, right].map(|site| robust::Coord { x: site.x, y: site.y });
        return robust::orient2d(a, b, c) > 0.0;
    }
    let approach = approach(&Seen::of(left, middle), &Seen::of(right, middle)).and_then(Bounded::sign);
    let sign = approach
        .unwrap_or_else(|| approach_exactly(&Seen::exactly(left, middle), &Seen::exactly(right, middle)));
    sign < 0
}

/// Where the sign is certain: that of the distance, in the end, of the breaks at the right and left of the
/// origin's arc. A break at `x` tends to a multiple of the height `u` of the sweep line above the
/// origin's disk, `x / u = (x_i + sqrt w) / low` at the left and `(x_k - sqrt w) / low` at the right.
fn approach(left: &Seen<Bounded>, right: &Seen<Bounded>) -> Option<Bounded> {
    let [w_i, w_k] = [left, right].map(|seen| separation(seen).root());
    // Of two equal fractions the one without cancellation.
    let (up_i, down_i) =
        if left.x.value < 0.0 { (left.high, w_i - left.x) } else { (left.x + w_i, left.low) };
    let (up_k, down_k) =
        if right.x.value > 0.0 { (-right.high, w_k + right.x) } else { (right.x - w_k, right.low) };
    let turned = f64::from(down_i.sign()? * down_k.sign()?);
    Some(Bounded::exact(turned) * (up_k * down_i - up_i * down_k))
}

fn approach_exactly(left: &Seen<Dyadic>, right: &Seen<Dyadic>) -> i8 {
    let two = || Dyadic::whole(2);
    let of = |a: &Dyadic, b: &Dyadic| a.clone() * b.clone();
    let [w_i, w_k] = [left, right].map(separation);
    match (left.low.sign(), right.low.sign()) {
        // Lowest points at one height: the break is `x / u = high / (-2 x)`.
        (0, 0) => (of(&right.high, &left.x) - of(&left.high, &right.x)).sign(),
        (0, turned) => {
            let plain = -(two() * of(&left.x, &right.x)) - of(&left.high, &right.low);
            turned * sign_with_root(&plain, &(two() * left.x.clone()), &w_k)
        }
        (turned, 0) => {
            let plain = -(two() * of(&left.x, &right.x)) - of(&right.high, &left.low);
            turned * sign_with_root(&plain, &-(two() * right.x.clone()), &w_i)
        }
        (of_left, of_right) => {
            let plain = of(&left.low, &right.x) - of(&right.low, &left.x);
            let (root_i, root_k) = (-right.low.clone(), -left.low.clone());
            let terms = [&plain, &root_i, &root_k, &Dyadic::default()];
            of_left * of_right * sign_with_roots(terms, &w_i, &w_k)
        }
    }
}
