//! Parallel loops and sums with the same bits for any number of threads.
//!
//! Items are cut into blocks whose size comes from the scene, never from the thread pool. A
//! loop gives every block its own part of each array; sums are taken block by block and
//! combined in the order of the blocks. The pool is the caller's: everything here runs in the
//! rayon pool that is current, and without rayon when that pool has one thread.

use std::ops::Range;

/// Does `work` on a thread of the current pool, and without it when that has one thread.
///
/// A loop that a thread outside the pool begins wakes a thread of it and waits, 30 to 40 μs each time: a third of
/// the step of 3000 disks. Solvers go inside once, and take their steps there.
pub fn inside_pool<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if rayon::current_thread_index().is_none() && rayon::current_num_threads() > 1 {
        rayon::scope(|_| work())
    } else {
        work()
    }
}

/// A cut of `items` into blocks of equal size (the last may be shorter).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks {
    items: usize,
    size: usize,
}

/// Arrays that can be cut between two blocks: slices, [`PerBlock`] and tuples of these.
pub trait Divide: Send + Sized {
    /// Cuts after `blocks` blocks of `size` items. An empty array (a property that the scene
    /// does not need) stays empty on both sides.
    fn divide(self, blocks: usize, size: usize) -> (Self, Self);
}

/// One value per block instead of one per item.
#[derive(Debug)]
pub struct PerBlock<'a, T>(pub &'a mut [T]);

impl<T: Send> Divide for &mut [T] {
    fn divide(self, blocks: usize, size: usize) -> (Self, Self) {
        let at = (blocks * size).min(self.len());
        self.split_at_mut(at)
    }
}

impl<T: Send> Divide for PerBlock<'_, T> {
    fn divide(self, blocks: usize, _: usize) -> (Self, Self) {
        let at = blocks.min(self.0.len());
        let (left, right) = self.0.split_at_mut(at);
        (Self(left), Self(right))
    }
}

macro_rules! divide_tuples {
    ($(($($name:ident),+))*) => {$(
        impl<$($name: Divide),+> Divide for ($($name,)+) {
            fn divide(self, blocks: usize, size: usize) -> (Self, Self) {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $(#[allow(non_snake_case)] let $name = $name.divide(blocks, size);)+
                (($($name.0,)+), ($($name.1,)+))
            }
        }
    )*};
}
divide_tuples! { (A, B) (A, B, C) (A, B, C, E) (A, B, C, E, F) (A, B, C, E, F, G) (A, B, C, E, F, G, H) (A, B, C, E, F, G, H, I) }

impl Blocks {
    /// Cuts `items` into blocks of `size`.
    pub fn new(items: usize, size: usize) -> Self {
        Self { items, size: size.max(1) }
    }

    /// About `count` blocks, none smaller than `smallest` items.
    pub fn about(items: usize, count: usize, smallest: usize) -> Self {
        Self::new(items, items.div_ceil(count.max(1)).max(smallest))
    }

    /// Number of blocks.
    pub fn count(self) -> usize {
        self.items.div_ceil(self.size)
    }

    /// Items in one block.
    pub fn size(self) -> usize {
        self.size
    }

    /// Items of block `block`.
    pub fn range(self, block: usize) -> Range<usize> {
        block * self.size..((block + 1) * self.size).min(self.items)
    }

    /// Does `work`, whose loops run over these blocks, [inside the pool](inside_pool) if there is more than one: a single
    /// block keeps to the thread of the caller, and a call costs nothing for threads that it does not use.
    pub fn inside_pool<T: Send>(self, work: impl FnOnce() -> T + Send) -> T {
        if self.count() > 1 { inside_pool(work) } else { work() }
    }

    /// Calls `body` once per block with the parts of `work` that belong to it.
    pub fn for_each<W: Divide>(self, work: W, body: impl Fn(usize, W) + Sync) {
        if self.count() > 0 {
            // A single block asks nothing of a pool, which may not even be there yet.
            let parallel = self.count() > 1 && rayon::current_num_threads() > 1;
            self.descend(0..self.count(), work, &body, parallel);
        }
    }

    fn descend<W: Divide>(
        self,
        blocks: Range<usize>,
        work: W,
        body: &(impl Fn(usize, W) + Sync),
        parallel: bool,
    ) {
        if blocks.len() == 1 {
            return body(blocks.start, work);
        }
        let left = blocks.len() / 2;
        let (first, second) = work.divide(left, self.size);
        let (a, b) = (blocks.start..blocks.start + left, blocks.start + left..blocks.end);
        if parallel {
            rayon::join(|| self.descend(a, first, body, true), || self.descend(b, second, body, true));
        } else {
            self.descend(a, first, body, false);
            self.descend(b, second, body, false);
        }
    }

    /// One value per block, in the order of the blocks.
    pub fn map<T: Send + Default + Clone>(self, value: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
        let mut values = vec![T::default(); self.count()];
        self.for_each(PerBlock(&mut values), |block, slot| slot.0[0] = value(self.range(block)));
        values
    }

    /// Sum of a number per item, block by block: the same bits for any number of threads.
    pub fn sum(self, value: impl Fn(usize) -> f64 + Sync) -> f64 {
        self.map(|range| range.map(&value).sum::<f64>()).into_iter().sum()
    }

    /// Largest of a number per item; minus infinity when there are none. Not a number wins.
    pub fn largest(self, value: impl Fn(usize) -> f64 + Sync) -> f64 {
        let larger = |a: f64, b: f64| if a.is_nan() || a >= b { a } else { b };
        self.map(|range| range.map(&value).fold(f64::NEG_INFINITY, larger))
            .into_iter()
            .fold(f64::NEG_INFINITY, larger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_pool<T: Send>(threads: usize, body: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(body)
    }

    #[test]
    fn sums_have_the_same_bits_for_any_number_of_threads() {
        let value = |i: usize| ((i * 7919) % 1013) as f64 * 1e-3 + 1e8 / (1.0 + i as f64);
        let sums: Vec<u64> = [1, 2, 3, 8]
            .iter()
            .map(|&threads| in_pool(threads, || Blocks::new(10_007, 64).sum(value).to_bits()))
            .collect();
        assert!(sums.iter().all(|&bits| bits == sums[0]));
    }

    #[test]
    fn work_goes_inside_a_pool_once() {
        let index = || rayon::current_thread_index();
        assert!(index().is_none(), "tests run outside of pools");
        let [outer, inner] = inside_pool(|| [index(), inside_pool(index)]);
        assert_eq!(outer, inner);
        assert_eq!(outer.is_some(), rayon::current_num_threads() > 1);
        in_pool(1, || assert_eq!(inside_pool(index), Some(0)));
    }

    /// Waking a thread of a pool costs more than a step of a small solver.
    #[test]
    fn a_single_block_stays_on_the_thread_of_the_caller() {
        let thread = || std::thread::current().id();
        let single = Blocks::new(10, 64);
        assert_eq!(single.inside_pool(thread), thread());
        let mut seen = [None; 1];
        single.for_each(PerBlock(&mut seen), |_, slot| slot.0[0] = Some(thread()));
        assert_eq!(seen[0], Some(thread()));
        if rayon::current_num_threads() > 1 {
            assert_ne!(Blocks::new(100, 64).inside_pool(thread), thread());
        }
    }

    #[test]
    fn every_item_is_visited_once_and_empty_arrays_stay_empty() {
        for threads in [1, 3] {
            let mut visits = vec![0_u32; 1000];
            let mut none: Vec<f64> = Vec::new();
            let mut counts = vec![0_usize; 16];
            let blocks = Blocks::new(1000, 64);
            in_pool(threads, || {
                blocks.for_each(
                    (&mut visits[..], &mut none[..], PerBlock(&mut counts)),
                    |_, (items, none, count)| {
                        items.iter_mut().for_each(|visit| *visit += 1);
                        assert!(none.is_empty());
                        count.0[0] = items.len();
                    },
                );
            });
            assert!(visits.iter().all(|&v| v == 1));
            assert_eq!(counts.iter().sum::<usize>(), 1000);
            assert_eq!(counts[15], 1000 - 15 * 64);
        }
    }

    #[test]
    fn not_a_number_is_not_lost_in_a_maximum() {
        assert!(Blocks::new(100, 8).largest(|i| if i == 37 { f64::NAN } else { i as f64 }).is_nan());
        assert_eq!(Blocks::new(100, 8).largest(|i| i as f64), 99.0);
    }
}
