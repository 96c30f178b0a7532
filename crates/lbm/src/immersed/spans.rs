//! Rows of the lattice and the grains that cover cells of them.

use crate::immersed::cells::{Cells, Piece};
use crate::immersed::tile::Tile;
use crate::populations::{Grid, Runs};
use crate::real::Real;

/// Cells of a row that a grain covers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Span {
    pub(super) grain: u32,
    /// The first cell of the row, and how many there are.
    pub(super) x: u32,
    pub(super) count: u32,
    /// Index of the first share in the tile of the grain.
    pub(super) share: u32,
    /// Index of the first cell among all covered ones.
    pub(super) at: u32,
    /// Number among all spans, grain by grain.
    number: u32,
    /// The first cell where the grain is, from which it may lie periods away.
    pub(super) cell: [i64; 3],
}

/// Spans by row, and the order in which grains find theirs.
#[derive(Clone, Debug, Default)]
pub(super) struct Spans {
    /// First span of each row, and the end of the last row.
    starts: Vec<usize>,
    spans: Vec<Span>,
    /// First span of each grain, and the end of the last grain.
    grain_starts: Vec<usize>,
    /// Index of a span by its number.
    by_number: Vec<u32>,
}

/// The lattice that spans are cut to.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    pub(super) cells: [usize; 3],
    pub(super) is_periodic: [bool; 3],
}

impl Bounds {
    /// The coordinate in the domain, if there is one.
    fn within(&self, axis: usize, at: i64) -> Option<usize> {
        let cells = self.cells[axis] as i64;
        let wrapped = if self.is_periodic[axis] { at.rem_euclid(cells) } else { at };
        (0..cells).contains(&wrapped).then_some(wrapped as usize)
    }

    /// Passes on the spans of a grain with their rows, cut where they leave the domain or a period ends.
    fn each_span(&self, grain: u32, tile: &Tile, grid: &Grid, mut take: impl FnMut(usize, Span)) {
        for stretch in tile.stretches() {
            let (Some(y), Some(z)) = (self.within(1, stretch.cell[1]), self.within(2, stretch.cell[2]))
            else {
                continue;
            };
            let row = grid.row_of(y, z);
            let mut done = 0;
            while done < stretch.count {
                let from = stretch.cell[0] + done as i64;
                let to_edge = (self.cells[0] as i64 - from.rem_euclid(self.cells[0] as i64)) as usize;
                let count = to_edge.min(stretch.count - done);
                if let Some(x) = self.within(0, from) {
                    let cell = [from, stretch.cell[1], stretch.cell[2]];
                    let [x, count, share] = [x, count, stretch.at + done].map(|at| at as u32);
                    take(row, Span { grain, x, count, share, cell, at: 0, number: 0 });
                }
                done += count;
            }
        }
    }
}

impl Spans {
    /// Sorts the spans of all grains by rows, and by cells and grains within them.
    pub(super) fn sort(&mut self, tiles: &[Tile], rows: usize, bounds: Bounds, grid: &Grid) {
        let each = |take: &mut dyn FnMut(usize, Span)| {
            for (grain, tile) in (0..).zip(tiles) {
                bounds.each_span(grain, tile, grid, &mut *take);
            }
        };
        self.starts.clear();
        self.starts.resize(rows + 1, 0);
        self.grain_starts.clear();
        self.grain_starts.resize(tiles.len() + 1, 0);
        each(&mut |row, span| {
            self.starts[row] += 1;
            self.grain_starts[span.grain as usize + 1] += 1;
        });
        for grain in 0..tiles.len() {
            self.grain_starts[grain + 1] += self.grain_starts[grain];
        }
        let mut before = 0;
        for start in &mut self.starts {
            (*start, before) = (before, before + *start);
        }
        self.spans.clear();
        self.spans.resize(before, Span::default());
        let mut number = 0;
        each(&mut |row, span| {
            self.spans[self.starts[row]] = Span { number, ..span };
            self.starts[row] += 1;
            number += 1;
        });
        // Each start has become the next one.
        self.starts.copy_within(..rows, 1);
        self.starts[0] = 0;
        for row in 0..rows {
            self.spans[self.starts[row]..self.starts[row + 1]]
                .sort_unstable_by_key(|span| (span.x, span.number));
        }
    }

    /// Finds the runs of covered cells in each row, gives each cell a place, and leaves the rest of the fluid to `free`.
    pub(super) fn lay_out<T: Real>(&mut self, cells: &mut Cells<T>, fluid: &Runs, free: &mut Runs) {
        let rows = self.starts.len() - 1;
        cells.starts.clear();
        cells.piece_starts.clear();
        cells.pieces.clear();
        free.clear();
        let mut at = 0;
        for row in 0..rows {
            cells.starts.push(at as usize);
            cells.piece_starts.push(cells.pieces.len());
            let mut open: Option<Piece> = None;
            let mut left = fluid.of_row(row).iter().copied().peekable();
            for span in &mut self.spans[self.starts[row]..self.starts[row + 1]] {
                let end = span.x + span.count;
                let piece = match &mut open {
                    Some(piece) if span.x <= piece.to => {
                        at += end.saturating_sub(piece.to);
                        piece.to = piece.to.max(end);
                        piece
                    }
                    _ => {
                        if let Some(piece) = open {
                            cut(piece, &mut left, &mut cells.pieces, free);
                        }
                        let piece = open.insert(Piece { from: span.x, to: end, at });
                        at += span.count;
                        piece
                    }
                };
                span.at = piece.at + span.x - piece.from;
            }
            if let Some(piece) = open {
                cut(piece, &mut left, &mut cells.pieces, free);
            }
            left.for_each(|run| free.push(run));
            free.end_row();
        }
        cells.starts.push(at as usize);
        cells.piece_starts.push(cells.pieces.len());
        self.by_number.clear();
        self.by_number.resize(self.spans.len(), 0);
        for (index, span) in (0..).zip(&self.spans) {
            self.by_number[span.number as usize] = index;
        }
    }

    pub(super) fn of_row(&self, row: usize) -> &[Span] {
        &self.spans[self.starts[row]..self.starts[row + 1]]
    }

    /// Spans of a grain, in the order of its rows.
    pub(super) fn of_grain(&self, grain: usize) -> impl Iterator<Item = &Span> {
        let numbers = self.grain_starts[grain]..self.grain_starts[grain + 1];
        self.by_number[numbers].iter().map(|index| &self.spans[*index as usize])
    }

    pub(super) fn bytes(&self) -> usize {
        size_of::<usize>() * (self.starts.capacity() + self.grain_starts.capacity())
            + size_of::<Span>() * self.spans.capacity()
            + 4 * self.by_number.capacity()
    }
}

/// Splits runs of fluid into those that a run of covered cells overlaps, which become pieces, and those before it.
fn cut(
    covered: Piece,
    left: &mut std::iter::Peekable<impl Iterator<Item = [u32; 2]>>,
    pieces: &mut Vec<Piece>,
    free: &mut Runs,
) {
    while let Some([from, to]) = left.peek_mut() {
        if *from < covered.from {
            free.push([*from, (*to).min(covered.from)]);
        }
        let (start, end) = ((*from).max(covered.from), (*to).min(covered.to));
        if start < end {
            pieces.push(Piece { from: start, to: end, at: covered.at + start - covered.from });
        }
        if *to > covered.to {
            *from = (*from).max(covered.to);
            return;
        }
        left.next();
    }
}
