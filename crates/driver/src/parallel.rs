//! Independent runs, each on one thread of its own.

use crate::failure::Failure;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Does some work on each item, as many at a time as the pool has threads. Each runs in a pool of
/// one thread: runs do not steal from each other, so their wall times mean something.
///
/// # Errors
/// The first failure, in the order of items.
pub fn each<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&T) -> Result<R, Failure> + Sync,
) -> Result<Vec<R>, Failure> {
    let next = AtomicUsize::new(0);
    let done: Vec<Mutex<Option<Result<R, Failure>>>> = items.iter().map(|_| Mutex::new(None)).collect();
    let worker = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return };
            let result = pool(1).and_then(|pool| pool.install(|| work(item)));
            *done[index].lock().expect("no worker panics while it holds a result") = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(items.len()) {
            scope.spawn(worker);
        }
    });
    let results = done.into_iter().map(|slot| slot.into_inner().expect("workers are gone"));
    results.map(|result| result.expect("every item was worked on")).collect()
}

/// A pool of so many threads.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool, Failure> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    built.map_err(|error| Failure::io("threads", error))
}
