//! The sweep \[Fortune1987\]: a line moves up and meets each disk at its lowest point. What the
//! sites found so far have won of the plane for good lies below the beach line.
//!
//! Disks of any size need nothing but other parabolas: a disk hidden in another one is known when
//! the line meets it, because its centre is then below the beach line.

use crate::beach::{Beach, NONE};
use crate::circle::{Circle, order_of_circle_and_site};
use crate::predicates::{beyond_break, nested, vanishes};
use crate::queue::{Event, Queue};
use crate::site::{Site, order};
use granular_core::glam::DVec2;
use std::cmp::Ordering;

/// A point that is equally near to three sites and nearer to no other one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub position: DVec2,
    /// Its distance to the three centres minus their radius. Negative where disks overlap.
    pub distance: f64,
}

/// What the sweep finds. Edge `e` has two half-edges, `2 e` and `2 e + 1`, one for each site, with
/// the site at the left of its direction.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    pub(crate) vertices: Vec<Vertex>,
    /// Site of each half-edge.
    pub(crate) site: Vec<u32>,
    /// Vertex at the end of each half-edge; `NONE` where it goes to infinity.
    pub(crate) target: Vec<u32>,
    /// For each site the one that hides it, or `NONE`.
    pub(crate) hidden_by: Vec<u32>,
}

struct Sweep<'a> {
    sites: &'a [Site],
    beach: Beach,
    queue: Queue,
    out: Topology,
}

/// The diagram of sites that come in the order of [`Site::order`].
pub(crate) fn sweep(sites: &[Site]) -> Topology {
    // Euler: at most 2 n vertices, 3 n edges.
    let (vertices, halves) = (2 * sites.len(), 6 * sites.len());
    let out = Topology {
        vertices: Vec::with_capacity(vertices),
        site: Vec::with_capacity(halves),
        target: Vec::with_capacity(halves),
        hidden_by: vec![NONE; sites.len()],
    };
    let queue = Queue::new([sites[0].low[0], sites[sites.len() - 1].low[0]], sites.len());
    let mut sweep = Sweep { sites, beach: beach(sites), queue, out };
    let level = sweep.first_row();
    for site in level..sites.len() {
        while let Some(event) = sweep.due(Some(site)) {
            sweep.vanish(event);
        }
        sweep.meet(site);
    }
    while let Some(event) = sweep.due(None) {
        sweep.vanish(event);
    }
    sweep.out
}

/// An empty beach line, with about as many hints as it will have arcs.
fn beach(sites: &[Site]) -> Beach {
    let [mut begin, mut end] = [sites[0].x; 2];
    for site in sites {
        (begin, end) = (begin.min(site.x), end.max(site.x));
    }
    let (width, height) = (end - begin, sites[sites.len() - 1].low[0] - sites[0].low[0]);
    let across = (sites.len() as f64 * width / height).sqrt().min(sites.len() as f64);
    // Not a number becomes 0.
    Beach::new([begin, end], across as usize)
}

impl Sweep<'_> {
    fn site(&self, arc: u32) -> &Site {
        &self.sites[self.beach.arc(arc).site as usize]
    }

    /// Sites that the line meets first, all at once: they stand side by side. Returns their number.
    fn first_row(&mut self) -> usize {
        let sites = self.sites;
        let mut last = NONE;
        for (index, site) in sites.iter().enumerate() {
            if order(site.low, sites[0].low) != Ordering::Equal {
                return index;
            }
            if self.hides_lowest(index) {
                continue;
            }
            let arc = self.beach.insert_after(last, index as u32);
            if last != NONE {
                self.beach.arc_mut(last).half = self.edge(self.beach.arc(last).site, index as u32);
                self.expect(last);
            }
            last = arc;
        }
        sites.len()
    }

    /// Whether the site has the lowest point of the one before it, which is then the larger one.
    fn hides_lowest(&mut self, site: usize) -> bool {
        if site == 0 || !self.sites[site].same_lowest_point(&self.sites[site - 1]) {
            return false;
        }
        let other = self.out.hidden_by[site - 1];
        self.out.hidden_by[site] = if other == NONE { site as u32 - 1 } else { other };
        true
    }

    /// A new edge between two sites; the half-edge of the first.
    fn edge(&mut self, left: u32, right: u32) -> u32 {
        let half = self.out.site.len() as u32;
        self.out.site.extend([left, right]);
        self.out.target.extend([NONE; 2]);
        half
    }

    /// The event that comes before the line meets a site, if there is one.
    fn due(&mut self, site: Option<usize>) -> Option<u32> {
        let height = site.map_or(f64::INFINITY, |site| self.sites[site].low[0]);
        let event = self.queue.first(height, self.sites)?;
        let Some(site) = site else {
            return Some(event);
        };
        let (site, Event { circle, .. }) = (&self.sites[site], *self.queue.event(event));
        let [earliest, latest] = circle.between;
        // The rounded height of the site is within the error that the bounds contain.
        let before = if latest < site.low[0] {
            true
        } else if earliest > site.low[0] {
            false
        } else {
            let circle = self.queue.event(event).sites(self.sites);
            order_of_circle_and_site(circle, site) != Ordering::Greater
        };
        before.then_some(event)
    }

    /// The line meets a site.
    fn meet(&mut self, index: usize) {
        if self.hides_lowest(index) {
            return;
        }
        let (sites, site) = (self.sites, &self.sites[index]);
        let arc = self.beach.find(site.x, |arc, next| {
            beyond_break(site, &sites[arc.site as usize], &sites[next.site as usize])
        });
        let owner = self.beach.arc(arc).site;
        if nested(site, &sites[owner as usize]) {
            self.out.hidden_by[index] = owner;
            return;
        }
        // The arc above is split in two.
        self.forget(arc);
        let outer = self.beach.arc(arc).half;
        let middle = self.beach.insert_after(arc, index as u32);
        let right = self.beach.insert_after(middle, owner);
        self.beach.hint(site.x, middle);
        let half = self.edge(owner, index as u32);
        self.beach.arc_mut(arc).half = half;
        self.beach.arc_mut(middle).half = half + 1;
        self.beach.arc_mut(right).half = outer;
        self.expect(arc);
        self.expect(right);
    }

    /// An arc vanishes: its neighbours meet in a vertex.
    fn vanish(&mut self, event: u32) {
        let Event { arc, sites: [left, middle, right], circle, .. } = *self.queue.event(event);
        self.queue.pop(self.sites);
        let (position, distance) = circle.centre(&self.sites[middle as usize]);
        let vertex = self.out.vertices.len() as u32;
        self.out.vertices.push(Vertex { position, distance });
        let (before, after) = (self.beach.arc(arc).previous, self.beach.arc(arc).next);
        let (first, second) = (self.beach.arc(before).half, self.beach.arc(arc).half);
        let new = self.edge(left, right);
        for half in [first, second, new + 1] {
            self.out.target[half as usize] = vertex;
        }
        self.beach.remove(arc);
        self.beach.arc_mut(before).half = new;
        for arc in [before, after] {
            self.forget(arc);
            self.expect(arc);
        }
    }

    /// Cancels the event of an arc.
    fn forget(&mut self, arc: u32) {
        let event = std::mem::replace(&mut self.beach.arc_mut(arc).event, NONE);
        if event != NONE {
            self.queue.cancel(event);
        }
    }

    /// Makes the event of an arc, if it will vanish.
    fn expect(&mut self, arc: u32) {
        let (before, after) = (self.beach.arc(arc).previous, self.beach.arc(arc).next);
        if before == NONE || after == NONE || self.beach.arc(before).site == self.beach.arc(after).site {
            return;
        }
        let [left, middle, right] = [before, arc, after].map(|arc| self.site(arc));
        if vanishes(left, middle, right) {
            let circle = Circle::new([left, middle, right]);
            let sites = [before, arc, after].map(|arc| self.beach.arc(arc).site);
            let event = self.queue.push(Event::new(arc, sites, circle), self.sites);
            self.beach.arc_mut(arc).event = event;
        }
    }
}
