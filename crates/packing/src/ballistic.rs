//! Ballistic deposition of disks with rolling to rest \[Vold1959, MeakinJullien1985, Kumar2014, section 3.5.6\].
//!
//! Disks are dropped one by one from a random place. A disk falls straight down onto the first
//! disk (or the floor), rolls down around it, and goes on from one disk to the next until it
//! rests on the floor or on two supports with its centre between them. Disks that have come
//! to rest never move. All contacts are intersections of circles and lines in closed form,
//! with square roots only, so that a seed gives the same bits on every machine.

use crate::error::{PackingError, largest_radius, require};
use crate::random::Random;
use granular_core::glam::DVec2;
use pile::Pile;

mod buckets;
mod pile;

/// What closes the box at the left (`x = 0`) and right (`x = width`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Smooth vertical walls.
    Walls,
    /// The box repeats itself; centres lie in 0 to width.
    Periodic,
}

/// What a disk rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// The floor `y = 0`, enough by itself.
    Floor,
    /// The wall `x = 0`.
    LeftWall,
    /// The wall `x = width`.
    RightWall,
    /// The disk of this number, or (periodic sides) its image next to this disk.
    Grain(u32),
}

/// Disks at rest, in the order of their radii.
#[derive(Clone, Debug, PartialEq)]
pub struct Deposit {
    /// Centres \[m\]; x from 0 to the width of the box, y above the floor `y = 0`.
    pub positions: Vec<DVec2>,
    /// The two supports of each disk; a disk that stands on the floor has the floor twice.
    pub supports: Vec<[Support; 2]>,
    /// Drops that were repeated from another place because round-off left an overlap.
    pub repeated: usize,
}

/// How often a disk is dropped before the deposition fails.
const DROPS: usize = 64;

/// Lets disks of these `radii` \[m\] rain, in this order, into a box of this `width` \[m\].
///
/// No overlap is larger than 1e-12 of the smaller radius, plus four units in the last place of
/// the coordinates; every disk is checked for it. Refuses a width below the largest diameter,
/// and radii that are not positive and finite.
///
/// Time and memory grow as the number of disks for a bounded ratio of diameters, and as the
/// square of that ratio.
pub fn ballistic(radii: &[f64], width: f64, sides: Sides, seed: u64) -> Result<Deposit, PackingError> {
    let diameter = 2.0 * largest_radius(radii)?;
    let wide = width >= diameter && width.is_finite();
    require(
        wide,
        "width of the box [m]",
        width,
        format!("at least {diameter} (the largest diameter), finite"),
    )?;
    let mut random = Random::new(seed);
    let mut pile = Pile::new(radii.len(), width, sides, 0.5 * diameter);
    let mut supports = Vec::with_capacity(radii.len());
    let mut repeated = 0;
    for (index, &radius) in radii.iter().enumerate() {
        let mut drops = 0..DROPS;
        let rest = drops.find_map(|_| {
            let x = match sides {
                Sides::Walls => radius + random.uniform() * (width - 2.0 * radius),
                Sides::Periodic => random.uniform() * width,
            };
            pile.settle(radius, x)
        });
        let rest = rest.ok_or(PackingError::NotSettled { index, radius, drops: DROPS })?;
        repeated += DROPS - drops.len() - 1;
        pile.add(radius, rest.point);
        supports.push(rest.supports);
    }
    Ok(Deposit { positions: pile.into_positions(), supports, repeated })
}

#[cfg(test)]
mod tests;
