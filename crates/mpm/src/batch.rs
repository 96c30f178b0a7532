//! Particles in batches: what they share with nodes is found side by side, in wide registers; then each of them reads or
//! writes its nodes, whose numbers fill a register.
//!
//! Particles are computed one by one in the order of memory; neither the width of registers nor where a batch begins changes a
//! bit.

use crate::layout::{Node, TileShape, block_side};
use crate::shape::{REACH, Shape};
use granular_core::{Dim, Vector};
use multiversion::multiversion;

/// Particles of a batch: enough that loops are entered rarely, few enough for the nearest cache.
pub(crate) const BATCH: usize = 32;

/// Where a block lies, for its particles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner<D: Dim> {
    /// Its first node.
    pub(crate) at: D::Vec,
    /// One over the edge of a cell.
    pub(crate) per_cell: f64,
}

/// What particles share with nodes, and what they give or take.
pub(crate) struct Batch {
    /// The first node of each in the tile.
    first: [u32; BATCH],
    /// Values of shape functions along each axis, for each node.
    value: [[[f64; BATCH]; REACH]; 3],
    /// Derivatives by the place in cells.
    slope: [[[f64; BATCH]; REACH]; 3],
    /// What is given in proportion to values, and to derivatives along each axis; or the sums taken with them.
    pub(crate) rows: [[Node; BATCH]; 4],
}

impl Batch {
    pub(crate) fn new() -> Self {
        Self {
            first: [0; BATCH],
            value: [[[0.0; BATCH]; REACH]; 3],
            slope: [[[0.0; BATCH]; REACH]; 3],
            rows: [[Node::ZERO; BATCH]; 4],
        }
    }

    /// Finds the nodes of particles and what they share with them.
    #[inline(always)]
    fn place<D: Dim, S: Shape>(
        &mut self,
        tile: &TileShape,
        corner: &Corner<D>,
        position: &[D::Vec],
        width: &[f64],
    ) {
        let count = position.len().min(BATCH);
        let position = &position[..count];
        let bounds = bounds::<D, S>();
        let (mut stride, below) = (1_i32, tile.below as i32);
        for axis in 0..D::N {
            let from = corner.at.component(axis);
            for k in 0..count {
                let width = if S::HAS_WIDTH { width[k] } else { 1.0 };
                let shares = S::shares((position[k].component(axis) - from) * corner.per_cell, width, bounds);
                let along = (shares.first as i32 + below) * stride;
                self.first[k] = if axis == 0 { along as u32 } else { self.first[k] + along as u32 };
                for node in 0..S::NODES {
                    self.value[axis][node][k] = shares.value[node];
                    self.slope[axis][node][k] = shares.slope[node];
                }
            }
            stride *= tile.side as i32;
        }
    }
}

/// The nodes at which particles may begin, counted from the first node of their block.
#[inline(always)]
fn bounds<D: Dim, S: Shape>() -> (f64, f64) {
    (-(S::NODES as f64 - 1.0), block_side::<D>() as f64)
}

/// Adds what the rows of particles give to their nodes.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn give<D: Dim, S: Shape>(
    batch: &mut Batch,
    tile: &TileShape,
    corner: &Corner<D>,
    (position, width): (&[D::Vec], &[f64]),
    nodes: &mut [Node],
) {
    batch.place::<D, S>(tile, corner, position, width);
    let count = position.len().min(BATCH);
    for k in 0..count {
        let first = batch.first[k] as usize;
        let rows = [0, 1, 2, 3].map(|row: usize| batch.rows[row][k]);
        if D::N == 2 {
            give_plane::<S>(batch, k, [rows[0], rows[1], rows[2]], tile.side, &mut nodes[first..]);
        } else {
            let plane = tile.side * tile.side;
            for z in 0..S::NODES {
                let (value, slope) = (batch.value[2][z][k], batch.slope[2][z][k]);
                let mut sum = rows[0].scaled(value);
                sum.add_scaled(&rows[3], slope);
                let layer = [sum, rows[1].scaled(value), rows[2].scaled(value)];
                give_plane::<S>(batch, k, layer, tile.side, &mut nodes[first + z * plane..]);
            }
        }
    }
}

#[inline(always)]
fn give_plane<S: Shape>(batch: &Batch, k: usize, rows: [Node; 3], side: usize, nodes: &mut [Node]) {
    for y in 0..S::NODES {
        let (value, slope) = (batch.value[1][y][k], batch.slope[1][y][k]);
        let mut even = rows[0].scaled(value);
        even.add_scaled(&rows[2], slope);
        let along = rows[1].scaled(value);
        let line = &mut nodes[y * side..y * side + S::NODES];
        for (x, node) in line.iter_mut().enumerate() {
            node.add_scaled(&even, batch.value[0][x][k]);
            node.add_scaled(&along, batch.slope[0][x][k]);
        }
    }
}

/// Sums what nodes hold over the nodes of particles, with values and with derivatives along each axis, into rows.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn take<D: Dim, S: Shape>(
    batch: &mut Batch,
    tile: &TileShape,
    corner: &Corner<D>,
    (position, width): (&[D::Vec], &[f64]),
    nodes: &[Node],
) {
    batch.place::<D, S>(tile, corner, position, width);
    let count = position.len().min(BATCH);
    for k in 0..count {
        let first = batch.first[k] as usize;
        if D::N == 2 {
            let [value, x, y] = take_plane::<S>(batch, k, tile.side, &nodes[first..]);
            (batch.rows[0][k], batch.rows[1][k], batch.rows[2][k]) = (value, x, y);
        } else {
            let plane = tile.side * tile.side;
            let mut sums = [Node::ZERO; 4];
            for z in 0..S::NODES {
                let layer = take_plane::<S>(batch, k, tile.side, &nodes[first + z * plane..]);
                let (value, slope) = (batch.value[2][z][k], batch.slope[2][z][k]);
                sums[0].add_scaled(&layer[0], value);
                sums[1].add_scaled(&layer[1], value);
                sums[2].add_scaled(&layer[2], value);
                sums[3].add_scaled(&layer[0], slope);
            }
            for (rows, sum) in batch.rows.iter_mut().zip(sums) {
                rows[k] = sum;
            }
        }
    }
}

#[inline(always)]
fn take_plane<S: Shape>(batch: &Batch, k: usize, side: usize, nodes: &[Node]) -> [Node; 3] {
    let mut sums = [Node::ZERO; 3];
    for y in 0..S::NODES {
        let line = &nodes[y * side..y * side + S::NODES];
        let (mut even, mut along) = (Node::ZERO, Node::ZERO);
        for (x, node) in line.iter().enumerate() {
            even.add_scaled(node, batch.value[0][x][k]);
            along.add_scaled(node, batch.slope[0][x][k]);
        }
        let (value, slope) = (batch.value[1][y][k], batch.slope[1][y][k]);
        sums[0].add_scaled(&even, value);
        sums[1].add_scaled(&along, value);
        sums[2].add_scaled(&even, slope);
    }
    sums
}
