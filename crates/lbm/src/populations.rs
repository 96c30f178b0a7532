//! Populations of all cells, one lattice updated in place.
//!
//! Each direction has a plane of its own; rows of cells along x are padded to whole cache lines, and
//! planes are set apart so that the same cell of different planes does not share a cache set. A ring of
//! cells around the domain belongs to nobody: boundaries write what enters from there.
//!
//! Steps alternate between two layouts (the pattern of \[Bailey2009\]). In the natural layout the
//! population that enters a cell along `i` lies in plane `i` of the cell. A step from there reads and writes one cell at a
//! time and leaves what goes out along `i` in the plane against `i`: the turned layout, where what enters a cell along `i` lies
//! in the plane against `i` of the cell behind. A step from there reads from and writes to neighbours and
//! restores the natural layout.

use crate::body_force::ForceField;
use crate::collision::{Parameters, Parts};
use crate::immersed::{Cells, CoveredRows, Met};
use crate::lattice::{Lattice, opposite};
use crate::pages::Pages;
use crate::pair::slab_rows;
use crate::real::Real;
use crate::rows::Spot;
use granular_core::blocks::{Blocks, Divide, PerBlock};
use std::ops::Range;

/// Where populations lie between steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    Natural,
    Turned,
}

/// Sizes and strides of the planes.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub(crate) cells: [usize; 3],
    pitch: usize,
    plane: usize,
    /// Place of the first cell in a plane.
    origin: usize,
    strides: [usize; 3],
}

impl Grid {
    pub(crate) fn new<T: Real>(cells: [usize; 3], has_depth: bool) -> Self {
        let [nx, ny, nz] = cells;
        let pitch = (nx + 1).next_multiple_of(T::LINE) + T::LINE;
        let (layers, first_layer) = if has_depth { (nz + 2, 1) } else { (1, 0) };
        let rows = (ny + 2) * layers;
        let strides = [1, pitch, pitch * (ny + 2)];
        // An odd number of lines between planes.
        let plane = (rows * pitch / (2 * T::LINE) * 2 + 7) * T::LINE;
        let origin = T::LINE + pitch + first_layer * strides[2];
        Self { cells, pitch, plane, origin, strides }
    }

    /// Place of a cell in a plane; coordinates may lie one beyond the domain.
    pub(crate) fn place(&self, cell: [i64; 3]) -> usize {
        let offset: i64 = (0..3).map(|axis| cell[axis] * self.strides[axis] as i64).sum();
        (self.origin as i64 + offset) as usize
    }

    /// Numbers in all planes of a lattice.
    pub(crate) fn len<const Q: usize>(&self) -> usize {
        Q * self.plane
    }

    fn shift<L: Lattice<Q>, const Q: usize>(&self, i: usize) -> isize {
        (0..3).map(|axis| L::VELOCITIES[i][axis] as isize * self.strides[axis] as isize).sum()
    }

    /// Where the population lies that enters the cell at `place` along `i` in the next step.
    #[inline]
    pub(crate) fn entering<L: Lattice<Q>, const Q: usize>(
        &self,
        layout: Layout,
        place: usize,
        i: usize,
    ) -> usize {
        match layout {
            Layout::Natural => i * self.plane + place,
            Layout::Turned => (opposite(i) * self.plane + place).wrapping_add_signed(-self.shift::<L, Q>(i)),
        }
    }

    /// Where the population lies that left the cell at `place` along `i` in the last step.
    #[inline]
    pub(crate) fn leaving<L: Lattice<Q>, const Q: usize>(
        &self,
        layout: Layout,
        place: usize,
        i: usize,
    ) -> usize {
        match layout {
            Layout::Natural => (i * self.plane + place).wrapping_add_signed(self.shift::<L, Q>(i)),
            Layout::Turned => opposite(i) * self.plane + place,
        }
    }

    /// Distance of neighbours along an axis.
    pub(crate) fn stride(&self, axis: usize) -> usize {
        self.strides[axis]
    }

    /// Plane and place in it of an index.
    pub(crate) fn spot(&self, index: usize) -> Spot {
        Spot { plane: (index / self.plane) as u8, place: (index % self.plane) as u32 }
    }

    /// Place of the first cell of a row in the plane.
    pub(crate) fn row_place(&self, row: usize) -> usize {
        self.origin + row * self.pitch
    }

    /// Place where a row in the plane begins, padding included.
    pub(crate) fn row_start(&self, row: usize) -> usize {
        (row + 1) * self.pitch
    }

    /// Row in the plane of the cell whose population a natural index names.
    pub(crate) fn row_at(&self, natural: u32) -> usize {
        natural as usize % self.plane / self.pitch - 1
    }

    /// All planes.
    pub(crate) fn planes<'a, T, const Q: usize>(&self, values: &'a mut [T]) -> [&'a mut [T]; Q] {
        values.chunks_exact_mut(self.plane).collect_array()
    }

    /// Index of the row of a cell among the rows from the first of the domain on.
    pub(crate) fn row_of(&self, y: usize, z: usize) -> usize {
        z * (self.cells[1] + 2) + y
    }
}

/// Runs of fluid cells in rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Runs {
    /// First run of each row, and the end of the last row.
    starts: Vec<u32>,
    runs: Vec<[u32; 2]>,
}

impl Runs {
    /// From a predicate on cells.
    pub(crate) fn of(grid: &Grid, is_fluid: impl Fn([usize; 3]) -> bool) -> Self {
        let [nx, ny, nz] = grid.cells;
        let rows = grid.row_of(ny - 1, nz - 1) + 1;
        let mut found = Self { starts: vec![0], runs: Vec::new() };
        for row in 0..rows {
            let (y, z) = (row % (ny + 2), row / (ny + 2));
            if y < ny {
                found.add_row(nx, |x| is_fluid([x, y, z]));
            }
            found.starts.push(found.runs.len() as u32);
        }
        found
    }

    /// Finds the runs of the rows of a box of cells again.
    pub(crate) fn refresh(
        &mut self,
        grid: &Grid,
        range: [[usize; 3]; 2],
        is_fluid: impl Fn([usize; 3]) -> bool,
    ) {
        let [low, high] = range;
        let layer = grid.cells[1] + 2;
        let mut fresh =
            Self { starts: Vec::with_capacity(self.starts.len()), runs: Vec::with_capacity(self.runs.len()) };
        fresh.starts.push(0);
        for row in 0..self.rows() {
            let (y, z) = (row % layer, row / layer);
            if (low[1]..high[1]).contains(&y) && (low[2]..high[2]).contains(&z) {
                fresh.add_row(grid.cells[0], |x| is_fluid([x, y, z]));
            } else {
                fresh.runs.extend(self.of_row(row));
            }
            fresh.starts.push(fresh.runs.len() as u32);
        }
        *self = fresh;
    }

    fn add_row(&mut self, cells: usize, is_fluid: impl Fn(usize) -> bool) {
        let mut x = 0;
        while x < cells {
            let start = x;
            while x < cells && is_fluid(x) {
                x += 1;
            }
            if x > start {
                self.runs.push([start as u32, x as u32]);
            }
            x += 1;
        }
    }

    /// Of no row yet, to be built row by row.
    pub(crate) fn clear(&mut self) {
        self.starts.clear();
        self.starts.push(0);
        self.runs.clear();
    }

    /// Adds a run to the row that is being built.
    pub(crate) fn push(&mut self, run: [u32; 2]) {
        self.runs.push(run);
    }

    /// Ends the row that is being built.
    pub(crate) fn end_row(&mut self) {
        self.starts.push(self.runs.len() as u32);
    }

    pub(crate) fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    pub(crate) fn of_row(&self, row: usize) -> &[[u32; 2]] {
        &self.runs[self.starts[row] as usize..self.starts[row + 1] as usize]
    }

    pub(crate) fn bytes(&self) -> usize {
        4 * self.starts.capacity() + 8 * self.runs.capacity()
    }
}

/// Parts of the planes, one per direction, from which a slab of rows reads and to which it writes. Slabs never share any.
pub(crate) struct Slab<'a, T, const Q: usize> {
    pub(crate) planes: [&'a mut [T]; Q],
    pub(crate) pitch: usize,
    /// Rows that the planes have before the first row of the first block.
    pub(crate) lead: isize,
}

impl<T: Send, const Q: usize> Divide for Slab<'_, T, Q> {
    fn divide(self, blocks: usize, size: usize) -> (Self, Self) {
        let at = (blocks * size).saturating_add_signed(self.lead) * self.pitch;
        let mut rest: [Option<&mut [T]>; Q] = std::array::from_fn(|_| None);
        let mut rests = rest.iter_mut();
        let first = self.planes.map(|plane| {
            let (first, second) = plane.split_at_mut(at.min(plane.len()));
            *rests.next().expect("one per direction") = Some(second);
            first
        });
        let second = rest.map(|plane| plane.expect("one per direction"));
        (Self { planes: first, ..self }, Self { planes: second, pitch: self.pitch, lead: 0 })
    }
}

/// Populations of all cells, without their weights.
#[derive(Debug)]
pub(crate) struct Populations<T> {
    pub(crate) grid: Grid,
    pub(crate) layout: Layout,
    pub(crate) values: Pages<T>,
    /// Rows of a slab.
    slab: usize,
    /// Rows of a slab that takes two steps together.
    pub(crate) pair: usize,
    /// Per slab: a population at rest beyond what the scheme can mean.
    pub(crate) beyond: Vec<bool>,
}

impl<T: Real> Populations<T> {
    pub(crate) fn new<const Q: usize>(grid: Grid, runs: &Runs) -> Self {
        let values = Pages::zeroed(grid.len::<Q>());
        // About 64 slabs, so that threads find work, of 16 rows at least.
        let blocks = Blocks::about(runs.rows(), 64, 16);
        // Rows that take the second of two steps later may need one block more.
        let beyond = vec![false; blocks.count() + 1];
        // Longer ones for two steps together: their ends are read twice.
        let pair = slab_rows(runs.rows(), Blocks::about(runs.rows(), 16, 64).size());
        Self { grid, layout: Layout::Natural, values, slab: blocks.size(), pair, beyond }
    }

    /// The slabs of rows that a step is cut into.
    pub(crate) fn slabs(&self, runs: &Runs) -> Blocks {
        Blocks::new(runs.rows(), self.slab)
    }

    /// Collides and moves all fluid cells. Returns whether any population at rest is not finite or larger than `bound`.
    pub(crate) fn step<L: Lattice<Q>, P: Parts, const Q: usize>(
        &mut self,
        (runs, cells): (&Runs, &mut Cells<T>),
        field: &ForceField<T>,
        parameters: &Parameters<T>,
        bound: T,
    ) -> bool {
        let (covered, met) = cells.for_collisions();
        let layout = self.layout;
        let pitch = self.grid.pitch;
        let starts: [usize; Q] =
            std::array::from_fn(|i| self.grid.entering::<L, Q>(layout, self.grid.origin, i));
        let plane = self.grid.plane;
        let length = (runs.rows() - 1) * pitch + self.grid.cells[0];
        let mut by_plane = self.values.chunks_exact_mut(plane).map(Some).collect_array::<Q>();
        let planes = starts.map(|start| {
            let values = by_plane[start / plane].take().expect("each direction has a plane of its own");
            &mut values[start % plane..start % plane + length]
        });
        let work = (Slab { planes, pitch, lead: 0 }, met, PerBlock(&mut self.beyond));
        Blocks::new(runs.rows(), self.slab).for_each(work, |block, (mut slab, mut met, beyond)| {
            let mut worst = false;
            let first = block * self.slab;
            for row in first..(first + self.slab).min(runs.rows()) {
                let starts = [(row - first) * pitch; Q];
                let cells = Row { row, runs, covered, field };
                worst |=
                    collide_runs::<L, T, P, Q>(&mut slab.planes, starts, cells, &mut met, parameters, bound);
            }
            beyond.0[0] = worst;
        });
        self.layout = match layout {
            Layout::Natural => Layout::Turned,
            Layout::Turned => Layout::Natural,
        };
        self.beyond[..Blocks::new(runs.rows(), self.slab).count()].contains(&true)
    }

    /// Populations that enter a cell in the next step.
    #[inline]
    pub(crate) fn entering<L: Lattice<Q>, const Q: usize>(&self, place: usize) -> [T; Q] {
        std::array::from_fn(|i| self.values[self.grid.entering::<L, Q>(self.layout, place, i)])
    }

    /// Sets the populations that enter a cell in the next step.
    pub(crate) fn set_entering<L: Lattice<Q>, const Q: usize>(&mut self, place: usize, populations: [T; Q]) {
        for (i, value) in populations.into_iter().enumerate() {
            let at = self.grid.entering::<L, Q>(self.layout, place, i);
            self.values[at] = value;
        }
    }
}

/// A row of cells, where fluid is alone and with grains, and the force there if it varies in space.
#[derive(Clone, Copy)]
pub(crate) struct Row<'a, T> {
    pub(crate) row: usize,
    pub(crate) runs: &'a Runs,
    pub(crate) covered: CoveredRows<'a, T>,
    pub(crate) field: &'a ForceField<T>,
}

/// Collides the runs of a row that begins at `starts` in the planes of the directions. Returns whether a population at
/// rest is not finite or larger than `bound`.
#[inline]
pub(crate) fn collide_runs<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>(
    planes: &mut [&mut [T]; Q],
    starts: [usize; Q],
    cells: Row<'_, T>,
    met: &mut Met<'_, T>,
    parameters: &Parameters<T>,
    bound: T,
) -> bool {
    let mut worst = false;
    for &piece in cells.covered.of_row(cells.row) {
        let range = piece.from as usize..piece.to as usize;
        let field = if P::FIELD { cells.field.of_row(cells.row, range.clone()) } else { [&[] as &[T]; 3] };
        let mut rows = rows_of(planes, starts, range);
        let with = cells.covered.of_piece(piece, met);
        L::collide_covered::<T, P>(rows.each_mut().map(|row| &mut **row), with, field, parameters);
        worst |= is_beyond(rows[0], bound);
    }
    for &[a, b] in cells.runs.of_row(cells.row) {
        let range = a as usize..b as usize;
        let field = if P::FIELD { cells.field.of_row(cells.row, range.clone()) } else { [&[] as &[T]; 3] };
        let mut rows = rows_of(planes, starts, range);
        L::collide_row::<T, P>(rows.each_mut().map(|row| &mut **row), field, parameters);
        worst |= is_beyond(rows[0], bound);
    }
    worst
}

/// Cells of a row that begins at `starts` in the planes of the directions.
#[inline]
fn rows_of<'a, T, const Q: usize>(
    planes: &'a mut [&mut [T]; Q],
    starts: [usize; Q],
    range: Range<usize>,
) -> [&'a mut [T]; Q] {
    let mut planes = planes.iter_mut().zip(starts);
    std::array::from_fn(|_| {
        let (plane, start) = planes.next().expect("one per direction");
        &mut plane[start + range.start..start + range.end]
    })
}

/// Whether any value is not finite or larger than `bound`.
#[inline]
fn is_beyond<T: Real>(values: &[T], bound: T) -> bool {
    // Not a number fails the comparison.
    values.iter().fold(false, |beyond, &value| beyond | !(value < bound && -value < bound))
}

/// Collects exactly `Q` items.
trait CollectArray: Iterator + Sized {
    fn collect_array<const Q: usize>(mut self) -> [Self::Item; Q] {
        std::array::from_fn(|_| self.next().expect("as many planes as directions"))
    }
}

impl<I: Iterator> CollectArray for I {}
