//! Links sorted by rows of the plane, for two steps in one pass: see [`crate::pair`].

use crate::links::{Both, Copies, CutLink, Cuts, entering_cut};
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
}

/// All links in the plane by rows, as they are after the first of two steps taken together. Without what forces need:
/// those are of the second step.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowLinks<T> {
    copies: ByRow<RowCopy<T>>,
    cuts: ByRow<RowCut<T>>,
    slips: ByRow<RowSlip<T>>,
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
            for cut in obstacles.iter().flat_map(|obstacle| &obstacle.links) {
                let &CutLink { to, from, weights, added, .. } = cut;
                take(row(to), RowCut { to: spot(to), from: from.map(spot), weights, added });
            }
        });
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
        for link in self.cuts.of_row(row) {
            window
                .set(link.to, entering_cut(link.from.map(|from| window.get(from)), link.weights, link.added));
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        self.copies.bytes() + self.cuts.bytes() + self.slips.bytes()
    }
}
