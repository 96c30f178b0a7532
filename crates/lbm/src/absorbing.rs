//! Open faces through which sound leaves.
//!
//! A given pressure throws sound back with the opposite sign, so it holds a level but absorbs nothing, whatever
//! \[Kumar2014, section 6.3.1\] says. Here the face gives what travels *inwards* instead \[PoinsotLele1992;
//! IzquierdoFueyo2008\]. With `w` the velocity inwards, along the way of sound
//!
//! ```text
//! I = w + c_s ln(rho),  dI/dt + (c_s + w) dI/dn = a - v . grad I - c_s div v
//! ```
//!
//! with `v`, `grad` and `div` along the face and `a` the acceleration by the body force and by friction along the face. So
//! `I` at the face is that of the cell within, less what the right side adds on the way; the terms along the face are
//! those that \[YooIm2007\] found to matter, and taken by half. A small share is taken from the state at the pressure to which the face
//! settles. What travels outwards follows from the populations that arrive from within.
//!
//! Since that share is small, what the estimate of the right side misses moves the level of pressure many times: by
//! `1 / (2 share)` of the error per cell, and populations at open faces have errors of up to a tenth of the gradient of
//! pressure there. So each face learns what is missed, in the mean over its cells: `dI/dt + (c_s + w) dI/dn` over the right side, as
//! the cell at the face and that within show it. Sound satisfies the equation and teaches nothing; in a steady flow the mean
//! pressure at the face comes to be the one given. These two numbers per face are part of its state.

use crate::lattice::Lattice;
use crate::open::moments;
use crate::populations::Populations;
use crate::real::Real;

/// Density and velocity of a cell.
pub(crate) struct Flowing {
    density: f64,
    pub(crate) velocity: [f64; 3],
    /// Body force over density.
    acceleration: [f64; 3],
}

impl Flowing {
    pub(crate) fn of<L: Lattice<Q>, T: Real, const Q: usize>(
        populations: &Populations<T>,
        place: usize,
        force: [f64; 3],
    ) -> Self {
        let (excess, momentum) = moments::<L, Q>(&populations.entering::<L, Q>(place).map(T::double), force);
        let density = 1.0 + excess;
        Self {
            density,
            velocity: momentum.map(|component| component / density),
            acceleration: force.map(|component| component / density),
        }
    }

    /// What travels inwards.
    pub(crate) fn inwards(&self, normal: Normal) -> f64 {
        normal.inwards(self.density - 1.0, self.velocity)
    }
}

/// What a face knows of the flow so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// What the estimate of the right side misses, mean over the face, per step.
    pub(crate) missed: f64,
    /// What travelled inwards after the last step, mean over the face and the cells within.
    pub(crate) inwards: f64,
}

/// Sums over the cells of a face in one step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    inwards: f64,
    held: f64,
    share: f64,
    count: u32,
}

impl Sums {
    /// Adds a cell: what travels inwards at the face, and what [`Inner::wave`] found.
    pub(crate) fn add(&mut self, at_face: f64, wave: &Wave, share: f64) {
        self.inwards += 0.5 * (at_face + wave.within);
        self.held += wave.held;
        self.share += share;
        self.count += 1;
    }

    /// Means over the cells: what travels inwards, what the pressure given adds to it per step, and its share.
    fn means(&self) -> [f64; 3] {
        [self.inwards, self.held, self.share].map(|sum| sum / f64::from(self.count.max(1)))
    }
}

impl Seen {
    /// Learns from a step, at half the rate at which the level of pressure settles between a face and a wall.
    pub(crate) fn learn(&mut self, sums: &Sums) {
        let [inwards, held, share] = sums.means();
        self.missed += share * sound() * (inwards - self.inwards - held);
        self.inwards = inwards;
    }
}

/// What a face takes from the cell within.
pub(crate) struct Wave {
    /// Density at the face over that at rest, minus one.
    pub(crate) excess: f64,
    /// Velocity of the cell within.
    pub(crate) velocity: [f64; 3],
    /// What travels inwards there.
    pub(crate) within: f64,
    /// What the pressure given adds to what travels inwards per step, and the share of the terms along the face that is
    /// left out.
    pub(crate) held: f64,
}

/// What lies beside a cell, along a face.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Cell(usize),
    /// Half a cell away, with a velocity in lattice units.
    Wall([f64; 3]),
    /// A mirror, half a cell away.
    Mirror,
    /// A cell of another absorbing face, not known yet: as the other side goes on.
    Later,
}

/// The cell within an absorbing face.
#[derive(Clone, Debug)]
pub(crate) struct Inner {
    pub(crate) place: usize,
    /// Taken from the pressure given, per cell that sound travels.
    pub(crate) share: f64,
    /// Lattice units.
    pub(crate) viscosity: f64,
    /// What lies beside it along the face: axis, low and high side.
    pub(crate) sides: Vec<(usize, [Side; 2])>,
}

/// The normal of a face.
#[derive(Clone, Copy)]
pub(crate) struct Normal {
    pub(crate) axis: usize,
    pub(crate) inward: f64,
}

impl Normal {
    /// What travels inwards, from density excess and velocity.
    pub(crate) fn inwards(self, excess: f64, velocity: [f64; 3]) -> f64 {
        self.inward * velocity[self.axis] + sound() * logarithm_of_ratio(1.0 + excess, 1.0)
    }
}

/// Share of the terms along the face: in full, they let a sudden stream settle more slowly; without, a round pulse leaves
/// half as much again.
const ALONG: f64 = 0.5;

/// Speed of sound in lattice units.
fn sound() -> f64 {
    1.0 / 3.0_f64.sqrt()
}

/// The difference of logarithms of two densities, to third order: a logarithm has other bits on other processors.
fn logarithm_of_ratio(density: f64, other: f64) -> f64 {
    2.0 * (density - other) / (density + other)
}

impl Inner {
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>() + self.sides.capacity() * size_of::<(usize, [Side; 2])>()
    }

    /// What is added per step to what travels inwards: by forces, and by the terms along the face in full.
    fn sources(&self, within: &Flowing, normal: Normal, flow_in: impl Fn(usize) -> Flowing) -> [f64; 2] {
        let inwards = |velocity: [f64; 3]| normal.inward * velocity[normal.axis];
        let w = inwards(within.velocity);
        let (mut source, mut along) = (inwards(within.acceleration), 0.0);
        for &(axis, sides) in &self.sides {
            let v = within.velocity[axis];
            // Of each side: velocity inwards, velocity along the face, and what travels inwards over that within.
            let [low, high] = sides.map(|side| match side {
                Side::Cell(place) => {
                    let flow = flow_in(place);
                    let other = inwards(flow.velocity);
                    let ratio = logarithm_of_ratio(flow.density, within.density);
                    [other, flow.velocity[axis], other - w + sound() * ratio]
                }
                Side::Wall(velocity) => [inwards(velocity), -v, 0.0],
                Side::Mirror => [w, -v, 0.0],
                Side::Later => [w, v, 0.0],
            });
            // Exact for a parabola between walls half-way.
            let second = match sides {
                [Side::Later, _] | [_, Side::Later] => 0.0,
                [Side::Wall(_), Side::Wall(_)] => 4.0 * (low[0] + high[0] - 2.0 * w),
                [Side::Wall(_), _] => 4.0 / 3.0 * (2.0 * low[0] + high[0] - 3.0 * w),
                [_, Side::Wall(_)] => 4.0 / 3.0 * (2.0 * high[0] + low[0] - 3.0 * w),
                _ => low[0] + high[0] - 2.0 * w,
            };
            source += self.viscosity * second;
            let width = if sides.iter().any(|side| matches!(side, Side::Later)) { 1.0 } else { 2.0 };
            along -= (v * (high[2] - low[2]) + sound() * (high[1] - low[1])) / width;
        }
        [source, along]
    }

    /// State of the cell at the face, from `known`, density times one less the velocity inwards, the density excess
    /// given and what the estimate of the right side misses.
    pub(crate) fn wave(
        &self,
        known: f64,
        (excess, missed): (f64, f64),
        normal: Normal,
        flow_in: impl Fn(usize) -> Flowing,
    ) -> Wave {
        let within = flow_in(self.place);
        let w = normal.inward * within.velocity[normal.axis];
        let [source, along] = self.sources(&within, normal, flow_in);
        let carried = w - (source + ALONG * along + missed) / (sound() + w);
        // At the pressure given, what travels inwards is what travels outwards, plus twice the sound times the
        // logarithm of density: of that a share is taken.
        let rest = 1.0 - self.share;
        let stiffened = sound() * (1.0 + self.share) / rest;
        let given = logarithm_of_ratio(1.0 + excess, within.density);
        let pull = 2.0 * self.share / rest * sound();
        let wave = carried + pull * given;
        // 1 - known / density + stiffened * logarithm_of_ratio(density, within) = wave: one root is positive.
        let square = 1.0 - wave + 2.0 * stiffened;
        let linear = (1.0 - wave - 2.0 * stiffened) * within.density - known;
        let constant = known * within.density;
        let root = (linear * linear + 4.0 * square * constant).sqrt();
        let density = (root - linear) / (2.0 * square);
        Wave {
            excess: density - 1.0,
            velocity: within.velocity,
            within: within.inwards(normal),
            held: (sound() + w) * pull * (given - logarithm_of_ratio(density, within.density))
                + (1.0 - ALONG) * along,
        }
    }
}
