//! The beach line: arcs from left to right, in a search tree (a treap with fixed priorities) whose
//! nodes are also a list.
//!
//! A search starts at the arc that was last made near the place, and takes the tree if a few steps along the list do
//! not end it.

/// No arc, vertex, edge or event.
pub(crate) const NONE: u32 = u32::MAX;

/// An arc, and the break at its right end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    pub(crate) site: u32,
    /// The half-edge of this site that the break at the right draws.
    pub(crate) half: u32,
    /// The event at which the arc vanishes.
    pub(crate) event: u32,
    pub(crate) previous: u32,
    pub(crate) next: u32,
    parent: u32,
    below: [u32; 2],
    priority: u32,
}

/// Arcs from left to right.
#[derive(Debug)]
pub(crate) struct Beach {
    arcs: Vec<Arc>,
    free: Vec<u32>,
    root: u32,
    made: u32,
    hints: Hints,
}

/// Arcs that were made last in equal intervals of `x`, with their sites; they may be gone.
#[derive(Debug)]
struct Hints {
    arcs: Vec<[u32; 2]>,
    begin: f64,
    density: f64,
}

impl Hints {
    fn place(&self, x: f64) -> usize {
        // The conversion saturates, below at 0.
        (((x - self.begin) * self.density) as usize).min(self.arcs.len() - 1)
    }
}

/// Steps along the list before the tree is taken.
const WALK: usize = 12;

/// Priorities that look random and are the same in every run.
fn scramble(number: u32) -> u32 {
    let mut x = number.wrapping_add(0x9e37_79b9);
    x = (x ^ x >> 16).wrapping_mul(0x21f0_aaad);
    x = (x ^ x >> 15).wrapping_mul(0x735a_2d97);
    x ^ x >> 15
}

impl Beach {
    /// A beach line for sites between two places, with so many hints.
    pub(crate) fn new([begin, end]: [f64; 2], count: usize) -> Self {
        let density = count as f64 / (end - begin);
        let density = if density.is_finite() { density } else { 0.0 };
        let hints = Hints { arcs: vec![[NONE; 2]; count + 1], begin, density };
        Self { arcs: Vec::new(), free: Vec::new(), root: NONE, made: 0, hints }
    }

    pub(crate) fn arc(&self, arc: u32) -> &Arc {
        &self.arcs[arc as usize]
    }

    pub(crate) fn arc_mut(&mut self, arc: u32) -> &mut Arc {
        &mut self.arcs[arc as usize]
    }

    /// The first arc whose right end is not passed at `x`; `beyond(arc, next)` tells whether it is.
    #[inline(always)]
    pub(crate) fn find(&self, x: f64, beyond: impl Fn(&Arc, &Arc) -> bool) -> u32 {
        let passed = |arc: u32| {
            let arc = self.arc(arc);
            arc.next != NONE && beyond(arc, self.arc(arc.next))
        };
        let guess = self.guess(x);
        guess.and_then(|arc| self.walk(arc, passed)).unwrap_or_else(|| self.descend(passed))
    }

    /// An arc that was made near a place and is still there.
    #[inline(always)]
    fn guess(&self, x: f64) -> Option<u32> {
        let place = self.hints.place(x);
        let near = [0, 1, usize::MAX, 2, usize::MAX - 1].map(|step| place.wrapping_add(step));
        let made = near.into_iter().filter_map(|place| self.hints.arcs.get(place));
        let mut there = made.filter(|[arc, site]| *arc != NONE && self.arc(*arc).site == *site);
        there.next().map(|[arc, _]| *arc)
    }

    /// Where searches near `x` may start.
    pub(crate) fn hint(&mut self, x: f64, arc: u32) {
        let place = self.hints.place(x);
        self.hints.arcs[place] = [arc, self.arc(arc).site];
    }

    /// The arc if it is not far from a first guess.
    #[inline(always)]
    fn walk(&self, mut arc: u32, passed: impl Fn(u32) -> bool) -> Option<u32> {
        if passed(arc) {
            for _ in 0..WALK {
                arc = self.arc(arc).next;
                if !passed(arc) {
                    return Some(arc);
                }
            }
        } else {
            for _ in 0..WALK {
                let previous = self.arc(arc).previous;
                if previous == NONE || passed(previous) {
                    return Some(arc);
                }
                arc = previous;
            }
        }
        None
    }

    #[inline(never)]
    fn descend(&self, passed: impl Fn(u32) -> bool) -> u32 {
        let (mut node, mut found) = (self.root, NONE);
        while node != NONE {
            let right = passed(node);
            if !right {
                found = node;
            }
            node = self.arc(node).below[usize::from(right)];
        }
        found
    }

    fn make(&mut self, site: u32) -> u32 {
        let priority = scramble(self.made);
        self.made = self.made.wrapping_add(1);
        let arc = Arc {
            site,
            half: NONE,
            event: NONE,
            previous: NONE,
            next: NONE,
            parent: NONE,
            below: [NONE; 2],
            priority,
        };
        if let Some(place) = self.free.pop() {
            self.arcs[place as usize] = arc;
            return place;
        }
        self.arcs.push(arc);
        self.arcs.len() as u32 - 1
    }

    /// Adds an arc at the right of another one, or the first arc (after `NONE`).
    pub(crate) fn insert_after(&mut self, left: u32, site: u32) -> u32 {
        let arc = self.make(site);
        if left == NONE {
            self.root = arc;
            return arc;
        }
        let next = self.arc(left).next;
        self.arc_mut(arc).previous = left;
        self.arc_mut(arc).next = next;
        self.arc_mut(left).next = arc;
        if next != NONE {
            self.arc_mut(next).previous = arc;
        }
        // One of the two neighbours has a free place towards the other.
        let (parent, side) = if self.arc(left).below[1] == NONE { (left, 1) } else { (next, 0) };
        self.arc_mut(parent).below[side] = arc;
        self.arc_mut(arc).parent = parent;
        while self.arc(arc).parent != NONE && self.arc(self.arc(arc).parent).priority < self.arc(arc).priority
        {
            self.raise(arc);
        }
        arc
    }

    pub(crate) fn remove(&mut self, arc: u32) {
        loop {
            let [left, right] = self.arc(arc).below;
            match (left, right) {
                (NONE, NONE) => break,
                (NONE, child) | (child, NONE) => self.raise(child),
                _ if self.arc(left).priority > self.arc(right).priority => self.raise(left),
                _ => self.raise(right),
            }
        }
        let Arc { parent, previous, next, .. } = *self.arc(arc);
        self.replace_below(parent, arc, NONE);
        if previous != NONE {
            self.arc_mut(previous).next = next;
        }
        if next != NONE {
            self.arc_mut(next).previous = previous;
        }
        self.arc_mut(arc).site = NONE;
        self.free.push(arc);
    }

    /// Puts another node in the place of one below a parent.
    fn replace_below(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
        } else {
            let side = usize::from(self.arc(parent).below[1] == old);
            self.arc_mut(parent).below[side] = new;
        }
    }

    /// Exchanges a node with its parent, keeping the order.
    fn raise(&mut self, node: u32) {
        let parent = self.arc(node).parent;
        let above = self.arc(parent).parent;
        let side = usize::from(self.arc(parent).below[1] == node);
        let inner = self.arc(node).below[1 - side];
        self.arc_mut(parent).below[side] = inner;
        if inner != NONE {
            self.arc_mut(inner).parent = parent;
        }
        self.arc_mut(node).below[1 - side] = parent;
        self.arc_mut(parent).parent = node;
        self.arc_mut(node).parent = above;
        self.replace_below(above, parent, node);
    }
}
