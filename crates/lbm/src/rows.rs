//! Links sorted by rows of the plane, for two steps in one pass: see [`crate::pair`].

use crate::links::{Both, Copies, CutLink, Cuts, entering_cut};
use crate::mass::{Kept, counted};
use crate::pair::Window;
use crate::populations::{Grid, Layout};
use crate::real::Real;
use crate::wall_faces::{SlipLink, entering_slip};

/// Where a number lies: in which plane, and where in it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spot {
    pub(crate) plane: u8,
    pub(crate) place: u32,
}

/// Links by the row in the plane of the cell that they enter.
#[derive(Clone, Debug, Default)]
struct ByRow<K> {
    /// First link of each row, and the end of the last row.
    starts: Vec<usize>,
    links: Vec<K>,
}

impl<K: Copy + Default> ByRow<K> {
    /// Takes all links that `each` names with their rows. Memory that there is is used again.
    fn fill(&mut self, rows: usize, each: impl Fn(&mut dyn FnMut(usize, K))) {
        self.starts.clear();
        self.starts.resize(rows + 1, 0);
        each(&mut |row, _| self.starts[row] += 1);
        let mut before = 0;
        for start in &mut self.starts {
            (*start, before) = (before, before + *start);
        }
        self.links.clear();
        self.links.resize(before, K::default());
        each(&mut |row, link| {
            self.links[self.starts[row]] = link;
            self.starts[row] += 1;
        });
        // Each start has become the next one.
        self.starts.copy_within(..rows, 1);
        self.starts[0] = 0;
    }

    fn of_row(&self, row: usize) -> &[K] {
        &self.links[self.starts[row]..self.starts[row + 1]]
    }

    fn bytes(&self) -> usize {
        size_of::<usize>() * self.starts.capacity() + size_of::<K>() * self.links.capacity()
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct RowCopy<T> {
    to: Spot,
    from: Spot,
    added: T,
}

#[derive(Clone, Copy, Debug, Default)]
struct RowSlip<T> {
    to: Spot,
    from: [Spot; 2],
    shares: [T; 2],
    added: T,
}

#[derive(Clone, Copy, Debug, Default)]
struct RowCut<T> {
    to: Spot,
    from: [Spot; 3],
    weights: [T; 3],
    added: T,
    share: T,
    obstacle: u32,
}

/// All links in the plane by rows, as they are after the first of two steps taken together. Without what forces need:
/// those are of the second step.
#[derive(Debug, Default)]
pub(crate) struct RowLinks<T> {
    copies: ByRow<RowCopy<T>>,
    cuts: ByRow<RowCut<T>>,
    slips: ByRow<RowSlip<T>>,
    /// The density that each obstacle gives back, and the mass that it keeps.
    dues: Vec<T>,
    kept: Kept,
}

impl<T: Real> RowLinks<T> {
    /// Takes the links as they are now.
    pub(crate) fn fill(&mut self, grid: &Grid, copies: &Copies<T>, obstacles: &[Cuts<T>]) {
        let row = |to: Both| grid.row_at(to[Layout::Natural as usize]);
        let spot = |both: Both| grid.spot(both[Layout::Turned as usize] as usize);
        self.copies.fill(grid.cells[1], |take| {
            for &(to, from) in &copies.resting {
                // Adding minus zero changes no bit.
                take(row(to), RowCopy { to: spot(to), from: spot(from), added: T::of(-0.0) });
            }
            for &(to, from, added) in &copies.moving {
                take(row(to), RowCopy { to: spot(to), from: spot(from), added });
            }
        });
        self.slips.fill(grid.cells[1], |take| {
            for &SlipLink { to, from, shares, added } in &copies.slipping {
                take(row(to), RowSlip { to: spot(to), from: from.map(spot), shares, added });
            }
        });
        self.cuts.fill(grid.cells[1], |take| {
            for (obstacle, cuts) in (0..).zip(obstacles) {
                for &CutLink { to, from, weights, added, share, .. } in &cuts.links {
                    let (to, from) = ((row(to), spot(to)), from.map(spot));
                    take(to.0, RowCut { to: to.1, from, weights, added, share, obstacle });
                }
            }
        });
    }

    /// Takes what obstacles give back in the next step.
    pub(crate) fn take_dues(&mut self, obstacles: &[Cuts<T>]) {
        self.dues.clear();
        self.dues.extend(obstacles.iter().map(Cuts::due));
        self.kept.reset(obstacles.len());
    }

    /// Hands over what obstacles kept in that step.
    pub(crate) fn hand_over_kept(&self, obstacles: &mut [Cuts<T>]) {
        for (number, obstacle) in obstacles.iter_mut().enumerate() {
            obstacle.keep_of_step(self.kept.of(number));
        }
    }

    /// Applies the links of the cells in a row.
    pub(crate) fn apply<const Q: usize>(&self, row: usize, window: &mut Window<'_, T, Q>) {
        for link in self.copies.of_row(row) {
            window.set(link.to, window.get(link.from) + link.added);
        }
        for link in self.slips.of_row(row) {
            let left = link.from.map(|from| window.get(from));
            window.set(link.to, entering_slip(left, link.shares, link.added));
        }
        let mut tally = self.kept.tally();
        for link in self.cuts.of_row(row) {
            let left = link.from.map(|from| window.get(from));
            let added = link.added + link.share * self.dues[link.obstacle as usize];
            let entering = entering_cut(left, link.weights, added);
            window.set(link.to, entering);
            tally.add(link.obstacle as usize, counted(left[0].double() - entering.double()));
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        self.copies.bytes()
            + self.cuts.bytes()
            + self.slips.bytes()
            + self.kept.bytes()
            + size_of::<T>() * self.dues.capacity()
    }
}
