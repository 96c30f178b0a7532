//! Memory bandwidth of this machine, by the triad `a = b + s c`.

use rayon::prelude::*;
use std::time::Instant;

/// Numbers in each of the three arrays: 64 MB each, above any cache.
const LENGTH: usize = 1 << 23;
const CHUNK: usize = 1 << 16;
const ROUNDS: usize = 6;

/// Bandwidth of the pool in use \[bytes/s\]: the best of some rounds, three numbers moved per
/// element.
pub(crate) fn bandwidth() -> f64 {
    let (mut a, b, c) = (vec![0.0_f64; LENGTH], vec![1.0_f64; LENGTH], vec![2.0_f64; LENGTH]);
    let mut best = f64::INFINITY;
    for round in 0..ROUNDS {
        let factor = 0.5 + round as f64;
        let begun = Instant::now();
        a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).zip(c.par_chunks(CHUNK)).for_each(|((a, b), c)| {
            for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                *a = b + factor * c;
            }
        });
        best = best.min(begun.elapsed().as_secs_f64());
    }
    assert!(a[LENGTH / 2] > 1.0, "the sum is kept, so that it is computed");
    (3 * LENGTH * size_of::<f64>()) as f64 / best
}
