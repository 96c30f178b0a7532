//! Arcs that will vanish, in the exact order in which the sweep line finds them.

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
}

impl Event {
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

/// A binary heap of events. Void events stay until they come to the top.
#[derive(Debug)]
pub(crate) struct Queue {
    heap: Vec<Entry>,
    events: Vec<Event>,
    free: Vec<u32>,
}

impl Queue {
    pub(crate) fn new() -> Self {
        Self { heap: Vec::new(), events: Vec::new(), free: Vec::new() }
    }

    pub(crate) fn event(&self, event: u32) -> &Event {
        &self.events[event as usize]
    }

    pub(crate) fn cancel(&mut self, event: u32) {
        self.events[event as usize].arc = NONE;
    }

    /// Adds an event and returns its number.
    pub(crate) fn push(&mut self, event: Event, sites: &[Site]) -> u32 {
        let entry = Entry {
            between: event.circle.between,
            event: self.free.pop().unwrap_or(self.events.len() as u32),
        };
        if entry.event as usize == self.events.len() {
            self.events.push(event);
        } else {
            self.events[entry.event as usize] = event;
        }
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
        entry.event
    }

    /// The number of the first event that is not void.
    pub(crate) fn first(&mut self, sites: &[Site]) -> Option<u32> {
        while let Some(top) = self.heap.first() {
            if self.event(top.event).arc != NONE {
                return Some(top.event);
            }
            self.pop(sites);
        }
        None
    }

    /// Removes the event at the top.
    pub(crate) fn pop(&mut self, sites: &[Site]) {
        let (Some(last), Some(&top)) = (self.heap.pop(), self.heap.first()) else {
            self.heap.clear();
            self.free.clear();
            self.events.clear();
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
    fn order(&self, a: u32, b: u32, sites: &[Site]) -> Ordering {
        order_of_circles(self.event(a).sites(sites), self.event(b).sites(sites))
    }
}
