//! Moving the grains: drift half a step, take the loads there, kick, drift the other half.
//!
//! The scheme is the drift-kick-drift form of the leapfrog \[DEM-15\]:
//!
//! ```text
//! x_m = x_n + v_n dt/2        v_m = v_n + a_(m-1) dt/2        (predicted, for dashpots only)
//! a_m = F(x_m, v_m) / m + g
//! v_(n+1) = v_n + a_m dt      x_(n+1) = x_m + v_(n+1) dt/2
//! ```
//!
//! It is of second order, also with damping. The change of kinetic energy in a step is exactly
//! force times displacement, and the angular momentum about any point changes by exactly the
//! moment of the forces at `x_m`.

use crate::contacts::Pairs;
use crate::grains::Grains;
use granular_core::{Blocks, Dim, Linear, PerBlock};

/// First half of a step: drift, and predict the velocity at the middle.
pub(crate) fn open_step<D: Dim>(grains: &mut Grains<D>, blocks: Blocks, dt: f64, speeds: &mut [u64]) {
    let work = (
        &mut grains.position[..],
        &mut grains.middle_velocity[..],
        &mut grains.middle_spin[..],
        PerBlock(speeds),
    );
    let (velocity, acceleration) = (&grains.velocity, &grains.acceleration);
    let (spin, spin_acceleration) = (&grains.spin, &grains.spin_acceleration);
    blocks.for_each(work, |block, (position, middle, middle_spin, speed)| {
        let start = blocks.range(block).start;
        let half = 0.5 * dt;
        let mut fastest = 0;
        for k in 0..position.len() {
            let v = velocity[start + k];
            position[k] += v * half;
            middle[k] = v + acceleration[start + k] * half;
            fastest = fastest.max(order_of(v.length_squared())).max(order_of(middle[k].length_squared()));
        }
        for k in 0..middle_spin.len() {
            middle_spin[k] = spin[start + k] + spin_acceleration[start + k] * half;
        }
        speed.0[0] = fastest;
    });
}

/// Second half of a step, with the loads in `acceleration` and `spin_acceleration`; when `go_on`,
/// the first half of the next one as well.
pub(crate) fn close_step<D: Dim>(
    grains: &mut Grains<D>,
    pairs: &dyn Pairs<D>,
    blocks: Blocks,
    gravity: D::Vec,
    (dt, go_on): (f64, bool),
    speeds: &mut [u64],
) {
    if grains.has_particulars() {
        close::<D, true>(grains, pairs, blocks, gravity, (dt, go_on), speeds);
    } else {
        close::<D, false>(grains, pairs, blocks, gravity, (dt, go_on), speeds);
    }
}

/// What moves grains that are not free uniform balls.
#[derive(Clone, Copy)]
pub(crate) struct Particulars<'a> {
    fixed: &'a [bool],
    inertia: &'a [f64],
}

impl<'a> Particulars<'a> {
    /// Of the grains in a range; nothing where there is nothing particular.
    pub(crate) fn of(fixed: &'a [bool], inertia: &'a [f64], range: std::ops::Range<usize>) -> Self {
        Self { fixed: fixed.get(range.clone()).unwrap_or(&[]), inertia: inertia.get(range).unwrap_or(&[]) }
    }

    #[inline(always)]
    pub(crate) fn is_fixed(self, k: usize) -> bool {
        self.fixed.get(k).copied().unwrap_or(false)
    }

    #[inline(always)]
    pub(crate) fn inertia<D: Dim>(self, k: usize, mass: f64, radius: f64) -> f64 {
        self.inertia.get(k).copied().unwrap_or(D::BALL_INERTIA * mass * radius * radius)
    }
}

/// [`close_step`]; grains are free uniform balls unless some are `PARTICULAR`.
fn close<D: Dim, const PARTICULAR: bool>(
    grains: &mut Grains<D>,
    pairs: &dyn Pairs<D>,
    blocks: Blocks,
    gravity: D::Vec,
    (dt, go_on): (f64, bool),
    speeds: &mut [u64],
) {
    let work = (
        &mut grains.position[..],
        (&mut grains.velocity[..], &mut grains.acceleration[..], &mut grains.middle_velocity[..]),
        (&mut grains.spin[..], &mut grains.spin_acceleration[..], &mut grains.middle_spin[..]),
        PerBlock(speeds),
    );
    let (masses, radii, fixed, inertia) = (&grains.mass, &grains.radius, &grains.fixed, &grains.inertia);
    blocks.for_each(
        work,
        |block, (position, (velocity, load, middle), (spin, moment, middle_spin), speed)| {
            pairs.collect(block, load, moment);
            let range = blocks.range(block);
            let particulars = Particulars::of(fixed, inertia, range.clone());
            let (mass, radius) = (&masses[range.clone()], &radii[range]);
            let half = 0.5 * dt;
            let mut fastest = 0;
            for (k, &mass) in mass.iter().enumerate() {
                let mut acceleration = load[k] * (1.0 / mass) + gravity;
                if PARTICULAR && particulars.is_fixed(k) {
                    acceleration = D::Vec::ZERO;
                }
                let v = velocity[k] + acceleration * dt;
                let x = position[k] + v * half;
                load[k] = acceleration;
                velocity[k] = v;
                fastest = fastest.max(order_of(v.length_squared()));
                if go_on {
                    position[k] = x + v * half;
                    middle[k] = v + acceleration * half;
                    fastest = fastest.max(order_of(middle[k].length_squared()));
                } else {
                    position[k] = x;
                }
            }
            for k in 0..spin.len() {
                let inertia = if PARTICULAR {
                    particulars.inertia::<D>(k, mass[k], radius[k])
                } else {
                    D::BALL_INERTIA * mass[k] * radius[k] * radius[k]
                };
                let mut acceleration = moment[k] * (1.0 / inertia);
                if PARTICULAR && particulars.is_fixed(k) {
                    acceleration = D::Spin::ZERO;
                }
                let w = spin[k] + acceleration * dt;
                moment[k] = acceleration;
                spin[k] = w;
                if go_on {
                    middle_spin[k] = w + acceleration * half;
                }
            }
            speed.0[0] = fastest;
        },
    );
}

/// Numbers that are not negative keep their order as bits, and whatever is not finite comes
/// last: a maximum that does not lose a number that went wrong.
#[inline(always)]
pub(crate) fn order_of(square: f64) -> u64 {
    square.to_bits()
}

/// The greatest speed \[m/s\] of all blocks; not finite when any speed was not.
pub(crate) fn fastest(speeds: &[u64]) -> f64 {
    f64::from_bits(speeds.iter().copied().max().unwrap_or(0)).sqrt()
}
