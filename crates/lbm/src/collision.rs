//! Collision operators: one kernel, relaxed by parts.
//!
//! A collision splits populations by pair of opposite directions into even and odd parts and relaxes
//! their departure from equilibrium. With rates `w+` (even, viscosity) and `w-` (odd) alone that is
//! the two-relaxation-time operator; energy and its square are even moments with rates of their own in
//! the multiple-relaxation-time operator, since all odd moments share `w-` there
//! \[Ginzburg2008; Lallemand2000; DHumieres2002\]. A force enters as in \[Guo2002\], relaxed by the
//! same rates.

use crate::lattice::Lattice;
use crate::real::Real;
use granular_core::Dim;

/// How the departure from equilibrium is relaxed. `tau` is the relaxation time in steps, from the
/// viscosity; `Lambda = (tau - 1/2) (tau_odd - 1/2)`.
///
/// With half-way walls the fluid slips by `u_slip / u_max = (16 Lambda - 3) / (3 H^2)` in a channel
/// of `H` cells; at `Lambda = 3/16` a wall stands exactly half-way \[Ginzburg2008\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operator {
    /// One relaxation time; walls move with viscosity, `Lambda = (tau - 1/2)^2` \[Qian1992\].
    SingleRelaxation,
    /// Two relaxation times.
    TwoRelaxation {
        /// `Lambda`: 3/16 for exact walls, 1/4 for most stability.
        magic: f64,
    },
    /// Multiple relaxation times.
    MultipleRelaxation {
        /// Rates of the even moments that carry no deviator of stress: energy (bulk viscosity), the
        /// square of energy, and in space the two of order four together.
        ghosts: [f64; 3],
        /// Rate of the odd moments.
        odd: OddRate,
    },
    /// Regularised: all that is neither mass, momentum nor stress goes to equilibrium at once
    /// \[LattChopard2006\].
    Regularised,
}

/// Relaxation of odd moments other than momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OddRate {
    /// From `Lambda`.
    Magic(f64),
    /// The rate itself, between 0 and 2.
    Rate(f64),
}

impl Operator {
    /// Multiple relaxation times with exact half-way walls at any viscosity.
    pub const EXACT_WALLS: Self =
        Self::MultipleRelaxation { ghosts: [1.5, 1.4, 1.4], odd: OddRate::Magic(3.0 / 16.0) };

    /// Rates of the later code by the author of \[Kumar2014\]: walls move with viscosity.
    pub const KUMAR: Self = Self::MultipleRelaxation { ghosts: [1.5, 1.4, 1.4], odd: OddRate::Rate(1.5) };

    /// `Lambda` at relaxation time `tau`.
    pub fn magic(&self, tau: f64) -> f64 {
        (tau - 0.5) * (self.odd_time(tau) - 0.5)
    }

    /// Relaxation time of odd moments.
    fn odd_time(&self, tau: f64) -> f64 {
        let [constant, linear, magic] = self.odd_time_terms();
        constant + linear * tau + magic / (tau - 0.5)
    }

    /// Relaxation time of odd moments as `a + b tau + c / (tau - 1/2)`.
    fn odd_time_terms(&self) -> [f64; 3] {
        match *self {
            Self::SingleRelaxation => [0.0, 1.0, 0.0],
            Self::TwoRelaxation { magic } | Self::MultipleRelaxation { odd: OddRate::Magic(magic), .. } => {
                [0.5, 0.0, magic]
            }
            Self::MultipleRelaxation { odd: OddRate::Rate(rate), .. } => [1.0 / rate, 0.0, 0.0],
            Self::Regularised => [1.0, 0.0, 0.0],
        }
    }

    /// Rates of the ghost moments, if they differ from that of stress.
    fn ghosts(&self) -> Option<[f64; 3]> {
        match *self {
            Self::SingleRelaxation | Self::TwoRelaxation { .. } => None,
            Self::MultipleRelaxation { ghosts, .. } => Some(ghosts),
            Self::Regularised => Some([1.0; 3]),
        }
    }
}

/// Numbers of a collision, in lattice units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameters<T> {
    /// Rates of stress and of odd moments, without a closure.
    even: T,
    odd: T,
    /// Rates of ghosts: the third serves the fourth too.
    ghosts: [T; 4],
    /// One over the squared length of each ghost.
    ghost_scales: [T; 4],
    /// Force density.
    force: [T; 3],
    tau: T,
    odd_time: [T; 3],
    /// 18 sqrt(2) C^2 of the closure.
    closure: T,
}

/// What a kernel leaves out.
pub(crate) trait Parts: Copy + Send + Sync + 'static {
    const GHOSTS: bool;
    const FORCE: bool;
    const CLOSURE: bool;
}

/// Parts that are on.
#[derive(Clone, Copy)]
pub(crate) struct With<const GHOSTS: bool, const FORCE: bool, const CLOSURE: bool>;

impl<const G: bool, const F: bool, const C: bool> Parts for With<G, F, C> {
    const GHOSTS: bool = G;
    const FORCE: bool = F;
    const CLOSURE: bool = C;
}

/// What a collision needs, by name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Physics {
    pub(crate) operator: Operator,
    pub(crate) tau: f64,
    /// Force density in lattice units.
    pub(crate) force: [f64; 3],
    /// Smagorinsky constant; zero for none.
    pub(crate) smagorinsky: f64,
}

impl Physics {
    pub(crate) fn has_ghosts(&self) -> bool {
        self.operator.ghosts().is_some()
    }

    pub(crate) fn has_force(&self) -> bool {
        self.force != [0.0; 3]
    }

    pub(crate) fn has_closure(&self) -> bool {
        self.smagorinsky > 0.0
    }

    pub(crate) fn parameters<L: Lattice<Q>, T: Real, const Q: usize>(&self) -> Parameters<T> {
        let mut ghost_scales = [T::of(0.0); 4];
        for (scale, ghost) in ghost_scales.iter_mut().zip(L::GHOSTS) {
            *scale = T::of(1.0 / ghost.iter().map(|value| value * value).sum::<f64>());
        }
        let [first, second, third] = self.operator.ghosts().unwrap_or_default().map(T::of);
        Parameters {
            even: T::of(1.0 / self.tau),
            odd: T::of(1.0 / self.operator.odd_time(self.tau)),
            ghosts: [first, second, third, third],
            ghost_scales,
            force: self.force.map(T::of),
            tau: T::of(self.tau),
            odd_time: self.operator.odd_time_terms().map(T::of),
            closure: T::of(18.0 * std::f64::consts::SQRT_2 * self.smagorinsky.powi(2)),
        }
    }
}

/// Relaxation time with the closure of Smagorinsky, in closed form: the eddy viscosity is
/// `(C h)^2 |S|` with `|S| = sqrt(2 S:S)`, and `S` follows from the stress itself \[Hou1996\].
#[inline(always)]
fn closed_tau<L: Lattice<Q>, T: Real, const Q: usize>(
    p: &Parameters<T>,
    stress: [T; 6],
    inverse_density: T,
) -> T {
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
    let strained = p.closure * inverse_density * squared.sqrt() + p.tau * p.tau;
    T::of(0.5) * (p.tau + strained.sqrt())
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

/// Populations after collision. Populations are without their weights, `f_i - w_i`.
///
/// Works on pairs of opposite directions: `even` is their sum and `odd` their difference, here as departures from equilibrium
/// plus half of the force.
#[inline(always)]
pub(crate) fn collide<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    f: [T; Q],
    p: &Parameters<T>,
) -> [T; Q] {
    let (half, zero) = (T::of(0.5), T::of(0.0));
    let weight = |i: usize, factor: f64| T::of(factor * L::WEIGHTS[i]);
    let (mut even, mut odd) = ([zero; Q], [zero; Q]);
    // Two sums side by side: everything waits for the density.
    let mut sums = [f[0], zero];
    for i in (1..Q).step_by(2) {
        even[i] = f[i] + f[i + 1];
        odd[i] = f[i] - f[i + 1];
        sums[i / 2 % 2] = if i == 3 { even[i] } else { sums[i / 2 % 2] + even[i] };
    }
    let excess = sums[0] + sums[1];
    let density = T::of(1.0) + excess;
    let inverse = T::of(1.0) / density;
    let mut momentum = L::first_moment(&odd);
    if P::FORCE {
        for axis in 0..3 {
            momentum[axis] += half * p.force[axis];
        }
    }
    let velocity = momentum.map(|component| component * inverse);
    let along = L::along(velocity);
    // Pressure less dynamic pressure, the same in all directions.
    let common = excess - T::of(1.5) * dot::<L, T, Q>(velocity, momentum);
    even[0] = f[0] - weight(0, 1.0) * common;
    for i in (1..Q).step_by(2) {
        let flow = density * along[i];
        let pressure = weight(i, 9.0) * flow * along[i] + weight(i, 2.0) * common;
        even[i] = even[i] - pressure;
        odd[i] = odd[i] - weight(i, 6.0) * flow;
    }
    // Half of what the force adds.
    let (mut gained, mut pushed) = ([zero; Q], [zero; Q]);
    if P::FORCE {
        let (work, force) = (dot::<L, T, Q>(velocity, p.force), L::along(p.force));
        gained[0] = -(weight(0, 1.5) * work);
        even[0] += gained[0];
        for i in (1..Q).step_by(2) {
            gained[i] = weight(i, 3.0) * (T::of(3.0) * along[i] * force[i] - work);
            pushed[i] = weight(i, 3.0) * force[i];
            even[i] += gained[i];
            odd[i] += pushed[i];
        }
    }
    let [even_rate, odd_rate] = if P::CLOSURE {
        rates_at(p, closed_tau::<L, T, Q>(p, L::second_moment(&even), inverse))
    } else {
        [p.even, p.odd]
    };
    // What the ghosts relax less than stress.
    let kept = if P::GHOSTS {
        let mut moments = L::ghost_moments(&even);
        for (moment, (rate, scale)) in moments.iter_mut().zip(p.ghosts.iter().zip(p.ghost_scales)) {
            *moment = (even_rate - *rate) * scale * *moment;
        }
        L::ghost_parts(moments)
    } else {
        [zero; Q]
    };
    let (half_even, half_odd) = (half * even_rate, half * odd_rate);
    let mut after = f;
    after[0] = f[0] - even_rate * even[0];
    if P::GHOSTS {
        after[0] += kept[0];
    }
    if P::FORCE {
        after[0] += T::of(2.0) * gained[0];
    }
    for i in (1..Q).step_by(2) {
        let against = if P::FORCE { half_odd * odd[i] - pushed[i] } else { half_odd * odd[i] };
        let spared = match (P::GHOSTS, P::FORCE) {
            (true, true) => kept[i] + gained[i],
            (true, false) => kept[i],
            (false, true) => gained[i],
            (false, false) => zero,
        };
        let both = if P::GHOSTS || P::FORCE { half_even * even[i] - spared } else { half_even * even[i] };
        after[i] = f[i] - (both + against);
        after[i + 1] = f[i + 1] - (both - against);
    }
    after
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
