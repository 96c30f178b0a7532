//! Two steps in one pass over memory, in the plane and without open faces.
//!
//! A step from the natural layout touches one cell at a time; the next one touches neighbours, and may
//! follow as soon as the links of both rows beside it are done, which in turn wait for the rows beside
//! them. Each slab of rows so takes both steps of the rows well inside it in one sweep, the second lagging by
//! two rows, while they lie in cache. Links of the rows at the ends of slabs follow, then the second step
//! there. Bits are those of one step at a time: the same numbers go through the same operations.

use crate::body_force::ForceField;
use crate::collision::{Parameters, Parts};
use crate::immersed::{Cells, Met};
use crate::lattice::Lattice;
use crate::populations::{Grid, Layout, Populations, Row, Runs, Slab, collide_runs};
use crate::real::Real;
use crate::rows::{RowLinks, Spot};
use granular_core::blocks::{Blocks, PerBlock};
use std::ops::Range;

/// Rows at each end of a slab that take the second step later; one more row is touched.
const LATE: usize = 2;

/// Rows of a slab, near `size`, such that the last slab does not end among the late rows of a whole one.
pub(crate) fn slab_rows(rows: usize, size: usize) -> usize {
    let is_apt = |size: &usize| rows.is_multiple_of(*size) || rows % size + LATE < *size;
    (size.max(2 * LATE + 2)..).find(is_apt).unwrap_or(rows)
}

/// Part of each plane, ring and padding included.
pub(crate) struct Window<'a, T, const Q: usize> {
    planes: [&'a mut [T]; Q],
    /// Place of the first number.
    start: usize,
}

impl<T: Real, const Q: usize> Window<'_, T, Q> {
    #[inline]
    pub(crate) fn get(&self, spot: Spot) -> T {
        self.planes[spot.plane as usize][spot.place as usize - self.start]
    }

    #[inline]
    pub(crate) fn set(&mut self, spot: Spot, value: T) {
        self.planes[spot.plane as usize][spot.place as usize - self.start] = value;
    }

    /// Collides a row from a layout. Returns whether a population at rest is beyond `bound`.
    fn collide<L: Lattice<Q>, P: Parts>(
        &mut self,
        (grid, layout): (&Grid, Layout),
        cells: Row<'_, T>,
        met: &mut Met<'_, T>,
        (parameters, bound): (&Parameters<T>, T),
    ) -> bool {
        let mut planes = self.planes.each_mut().map(Some);
        let mut starts = [0; Q];
        let mut by_direction: [&mut [T]; Q] = std::array::from_fn(|i| {
            let spot = grid.spot(grid.entering::<L, Q>(layout, grid.row_place(cells.row), i));
            starts[i] = spot.place as usize - self.start;
            &mut **planes[spot.plane as usize].take().expect("each direction has a plane of its own")
        });
        collide_runs::<L, T, P, Q>(&mut by_direction, starts, cells, met, parameters, bound)
    }
}

/// Rows of slab `block` and, among them, those whose links do not wait for other slabs and those that take both steps
/// in one sweep.
fn rows_of_slab(rows: usize, size: usize, block: usize) -> [Range<usize>; 3] {
    let (first, end) = (block * size, ((block + 1) * size).min(rows));
    [first..end, first + 1..end.saturating_sub(1), first + LATE..end.saturating_sub(LATE)]
}

impl<T: Real> Populations<T> {
    /// Two steps from the natural layout, each with parameters of its own, with `links` between. Those after the second step
    /// are left to the caller. Returns whether any population at rest is not finite or larger than `bound` after either.
    pub(crate) fn two_steps<L: Lattice<Q>, P: Parts, const Q: usize>(
        &mut self,
        (runs, cells): (&Runs, &mut Cells<T>),
        links: &RowLinks<T>,
        field: &ForceField<T>,
        [first, second]: &[Parameters<T>; 2],
        bound: T,
    ) -> bool {
        debug_assert!(self.layout == Layout::Natural && L::VELOCITIES.iter().all(|c| c[2] == 0));
        let (rows, size) = (runs.rows(), self.pair);
        let grid = &self.grid;
        let (natural, turned) = ((grid, Layout::Natural), (grid, Layout::Turned));
        let planes = grid.planes::<T, Q>(&mut self.values);
        // Slabs have a row of the ring before the first row.
        let slabs = Slab { planes, pitch: grid.stride(1), lead: 1 };
        let (covered, met) = cells.for_collisions();
        let work = (slabs, met, PerBlock(&mut self.beyond));
        Blocks::new(rows, size).for_each(work, |block, (slab, mut met, beyond)| {
            let [all, linked, inner] = rows_of_slab(rows, size, block);
            let start = if block == 0 { 0 } else { grid.row_start(all.start) };
            let mut window = Window { planes: slab.planes, start };
            let mut worst = false;
            for row in all {
                let cells = Row { row, runs, covered, field };
                worst |= window.collide::<L, P>(natural, cells, &mut met, (first, bound));
                if row > 0 && linked.contains(&(row - 1)) {
                    links.apply(row - 1, &mut window);
                }
                if row > 1 && inner.contains(&(row - 2)) {
                    let cells = Row { row: row - 2, runs, covered, field };
                    worst |= window.collide::<L, P>(turned, cells, &mut met, (second, bound));
                }
            }
            beyond.0[0] = worst;
        });
        let mut everywhere = Window { planes: grid.planes::<T, Q>(&mut self.values), start: 0 };
        for block in 0..Blocks::new(rows, size).count() {
            let [all, linked, _] = rows_of_slab(rows, size, block);
            all.filter(|row| !linked.contains(row)).for_each(|row| links.apply(row, &mut everywhere));
        }
        let is_beyond = self.beyond[..Blocks::new(rows, size).count()].contains(&true);
        self.late_rows::<L, P, Q>((runs, cells), field, second, bound) | is_beyond
    }

    /// The second step where slabs meet, in blocks as long as slabs that begin before their late rows.
    fn late_rows<L: Lattice<Q>, P: Parts, const Q: usize>(
        &mut self,
        (runs, cells): (&Runs, &mut Cells<T>),
        field: &ForceField<T>,
        parameters: &Parameters<T>,
        bound: T,
    ) -> bool {
        let (rows, size, early) = (runs.rows(), self.pair, LATE + 1);
        let grid = &self.grid;
        let blocks = Blocks::new(rows + early, size);
        let beyond = &mut self.beyond[..blocks.count()];
        let planes = grid.planes::<T, Q>(&mut self.values);
        let slabs = Slab { planes, pitch: grid.stride(1), lead: 1 - early as isize };
        let (covered, mut met) = cells.for_collisions();
        met.lead = -(early as isize);
        blocks.for_each((slabs, met, PerBlock(beyond)), |block, (slab, mut met, beyond)| {
            let range = blocks.range(block);
            let first = range.start.saturating_sub(early);
            let start = if block == 0 { 0 } else { grid.row_start(first) };
            let mut window = Window { planes: slab.planes, start };
            beyond.0[0] = false;
            for row in first..range.end - early {
                let [_, _, inner] = rows_of_slab(rows, size, row / size);
                if !inner.contains(&row) {
                    let (from, cells) = ((grid, Layout::Turned), Row { row, runs, covered, field });
                    beyond.0[0] |= window.collide::<L, P>(from, cells, &mut met, (parameters, bound));
                }
            }
        });
        self.beyond[..blocks.count()].contains(&true)
    }
}
