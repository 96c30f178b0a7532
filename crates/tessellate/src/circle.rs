//! The circle that touches three disks from outside: where and when an arc of the beach line vanishes.
//!
//! Seen from the middle disk, with $u$ the height of the sweep line above its lowest point and
//! $\xi = x / u$, the centre of the circle solves, for the neighbours $i$ (left) and $k$ (right),
//!
//! $$ (1 - low\,/u)\, W = (low\, \xi - x)^2, \qquad W = x^2 + low\; high. $$
//!
//! Of the two solutions the arc vanishes at the one with $low_i \xi \ge x_i$ and $low_k \xi \le x_k$, which
//! fixes the sign of the root: $\xi = (F - \sqrt{\Gamma}) / P$ and $u = (B + 2 \delta \sqrt{\Gamma}) / A$ with the
//! polynomials of [`Polynomials`].

use crate::bounded::{Bounded, Ring};
use crate::dyadic::{Dyadic, sign_with_root, sign_with_roots};
use crate::predicates::separation;
use crate::site::{Seen, Site, exact_difference, order};
use granular_core::glam::DVec2;
use std::cmp::Ordering;

/// Polynomials in the differences of coordinates.
struct Polynomials<R> {
    /// $P = W_i\, low_k - W_k\, low_i$.
    p: R,
    /// $F = x_k W_i - x_i W_k$.
    f: R,
    /// $T = high_k W_i - high_i W_k$.
    t: R,
    /// $\delta = x_i\, low_k - x_k\, low_i$.
    delta: R,
    /// $\Gamma = F^2 + P T$.
    gamma: R,
    /// $A = Q^2 + 4 \delta G$ with $Q = high_i\, low_k - high_k\, low_i$, $G = x_k\, high_i - x_i\, high_k$.
    a: R,
    /// $B = P Q + 2 \delta F$.
    b: R,
    /// $G$.
    g: R,
}

impl<R: Ring> Polynomials<R> {
    #[inline(always)]
    fn new(i: &Seen<R>, k: &Seen<R>) -> Self {
        let [w_i, w_k] = [i, k].map(separation);
        let minor = |a: &R, b: &R, c: &R, d: &R| a.clone() * b.clone() - c.clone() * d.clone();
        let p = minor(&w_i, &k.low, &w_k, &i.low);
        let f = minor(&k.x, &w_i, &i.x, &w_k);
        let t = minor(&k.high, &w_i, &i.high, &w_k);
        let delta = minor(&i.x, &k.low, &k.x, &i.low);
        let q = minor(&i.high, &k.low, &k.high, &i.low);
        let g = minor(&k.x, &i.high, &i.x, &k.high);
        let gamma = f.clone() * f.clone() + p.clone() * t.clone();
        let a = q.clone() * q.clone() + R::whole(4) * delta.clone() * g.clone();
        let b = p.clone() * q + R::whole(2) * delta.clone() * f.clone();
        Self { p, f, t, delta, gamma, a, b, g }
    }
}

/// Where and when an arc vanishes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    /// Bounds on the height of the sweep line.
    pub(crate) between: [f64; 2],
    /// Seen from the middle site.
    u: f64,
    xi: f64,
}

/// Relative error from which on a centre is computed anew from exact numbers.
const POOR: f64 = 1e-11;

impl Circle {
    /// The circle of three sites of which the middle one is known to vanish.
    pub(crate) fn new([left, middle, right]: [&Site; 3]) -> Self {
        let (i, k) = (Seen::of(left, middle), Seen::of(right, middle));
        let (mut u, mut xi) = bounded(&i, &k);
        let good =
            u.value.is_finite() && u.error <= POOR * u.value && xi.error <= POOR * xi.value.abs().max(1.0);
        if !good {
            let (exact_u, exact_xi) = refined(left, middle, right);
            u = Bounded { value: exact_u, error: 64.0 * f64::EPSILON * exact_u };
            xi = Bounded::exact(exact_xi);
        }
        let key = middle.low[0] + (u.value + middle.low[1]);
        let rounding = 2.0 * f64::EPSILON * (key.abs() + u.value + middle.low[1].abs());
        let error = u.error + rounding + f64::MIN_POSITIVE;
        Self { between: [key - error, key + error], u: u.value, xi: xi.value }
    }

    /// Centre, and its distance to the sites minus their radius.
    pub(crate) fn centre(&self, middle: &Site) -> (DVec2, f64) {
        let (half, square) = (0.5 * self.u, self.xi * self.xi);
        let centre = DVec2::new(middle.x + self.u * self.xi, middle.y + half * (1.0 - square));
        (centre, half * (1.0 + square) - middle.radius)
    }
}

/// Height of the sweep line above the lowest point of the middle disk, and `x` over that height.
#[inline(always)]
fn bounded(i: &Seen<Bounded>, k: &Seen<Bounded>) -> (Bounded, Bounded) {
    let Polynomials { p, f, t, delta, gamma, a, b, g } = Polynomials::new(i, k);
    let level = [i, k].iter().all(|seen| seen.low.value == 0.0 && seen.low.error == 0.0);
    if level {
        return (f.over(g), -(t.over(Bounded::whole(2) * f)));
    }
    let root = gamma.root();
    let part = Bounded::whole(2) * delta * root;
    let u = if b.value * delta.value >= 0.0 { (b + part).over(a) } else { (p * p).over(b - part) };
    let xi = if f.value <= 0.0 { (f - root).over(p) } else { -(t.over(f + root)) };
    (u, xi)
}

/// The same from exact polynomials, each rounded once: good to about ten roundings.
fn refined(left: &Site, middle: &Site, right: &Site) -> (f64, f64) {
    let (i, k) = (Seen::exactly(left, middle), Seen::exactly(right, middle));
    let level = i.low.sign() == 0 && k.low.sign() == 0;
    // Lengths are measured in a power of two near the largest difference.
    let sizes = [&i.x, &i.low, &i.high, &k.x, &k.low, &k.high].into_iter();
    let unit = sizes.filter(|number| number.sign() != 0).map(|number| number.scaled().1).max().unwrap_or(0);
    let exact = Polynomials::new(&i, &k);
    let in_units = |number: &Dyadic, degree: i64| {
        let (value, exponent) = number.scaled();
        let rounded = value * power_of_two(exponent - degree * unit);
        // Without all its digits it is no number: order is then taken from the exact ones.
        if value == 0.0 || rounded.is_normal() { rounded } else { f64::NAN }
    };
    let [p, f, t] = [&exact.p, &exact.f, &exact.t].map(|number| in_units(number, 3));
    let (u, xi) = if level {
        (f / in_units(&exact.g, 2), -t / (2.0 * f))
    } else {
        let (a, b) = (in_units(&exact.a, 4), in_units(&exact.b, 5));
        let delta = in_units(&exact.delta, 2);
        let root = in_units(&exact.gamma, 6).max(0.0).sqrt();
        let part = 2.0 * delta * root;
        let u = if b * delta >= 0.0 { (b + part) / a } else { p * p / (b - part) };
        (u, if f <= 0.0 { (f - root) / p } else { -t / (f + root) })
    };
    (u * power_of_two(unit), xi)
}

fn power_of_two(exponent: i64) -> f64 {
    2f64.powi(exponent.clamp(-1074, 1024) as i32)
}

/// The height of the sweep line at which an arc vanishes, above the lowest point of the middle disk:
/// `(p + q sqrt(g)) / d`, `d > 0`.
struct Height {
    p: Dyadic,
    q: Dyadic,
    g: Dyadic,
    d: Dyadic,
}

impl Height {
    fn new([left, middle, right]: [&Site; 3]) -> Self {
        let (i, k) = (Seen::exactly(left, middle), Seen::exactly(right, middle));
        let level = i.low.sign() == 0 && k.low.sign() == 0;
        let Polynomials { p, f, delta, gamma, a, b, g, .. } = Polynomials::new(&i, &k);
        let two = || Dyadic::whole(2);
        let (p, q, d) = if level {
            (f, Dyadic::default(), g)
        } else if a.sign() == 0 {
            (p.clone() * p, Dyadic::default(), two() * b)
        } else {
            (b, two() * delta, a)
        };
        if d.sign() < 0 { Self { p: -p, q: -q, g: gamma, d: -d } } else { Self { p, q, g: gamma, d } }
    }
}

/// Which of two circles the sweep line leaves first.
pub(crate) fn order_of_circles(first: [&Site; 3], second: [&Site; 3]) -> Ordering {
    // Rows of a lattice: the same circle elsewhere.
    if order(first[1].low, second[1].low) == Ordering::Equal && congruent(first, second) {
        return Ordering::Equal;
    }
    let base = exact_difference(first[1].low, second[1].low);
    let (a, b) = (Height::new(first), Height::new(second));
    let plain = base * a.d.clone() * b.d.clone() + a.p * b.d.clone() - b.p * a.d.clone();
    let terms = [&plain, &(a.q * b.d), &-(b.q * a.d), &Dyadic::default()];
    sign_with_roots(terms, &a.g, &b.g).cmp(&0)
}

/// Whether two triples of sites are certain to differ by a translation only.
fn congruent(first: [&Site; 3], second: [&Site; 3]) -> bool {
    [0, 2].into_iter().all(|k| first[k].step_from(first[1]) == second[k].step_from(second[1]))
}

/// Whether the sweep line leaves a circle before it meets a site, at the site, or after it.
pub(crate) fn order_of_circle_and_site(circle: [&Site; 3], site: &Site) -> Ordering {
    let Height { p, q, g, d } = Height::new(circle);
    let plain = p - d * exact_difference(site.low, circle[1].low);
    sign_with_root(&plain, &q, &g).cmp(&0)
}
