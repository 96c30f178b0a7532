//! Arcs that will vanish, in the exact order in which the sweep line finds them.
//!
//! Events wait in buckets of their rounded height and come into the heap when the line is near: it stays small,
//! and most events that become void never enter it.

use crate::beach::NONE;
use crate::circle::{Circle, order_of_circles};
use crate::site::Site;
use std::cmp::Ordering;

/// An arc that will vanish between its neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    /// The arc; `NONE` once the event is void.
    pub(crate) arc: u32,
    /// Sites at the left, in the middle and at the right.
    pub(crate) sites: [u32; 3],
    pub(crate) circle: Circle,
    /// The next one in its bucket.
    next: u32,
}

impl Event {
    pub(crate) fn new(arc: u32, sites: [u32; 3], circle: Circle) -> Self {
        Self { arc, sites, circle, next: NONE }
    }

    pub(crate) fn sites<'a>(&self, sites: &'a [Site]) -> [&'a Site; 3] {
        self.sites.map(|site| &sites[site as usize])
    }
}

/// A place in the heap: bounds on the time and the number of the event.
#[derive(Clone, Copy, Debug)]
struct Entry {
    between: [f64; 2],
    event: u32,
}

/// Buckets of events, and a binary heap of those that are near. Void events stay until they come to the top or their
/// bucket is emptied.
#[derive(Debug)]
pub(crate) struct Queue {
    heap: Vec<Entry>,
    events: Vec<Event>,
    free: Vec<u32>,
    /// First event of each bucket.
    buckets: Vec<u32>,
    /// Height at which the buckets begin, and how many there are to a unit of height.
    begin: f64,
    density: f64,
    /// The first bucket that is not in the heap.
    near: usize,
}

impl Queue {
    /// A queue for sites between two heights; events may also come later.
    pub(crate) fn new([begin, end]: [f64; 2], count: usize) -> Self {
        let density = count as f64 / (end - begin);
        // Without height there is one bucket.
        let density = if density.is_finite() { density } else { 0.0 };
        let buckets = vec![NONE; count + 1];
        Self { heap: Vec::new(), events: Vec::new(), free: Vec::new(), buckets, begin, density, near: 0 }
    }

    pub(crate) fn event(&self, event: u32) -> &Event {
        &self.events[event as usize]
    }

    pub(crate) fn cancel(&mut self, event: u32) {
        self.events[event as usize].arc = NONE;
    }

    /// The bucket of a height: never falls when the height grows.
    fn bucket(&self, height: f64) -> usize {
        // The conversion saturates, below at 0.
        (((height - self.begin) * self.density) as usize).min(self.buckets.len() - 1)
    }

    /// Adds an event and returns its number.
    pub(crate) fn push(&mut self, event: Event, sites: &[Site]) -> u32 {
        let number = self.free.pop().unwrap_or(self.events.len() as u32);
        let bucket = self.bucket(event.circle.between[0]);
        let is_near = bucket < self.near;
        let next = if is_near { NONE } else { std::mem::replace(&mut self.buckets[bucket], number) };
        let event = Event { next, ..event };
        if number as usize == self.events.len() {
            self.events.push(event);
        } else {
            self.events[number as usize] = event;
        }
        if is_near {
            self.enter(number, sites);
        }
        number
    }

    /// Puts an event into the heap.
    fn enter(&mut self, event: u32, sites: &[Site]) {
        let entry = Entry { between: self.event(event).circle.between, event };
        let mut place = self.heap.len();
        self.heap.push(entry);
        while place > 0 {
            let above = (place - 1) / 2;
            if !self.before(&entry, &self.heap[above], sites) {
                break;
            }
            self.heap[place] = self.heap[above];
            place = above;
        }
        self.heap[place] = entry;
    }

    /// Empties the next bucket into the heap.
    fn approach(&mut self, sites: &[Site]) {
        let mut event = std::mem::replace(&mut self.buckets[self.near], NONE);
        self.near += 1;
        while event != NONE {
            let Event { arc, next, .. } = *self.event(event);
            if arc == NONE {
                self.free.push(event);
            } else {
                self.enter(event, sites);
            }
            event = next;
        }
    }

    /// The number of the first event that is not void and may come before a height.
    pub(crate) fn first(&mut self, height: f64, sites: &[Site]) -> Option<u32> {
        let last = self.bucket(height);
        loop {
            // What may come before the top must be in the heap.
            let top = self.heap.first().copied();
            let needed = match top {
                Some(Entry { between: [_, latest], .. }) if latest < height => self.bucket(latest),
                // Bounds that are no numbers leave the order to exact numbers.
                _ => last,
            };
            if self.near <= needed {
                self.approach(sites);
                continue;
            }
            let event = top?.event;
            if self.event(event).arc != NONE {
                return Some(event);
            }
            self.pop(sites);
        }
    }

    /// Removes the event at the top.
    pub(crate) fn pop(&mut self, sites: &[Site]) {
        let Some(last) = self.heap.pop() else { return };
        let Some(&top) = self.heap.first() else {
            self.free.push(last.event);
            return;
        };
        self.free.push(top.event);
        let mut place = 0;
        loop {
            let mut child = 2 * place + 1;
            if child >= self.heap.len() {
                break;
            }
            if child + 1 < self.heap.len() && self.before(&self.heap[child + 1], &self.heap[child], sites) {
                child += 1;
            }
            if !self.before(&self.heap[child], &last, sites) {
                break;
            }
            self.heap[place] = self.heap[child];
            place = child;
        }
        self.heap[place] = last;
    }

    #[inline(always)]
    fn before(&self, a: &Entry, b: &Entry, sites: &[Site]) -> bool {
        if a.between[1] < b.between[0] {
            return true;
        }
        if b.between[1] < a.between[0] {
            return false;
        }
        self.order(a.event, b.event, sites) == Ordering::Less
    }

    /// Exact order of two events that rounding cannot tell apart. Void ones keep their sites, and so
    /// their place.
    #[cold]
    #[inline(never)]
    fn order(&self, a: u32, b: u32, sites: &[Site]) -> Ordering {
        order_of_circles(self.event(a).sites(sites), self.event(b).sites(sites))
    }
}
