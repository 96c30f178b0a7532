//! Collision of a cell.
//!
//! Works on half sums of pairs of opposite directions, which are even, and half differences, which are odd.
//! Populations are without their weights, `f_i - w_i`.

use crate::collision::{Parameters, Parts};
use crate::lattice::Lattice;
use crate::real::Real;
use granular_core::Dim;
use std::ops::Range;

/// The forces of some cells along each axis; none without a field.
#[inline(always)]
pub(crate) fn field_of<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    field: [&[T]; 3],
    cells: Range<usize>,
) -> [&[T]; 3] {
    std::array::from_fn(|axis| if P::FIELD && axis < L::Dim::N { &field[axis][cells.clone()] } else { &[] })
}

/// Parameters of a cell that has a force of its own.
#[inline(always)]
pub(crate) fn with_field<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    p: &Parameters<T>,
    field: [&[T]; 3],
    cell: usize,
) -> Parameters<T> {
    let mut here = *p;
    if P::FIELD {
        for axis in 0..L::Dim::N {
            here.force[axis] += p.field_factor * field[axis][cell];
        }
    }
    here
}

/// Squared norm of a stress.
#[inline(always)]
fn squared<L: Lattice<Q>, T: Real, const Q: usize>(stress: [T; 6]) -> T {
    // Off the diagonal, each component stands for two.
    let axes = L::Dim::N;
    let mut mixed = stress[3] * stress[3];
    for i in 4..3 + axes * (axes - 1) / 2 {
        mixed += stress[i] * stress[i];
    }
    let mut squared = mixed + mixed;
    for i in 0..axes {
        squared += stress[i] * stress[i];
    }
    squared
}

/// Rates of stress and of odd moments in a cell. With the closure of Smagorinsky in closed form: the eddy viscosity is
/// `(C h)^2 |S|` with `|S| = sqrt(2 S:S)`, and `S` follows from the stress itself \[Hou1996\].
#[inline(always)]
pub(crate) fn rates<T: Real, P: Parts>(state: State<T>, p: &Parameters<T>) -> [T; 2] {
    if !P::CLOSURE {
        return [p.even, p.odd];
    }
    let strained = p.closure * state.inverse * state.squared.sqrt() + p.tau * p.tau;
    rates_at(p, T::of(0.5) * (p.tau + strained.sqrt()))
}

/// Rates of stress and of odd moments at a relaxation time, with one division.
#[inline(always)]
fn rates_at<T: Real>(p: &Parameters<T>, tau: T) -> [T; 2] {
    let [constant, linear, magic] = p.odd_time;
    let excess = tau - T::of(0.5);
    // The odd relaxation time is this over the excess.
    let odd_time = (constant + linear * tau) * excess + magic;
    let inverse = T::of(1.0) / (tau * odd_time);
    [odd_time * inverse, excess * tau * inverse]
}

/// What a cell needs before it can collide. Kept apart, since everything waits for it: see [`crate::kernel`].
#[derive(Clone, Copy)]
pub(crate) struct State<T> {
    /// Density less that at rest.
    pub(crate) excess: T,
    /// One over the density.
    pub(crate) inverse: T,
    /// Squared norm of the stress, with a closure only.
    pub(crate) squared: T,
}

/// Sums over pairs of opposite directions, and at rest.
#[inline(always)]
fn even_of<T: Real, const Q: usize>(f: &[T; Q]) -> [T; Q] {
    let mut even = *f;
    for i in (1..Q).step_by(2) {
        even[i] = f[i] + f[i + 1];
    }
    even
}

/// Differences over pairs.
#[inline(always)]
fn odd_of<T: Real, const Q: usize>(f: &[T; Q]) -> [T; Q] {
    let mut odd = [T::of(0.0); Q];
    for i in (1..Q).step_by(2) {
        odd[i] = f[i] - f[i + 1];
    }
    odd
}

/// Momentum `j` and what the force makes of it.
///
/// The flux of momentum is `(j + F / 2) (j + F / 2) / density`; the departure from it, together with half of
/// what the force adds to it, is that from `(j - F / 2) (j + F / 2) / density`.
struct Motion<T> {
    momentum: [T; 3],
    /// `j - F / 2`.
    lagging: [T; 3],
    /// `(j + F / 2) / density`.
    velocity: [T; 3],
}

impl<T: Real> Motion<T> {
    #[inline(always)]
    fn of<L: Lattice<Q>, P: Parts, const Q: usize>(odd: &[T; Q], p: &Parameters<T>, inverse: T) -> Self {
        let momentum = L::first_moment(odd);
        let (mut lagging, mut leading) = (momentum, momentum);
        if P::FORCE {
            for axis in 0..3 {
                let push = T::of(0.5) * p.force[axis];
                lagging[axis] = lagging[axis] - push;
                leading[axis] += push;
            }
        }
        Self { momentum, lagging, velocity: leading.map(|component| component * inverse) }
    }

    /// Flux of momentum, lagging by the force: xx, yy, zz, xy, xz, yz.
    #[inline(always)]
    fn flux<P: Parts>(&self) -> [T; 6] {
        let (a, b) = (self.lagging, self.velocity);
        let mixed = |i: usize, k: usize| {
            if P::FORCE { T::of(0.5) * (a[i] * b[k] + a[k] * b[i]) } else { a[i] * b[k] }
        };
        [a[0] * b[0], a[1] * b[1], a[2] * b[2], mixed(0, 1), mixed(0, 2), mixed(1, 2)]
    }
}

/// State of a cell from its populations.
#[inline(always)]
pub(crate) fn state<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    f: &[T; Q],
    p: &Parameters<T>,
) -> State<T> {
    let even = even_of(f);
    // Two sums side by side: everything waits for the density.
    let mut sums = [f[0], even[1]];
    for i in (3..Q).step_by(2) {
        sums[i / 2 % 2] += even[i];
    }
    let excess = sums[0] + sums[1];
    let inverse = T::of(1.0) / (T::of(1.0) + excess);
    let mut state = State { excess, inverse, squared: T::of(0.0) };
    if P::CLOSURE {
        let motion = Motion::of::<L, P, Q>(&odd_of(f), p, inverse);
        let mut stress = less(L::second_moment(&even), motion.flux::<P>());
        for normal in stress.iter_mut().take(L::Dim::N) {
            *normal = *normal - T::of(1.0 / 3.0) * excess;
        }
        state.squared = squared::<L, T, Q>(stress);
    }
    state
}

/// Populations after collision.
#[inline(always)]
pub(crate) fn collide<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    f: &[T; Q],
    state: State<T>,
    [even_rate, odd_rate]: [T; 2],
    p: &Parameters<T>,
) -> [T; Q] {
    let half = T::of(0.5);
    let (even, odd) = (even_of(f), odd_of(f));
    let motion = Motion::of::<L, P, Q>(&odd, p, state.inverse);
    let mut relaxed = if P::GHOSTS {
        relaxed_moments::<L, T, P, Q>(&even, &motion, state.excess, even_rate, p)
    } else {
        relaxed_together::<L, T, Q>(&even, &motion, state.excess, even_rate)
    };
    if P::FORCE {
        let (along, force) = (L::along(motion.velocity), L::along(p.force));
        let work = dot::<L, T, Q>(motion.velocity, p.force);
        relaxed[0] = relaxed[0] - weight::<L, T, Q>(0, 3.0) * work;
        for i in (1..Q).step_by(2) {
            relaxed[i] += weight::<L, T, Q>(i, 3.0) * (T::of(3.0) * along[i] * force[i] - work);
        }
    }
    let keeps = half - half * odd_rate;
    // Of the least weight; others are multiples of it.
    let flow = L::along(motion.momentum.map(|component| T::of(3.0 / 36.0) * odd_rate * component));
    let mut after = *f;
    after[0] = relaxed[0];
    for i in (1..Q).step_by(2) {
        let mut against = keeps * odd[i] + weight::<L, T, Q>(i, 36.0) * flow[i];
        if P::FORCE {
            against += weight::<L, T, Q>(i, 3.0) * L::along(p.force)[i];
        }
        after[i] = relaxed[i] + against;
        after[i + 1] = relaxed[i] - against;
    }
    after
}

#[inline(always)]
fn weight<L: Lattice<Q>, T: Real, const Q: usize>(i: usize, factor: f64) -> T {
    T::of(factor * L::WEIGHTS[i])
}

/// Half sums of pairs, and the population at rest, after all that is even has relaxed at one rate.
#[inline(always)]
fn relaxed_together<L: Lattice<Q>, T: Real, const Q: usize>(
    even: &[T; Q],
    motion: &Motion<T>,
    excess: T,
    rate: T,
) -> [T; Q] {
    let half_rate = T::of(0.5) * rate;
    let keeps = T::of(0.5) - half_rate;
    // Pressure less dynamic pressure, the same in all directions.
    let common = excess - T::of(1.5) * dot::<L, T, Q>(motion.velocity, motion.lagging);
    let (along, flow) = (L::along(motion.velocity), L::along(motion.lagging.map(|c| half_rate * c)));
    let pressure = half_rate * common;
    let mut relaxed = *even;
    relaxed[0] = even[0] - rate * (even[0] - weight::<L, T, Q>(0, 1.0) * common);
    for i in (1..Q).step_by(2) {
        let dynamic = weight::<L, T, Q>(i, 9.0) * (flow[i] * along[i]);
        relaxed[i] = keeps * even[i] + (dynamic + weight::<L, T, Q>(i, 2.0) * pressure);
    }
    relaxed
}

/// The same with a rate for the deviator of stress and others for the ghosts.
#[inline(always)]
fn relaxed_moments<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    even: &[T; Q],
    motion: &Motion<T>,
    excess: T,
    rate: T,
    p: &Parameters<T>,
) -> [T; Q] {
    let flux = motion.flux::<P>();
    let stress = less(L::second_moment(even), flux).map(|component| rate * component);
    let mut ghosts = less(L::ghost_moments(even), L::ghosts_in_equilibrium(excess, flux));
    for (ghost, rate) in ghosts.iter_mut().zip(p.ghosts) {
        *ghost = rate * *ghost;
    }
    let lost = L::even_parts(ghosts, stress);
    let mut relaxed = *even;
    relaxed[0] = even[0] - lost[0];
    for i in (1..Q).step_by(2) {
        relaxed[i] = T::of(0.5) * even[i] - lost[i];
    }
    relaxed
}

#[inline(always)]
fn less<T: Real, const N: usize>(a: [T; N], b: [T; N]) -> [T; N] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Inner product over the axes of a lattice.
#[inline(always)]
fn dot<L: Lattice<Q>, T: Real, const Q: usize>(a: [T; 3], b: [T; 3]) -> T {
    let mut sum = a[0] * b[0];
    for axis in 1..L::Dim::N {
        sum += a[axis] * b[axis];
    }
    sum
}
