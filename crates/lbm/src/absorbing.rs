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
//! settles. What travels outwards follows from the populations that arrive from within. The state of the face is
//! that of the cells: nothing more is stored.

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

    /// What is added per step to what travels inwards.
    fn source(&self, within: &Flowing, normal: Normal, flow_in: impl Fn(usize) -> Flowing) -> f64 {
        let inwards = |velocity: [f64; 3]| normal.inward * velocity[normal.axis];
        let w = inwards(within.velocity);
        let mut source = inwards(within.acceleration);
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
            source -= ALONG / width * (v * (high[2] - low[2]) + sound() * (high[1] - low[1]));
        }
        source
    }

    /// Density excess and velocity of the cell at the face, from `known`, density times one less the velocity inwards,
    /// and the density excess given.
    pub(crate) fn wave(
        &self,
        known: f64,
        excess: f64,
        normal: Normal,
        flow_in: impl Fn(usize) -> Flowing,
    ) -> (f64, [f64; 3]) {
        let within = flow_in(self.place);
        let w = normal.inward * within.velocity[normal.axis];
        let carried = w - self.source(&within, normal, flow_in) / (sound() + w);
        // At the pressure given, what travels inwards is what travels outwards, plus twice the sound times the
        // logarithm of density: of that a share is taken.
        let rest = 1.0 - self.share;
        let stiffened = sound() * (1.0 + self.share) / rest;
        let given = logarithm_of_ratio(1.0 + excess, within.density);
        let wave = carried + 2.0 * self.share / rest * sound() * given;
        // 1 - known / density + stiffened * logarithm_of_ratio(density, within) = wave: one root is positive.
        let square = 1.0 - wave + 2.0 * stiffened;
        let linear = (1.0 - wave - 2.0 * stiffened) * within.density - known;
        let constant = known * within.density;
        let root = (linear * linear + 4.0 * square * constant).sqrt();
        let density = (root - linear) / (2.0 * square);
        (density - 1.0, within.velocity)
    }
}
