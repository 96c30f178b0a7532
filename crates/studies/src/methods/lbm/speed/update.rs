//! Memory bandwidth of this machine by an update in place.

use granular_lbm::Pages;
use rayon::prelude::*;
use std::time::Instant;

/// Numbers that are updated: 192 MB, above any cache.
const LENGTH: usize = 3 << 23;
const CHUNK: usize = 1 << 16;
const ROUNDS: usize = 6;

/// Bandwidth of the pool in use \[bytes/s\] for an update in place, the best pattern there is: one number read and
/// written per element, in the pages that populations lie in.
pub(super) fn bandwidth() -> f64 {
    let mut a = Pages::<f64>::zeroed(LENGTH);
    a.fill(1.0);
    let mut best = f64::INFINITY;
    for round in 0..ROUNDS {
        let factor = 0.5 + round as f64;
        let begun = Instant::now();
        a.par_chunks_mut(CHUNK).for_each(|a| {
            for a in a {
                *a = *a * 0.5 + factor;
            }
        });
        best = best.min(begun.elapsed().as_secs_f64());
    }
    assert!(a[LENGTH / 2] > 0.5, "the result is kept, so that it is computed");
    (2 * LENGTH * size_of::<f64>()) as f64 / best
}
