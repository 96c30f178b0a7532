//! What a collision needs of the cells that grains cover, and what it leaves for the loads.

use crate::real::Real;
use granular_core::blocks::Divide;
use std::ops::Range;

/// A run of covered cells of a row, and where its first cell is in the arrays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) from: u32,
    pub(crate) to: u32,
    pub(crate) at: u32,
}

/// Covered cells, row by row. Numbers are in lattice units.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells<T> {
    /// First cell of each row, and the end of the last row.
    pub(super) starts: Vec<usize>,
    /// First piece of each row, and the end of the last row.
    pub(super) piece_starts: Vec<usize>,
    pub(super) pieces: Vec<Piece>,
    /// Weight of a grain over the share that it covers.
    pub(super) per_share: Vec<T>,
    /// Weight of all grains.
    pub(super) weight: Vec<T>,
    /// Mean velocity of the grains.
    pub(super) velocity: [Vec<T>; 3],
    /// Momentum, with half of the force, and density that the last collision met.
    pub(super) momentum: [Vec<T>; 3],
    pub(super) density: Vec<T>,
}

impl<T: Real> Cells<T> {
    /// Makes room for the cells of all rows, in the plane or in space.
    pub(super) fn resize(&mut self, axes: usize) {
        let count = self.starts.last().copied().unwrap_or(0);
        self.per_share.resize(count, T::of(0.0));
        self.weight.resize(count, T::of(0.0));
        self.density.resize(count, T::of(0.0));
        for values in
            self.velocity.iter_mut().chain(&mut self.momentum).enumerate().filter(|(k, _)| k % 3 < axes)
        {
            values.1.resize(count, T::of(0.0));
        }
    }

    /// Takes weight from covered cells that are no fluid, since an obstacle covers them too: no piece has them.
    pub(super) fn leave_out_solids(&mut self) {
        let mut end = 0;
        for piece in &self.pieces {
            self.per_share[end..piece.at as usize].fill(T::of(0.0));
            end = (piece.at + piece.to - piece.from) as usize;
        }
        self.per_share[end..].fill(T::of(0.0));
    }

    /// What collisions read, and what they write, which is divided among blocks of rows.
    pub(crate) fn for_collisions(&mut self) -> (CoveredRows<'_, T>, Met<'_, T>) {
        let Self { starts, piece_starts, pieces, weight, velocity, momentum, density, .. } = self;
        let velocity = velocity.each_ref().map(Vec::as_slice);
        let momentum = momentum.each_mut().map(Vec::as_mut_slice);
        let met = Met { starts, row: 0, base: 0, lead: 0, momentum, density };
        (CoveredRows { piece_starts, pieces, weight, velocity }, met)
    }

    pub(super) fn bytes(&self) -> usize {
        let numbers = self.velocity.iter().chain(&self.momentum).map(Vec::capacity).sum::<usize>()
            + self.per_share.capacity()
            + self.weight.capacity()
            + self.density.capacity();
        numbers * size_of::<T>()
            + size_of::<usize>() * (self.starts.capacity() + self.piece_starts.capacity())
            + size_of::<Piece>() * self.pieces.capacity()
    }
}

/// What collisions met in the cells of some rows.
pub(crate) struct Met<'a, T> {
    starts: &'a [usize],
    /// The first row, and where its first cell is in the arrays of all rows.
    row: usize,
    base: usize,
    /// Rows that the first block has more than the others.
    pub(crate) lead: isize,
    momentum: [&'a mut [T]; 3],
    density: &'a mut [T],
}

/// What the collision of a piece reads and writes.
pub(crate) struct PieceCells<'a, T> {
    pub(crate) weight: &'a [T],
    pub(crate) velocity: [&'a [T]; 3],
    pub(crate) momentum: [&'a mut [T]; 3],
    pub(crate) density: &'a mut [T],
}

impl<T> PieceCells<'_, T> {
    /// The cells of a range.
    #[inline]
    pub(crate) fn part(&mut self, range: Range<usize>) -> PieceCells<'_, T> {
        PieceCells {
            weight: &self.weight[range.clone()],
            velocity: self.velocity.map(|values| part(values, range.clone())),
            momentum: self.momentum.each_mut().map(|values| values.get_mut(range.clone()).unwrap_or(&mut [])),
            density: &mut self.density[range],
        }
    }
}

/// The part of an array that has a number per cell; empty where it has none.
fn part<T>(values: &[T], range: Range<usize>) -> &[T] {
    values.get(range).unwrap_or(&[])
}

/// What collisions read of the covered cells of all rows.
#[derive(Clone, Copy)]
pub(crate) struct CoveredRows<'a, T> {
    piece_starts: &'a [usize],
    pieces: &'a [Piece],
    weight: &'a [T],
    velocity: [&'a [T]; 3],
}

impl<T: Real> CoveredRows<'_, T> {
    /// Runs of covered cells in a row.
    #[inline]
    pub(crate) fn of_row(&self, row: usize) -> &[Piece] {
        match self.piece_starts.get(row..row + 2) {
            Some(&[from, to]) => &self.pieces[from..to],
            _ => &[],
        }
    }

    /// What the collision of a piece reads and writes.
    pub(crate) fn of_piece<'b>(&'b self, piece: Piece, met: &'b mut Met<'_, T>) -> PieceCells<'b, T> {
        let range = piece.at as usize..(piece.at + piece.to - piece.from) as usize;
        let written = range.start - met.base..range.end - met.base;
        PieceCells {
            weight: &self.weight[range.clone()],
            velocity: self.velocity.map(|values| part(values, range.clone())),
            momentum: met
                .momentum
                .each_mut()
                .map(|values| values.get_mut(written.clone()).unwrap_or(&mut [])),
            density: &mut met.density[written],
        }
    }
}

impl<T: Send> Divide for Met<'_, T> {
    fn divide(self, blocks: usize, size: usize) -> (Self, Self) {
        let rows = self.starts.len().saturating_sub(1);
        let row = (self.row + (blocks * size).saturating_add_signed(self.lead)).min(rows);
        let base = self.starts.get(row).copied().unwrap_or(0);
        let at = base - self.base;
        let Self { starts, row: own_row, base: own_base, lead, momentum, density } = self;
        let [(x, next_x), (y, next_y), (z, next_z)] =
            momentum.map(|values| values.split_at_mut(at.min(values.len())));
        let (density, next) = density.split_at_mut(at);
        let first = Self { starts, row: own_row, base: own_base, lead, momentum: [x, y, z], density };
        (first, Self { starts, row, base, lead: 0, momentum: [next_x, next_y, next_z], density: next })
    }
}
