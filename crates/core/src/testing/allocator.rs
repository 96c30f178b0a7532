//! A global allocator that counts, thread by thread.

// `GlobalAlloc` is an unsafe trait: there is no other way to see allocations. Every method hands
// its arguments on to the allocator of the system unchanged, so its conditions are the caller's.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    // Initialised without code and dropped without code, so that touching it never allocates.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
    static BYTES: Cell<u64> = const { Cell::new(0) };
}

/// The allocator of the system, with a count of allocations on each thread.
///
/// A test binary installs it with `#[global_allocator]`. Counts are by thread, so that tests
/// which run beside each other do not disturb one another.
#[derive(Clone, Copy, Debug, Default)]
pub struct CountingAllocator;

impl CountingAllocator {
    /// The allocator.
    pub const fn new() -> Self {
        Self
    }

    /// Allocations on this thread since it began, reallocations included; always zero unless the
    /// allocator is installed.
    pub fn on_this_thread() -> u64 {
        ALLOCATIONS.with(Cell::get)
    }

    /// Bytes asked for on this thread since it began, by reallocations too, whatever was given back; always zero unless the
    /// allocator is installed.
    pub fn bytes_on_this_thread() -> u64 {
        BYTES.with(Cell::get)
    }

    /// Whether the binary has installed it.
    pub fn is_installed() -> bool {
        let before = Self::on_this_thread();
        drop(std::hint::black_box(Box::new(1_u64)));
        Self::on_this_thread() > before
    }
}

fn count(bytes: usize) {
    // A thread that is being taken down has no counter any more.
    let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
    let _ = BYTES.try_with(|sum| sum.set(sum.get() + bytes as u64));
}

// SAFETY: each method passes its arguments to `System` and returns what that returns.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller keeps the conditions of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller keeps the conditions of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: the caller keeps the conditions of `realloc`.
        unsafe { System.realloc(place, layout, size) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the conditions of `dealloc`.
        unsafe { System.dealloc(place, layout) }
    }
}
