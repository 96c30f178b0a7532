//! Mass that the walls of obstacles keep from the fluid, and give back.
//!
//! What enters from an interpolated wall differs from what left towards it, and over a closed surface the differences leave a
//! small rest, which grows with the square of the speed. No mass passes a wall, so each obstacle gives the rest of a step back in
//! the next one: by the same density over all its links, which pushes nowhere, since the weights of the links of a closed surface
//! sum to no momentum. The same holds for what a body that moves covers and uncovers, beyond the density at rest. What it sweeps
//! by its velocity is no rest: over a closed surface that sums to nothing, but a body may enter through a face or touch another.
//!
//! Mass is counted in whole numbers, so that a sum has the same bits in any order.

use crate::real::Real;
use std::sync::atomic::{AtomicI64, Ordering::Relaxed};

/// Counts in the mass of a cell at the density at rest.
const UNITS: f64 = (1_u64 << 54) as f64;
/// Largest density, over that at rest, at which mass is given back: the rest waits, so that bodies with few links are not struck.
const LARGEST: f64 = 1e-2;

/// A mass \[cells at the density at rest\] as a count.
#[inline]
pub(crate) fn counted(mass: f64) -> i64 {
    (mass * UNITS) as i64
}

/// The density at which an obstacle gives back what it keeps, where the weights of its links sum to `weight`.
pub(crate) fn due<T: Real>(kept: i64, weight: f64) -> T {
    if weight > 0.0 { T::of((kept as f64 / UNITS / weight).clamp(-LARGEST, LARGEST)) } else { T::of(0.0) }
}

/// What obstacles keep in a pass over links that is shared among threads.
#[derive(Debug, Default)]
pub(crate) struct Kept(Vec<AtomicI64>);

impl Kept {
    /// Nothing, for so many obstacles.
    pub(crate) fn reset(&mut self, obstacles: usize) {
        self.0.clear();
        self.0.resize_with(obstacles, AtomicI64::default);
    }

    pub(crate) fn of(&self, obstacle: usize) -> i64 {
        self.0[obstacle].load(Relaxed)
    }

    pub(crate) fn tally(&self) -> Tally<'_> {
        Tally { kept: self, obstacle: 0, count: 0 }
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<AtomicI64>() * self.0.capacity()
    }
}

/// Adds up what follows for the same obstacle.
pub(crate) struct Tally<'a> {
    kept: &'a Kept,
    obstacle: usize,
    count: i64,
}

impl Tally<'_> {
    #[inline]
    pub(crate) fn add(&mut self, obstacle: usize, count: i64) {
        if obstacle != self.obstacle {
            self.flush();
            self.obstacle = obstacle;
        }
        self.count = self.count.wrapping_add(count);
    }

    fn flush(&mut self) {
        let count = std::mem::take(&mut self.count);
        if count != 0 {
            self.kept.0[self.obstacle].fetch_add(count, Relaxed);
        }
    }
}

impl Drop for Tally<'_> {
    fn drop(&mut self) {
        self.flush();
    }
}
