//! A site in the coordinates of the sweep.

use crate::bounded::Bounded;
use crate::dyadic::Dyadic;
use granular_core::glam::DVec2;
use std::cmp::Ordering;

/// The sum of two floating-point numbers, exactly: the rounded sum and what rounding lost.
type Exact = [f64; 2];

/// A disk. The sweep line moves up; it meets the disk at its lowest point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) radius: f64,
    /// `y - radius`: lowest point.
    pub(crate) low: Exact,
    /// `y + radius`: highest point.
    pub(crate) high: Exact,
}

/// Rounded sum and rounding error \[Shewchuk1997, theorem 7\].
fn two_sum(a: f64, b: f64) -> Exact {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    [sum, (a - of_a) + (b - of_b)]
}

/// Order of two exact sums. The rounded sums are in the order of the true ones, or equal.
pub(crate) fn order(a: Exact, b: Exact) -> Ordering {
    // Zero of either sign is the same.
    let compare = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
    compare(a[0], b[0]).then_with(|| compare(a[1], b[1]))
}

#[inline(always)]
pub(crate) fn difference(a: Exact, b: Exact) -> Bounded {
    let [high, low] = [0, 1].map(|k| Bounded::exact(a[k]) - Bounded::exact(b[k]));
    high + low
}

pub(crate) fn exact_difference(a: Exact, b: Exact) -> Dyadic {
    let [high, low] = [0, 1].map(|k| Dyadic::of(a[k]) - Dyadic::of(b[k]));
    high + low
}

impl Site {
    pub(crate) fn new(position: DVec2, radius: f64) -> Self {
        Self {
            x: position.x,
            y: position.y,
            radius,
            low: two_sum(position.y, -radius),
            high: two_sum(position.y, radius),
        }
    }

    /// Order in which the sweep meets the disks. Of disks with a common lowest point the largest
    /// comes first: it hides the others.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let compare = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
        order(self.low, other.low)
            .then_with(|| compare(self.x, other.x))
            .then_with(|| compare(other.radius, self.radius))
    }

    /// Differences of all coordinates to another site, exactly, as sums of two numbers.
    pub(crate) fn step_from(&self, other: &Self) -> [Exact; 5] {
        let [low, high] = [(self.low, other.low), (self.high, other.high)]
            .map(|(a, b)| [two_sum(a[0], -b[0]), two_sum(a[1], -b[1])]);
        [two_sum(self.x, -other.x), low[0], low[1], high[0], high[1]]
    }

    /// Whether both disks have the same lowest point.
    pub(crate) fn same_lowest_point(&self, other: &Self) -> bool {
        self.x == other.x && order(self.low, other.low) == Ordering::Equal
    }
}

/// A site seen from another one: differences of `x`, `low` and `high`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<R> {
    pub(crate) x: R,
    pub(crate) low: R,
    pub(crate) high: R,
}

impl Seen<Bounded> {
    #[inline(always)]
    pub(crate) fn of(site: &Site, from: &Site) -> Self {
        Self {
            x: Bounded::exact(site.x) - Bounded::exact(from.x),
            low: difference(site.low, from.low),
            high: difference(site.high, from.high),
        }
    }
}

impl Seen<Dyadic> {
    pub(crate) fn exactly(site: &Site, from: &Site) -> Self {
        Self {
            x: Dyadic::of(site.x) - Dyadic::of(from.x),
            low: exact_difference(site.low, from.low),
            high: exact_difference(site.high, from.high),
        }
    }
}
