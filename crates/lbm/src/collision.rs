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

/// How the departure from equilibrium is relaxed. `tau` is the relaxation time in steps, from the
/// viscosity; `Lambda = (tau - 1/2) (tau_odd - 1/2)`.
///
/// With half-way walls the fluid slips by `u_slip / u_max = (16 Lambda - 3) / (3 H^2)` in a channel
/// of `H` cells; at `Lambda = 3/16` a flat wall along the lattice stands exactly half-way \[Ginzburg2008\]. No operator is exact
/// at walls that are inclined or round. There two relaxation times keep, with half-way walls and at any viscosity, one
/// and the same error in creeping flow; with rates of their own for ghosts it changes with viscosity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operator {
    /// One relaxation time; walls move with viscosity, `Lambda = (tau - 1/2)^2` \[Qian1992\].
    SingleRelaxation,
    /// Two relaxation times.
    TwoRelaxation {
        /// `Lambda`: 3/16 for exact flat walls.
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

impl Default for Operator {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Operator {
    /// Two relaxation times with `Lambda` 3/16: flat walls along the lattice lie exactly half-way at any viscosity. It bears less viscosity
    /// than [`Operator::EXACT_WALLS`] in shear layers, moving frames and jets, but needs more in a cavity (docs/lbm-studies.md).
    pub const DEFAULT: Self = Self::TwoRelaxation { magic: 3.0 / 16.0 };

    /// Multiple relaxation times with flat walls exactly half-way at any viscosity: they damp sound more than
    /// [`Operator::DEFAULT`], and blow up in shear layers and moving frames that all others bear.
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
    pub(crate) even: T,
    pub(crate) odd: T,
    /// Rates of ghosts over their squared lengths: the rate of the third serves the fourth too.
    pub(crate) ghosts: [T; 4],
    /// Force density that is the same everywhere.
    pub(crate) force: [T; 3],
    /// Factor of the force density of each cell.
    pub(crate) field_factor: T,
    pub(crate) tau: T,
    pub(crate) odd_time: [T; 3],
    /// 18 sqrt(2) C^2 of the closure.
    pub(crate) closure: T,
}

/// What a kernel leaves out.
pub(crate) trait Parts: Copy + Send + Sync + 'static {
    const GHOSTS: bool;
    const FORCE: bool;
    const CLOSURE: bool;
    /// A force of each cell; needs `FORCE`.
    const FIELD: bool;
}

/// Parts that are on.
#[derive(Clone, Copy)]
pub(crate) struct With<const GHOSTS: bool, const FORCE: bool, const CLOSURE: bool, const FIELD: bool>;

impl<const G: bool, const F: bool, const C: bool, const V: bool> Parts for With<G, F, C, V> {
    const GHOSTS: bool = G;
    const FORCE: bool = F;
    const CLOSURE: bool = C;
    const FIELD: bool = V;
}

/// What a collision needs, by name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Physics {
    pub(crate) operator: Operator,
    pub(crate) tau: f64,
    /// Force density that is the same everywhere, in lattice units.
    pub(crate) force: [f64; 3],
    /// Whether the force varies, and whether it does in space: then there is a field of it.
    pub(crate) varies: [bool; 2],
    /// Factor of the field.
    pub(crate) field_factor: f64,
    /// Smagorinsky constant; zero for none.
    pub(crate) smagorinsky: f64,
}

impl Physics {
    pub(crate) fn has_ghosts(&self) -> bool {
        self.operator.ghosts().is_some()
    }

    pub(crate) fn has_force(&self) -> bool {
        self.force != [0.0; 3] || self.varies[0]
    }

    pub(crate) fn has_field(&self) -> bool {
        self.varies[1]
    }

    pub(crate) fn has_closure(&self) -> bool {
        self.smagorinsky > 0.0
    }

    pub(crate) fn parameters<L: Lattice<Q>, T: Real, const Q: usize>(&self) -> Parameters<T> {
        let [first, second, third] = self.operator.ghosts().unwrap_or_default();
        let mut ghosts = [T::of(0.0); 4];
        for ((scaled, rate), ghost) in ghosts.iter_mut().zip([first, second, third, third]).zip(L::GHOSTS) {
            *scaled = T::of(rate / ghost.iter().map(|value| value * value).sum::<f64>());
        }
        Parameters {
            even: T::of(1.0 / self.tau),
            odd: T::of(1.0 / self.operator.odd_time(self.tau)),
            ghosts,
            force: self.force.map(T::of),
            field_factor: T::of(self.field_factor),
            tau: T::of(self.tau),
            odd_time: self.operator.odd_time_terms().map(T::of),
            closure: T::of(18.0 * std::f64::consts::SQRT_2 * self.smagorinsky.powi(2)),
        }
    }
}
