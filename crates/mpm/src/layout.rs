//! How space is cut into cells, blocks of cells, and tiles of nodes around blocks.
//!
//! A block is `side` cells along each axis and owns as many nodes, those at the lower corners of its cells. A tile holds all nodes
//! that particles of a block can reach, also after they have left it by one cell along any axis.

use granular_core::{Dim, Vector};

/// Coordinates of a block; those beyond the number of axes are zero.
pub(crate) type BlockAt = [i32; 3];

/// Cells that particles may leave their block by before they are sorted again.
const MARGIN: usize = 1;

/// What a node holds; a row of a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Node(pub(crate) [f64; 8]);

impl Node {
    pub(crate) const ZERO: Self = Self([0.0; 8]);

    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        for lane in 0..8 {
            self.0[lane] += other.0[lane];
        }
    }

    /// Adds a multiple.
    #[inline(always)]
    pub(crate) fn add_scaled(&mut self, other: &Self, scale: f64) {
        for lane in 0..8 {
            self.0[lane] += other.0[lane] * scale;
        }
    }

    #[inline(always)]
    pub(crate) fn scaled(&self, scale: f64) -> Self {
        let mut scaled = *self;
        for lane in 0..8 {
            scaled.0[lane] *= scale;
        }
        scaled
    }
}

/// Cells of a block along an axis.
#[inline(always)]
pub(crate) const fn block_side<D: Dim>() -> usize {
    if D::N == 2 { 8 } else { 4 }
}

/// Cells of a block, and nodes that it owns.
#[inline(always)]
pub(crate) const fn block_cells<D: Dim>() -> usize {
    block_side::<D>().pow(D::N as u32)
}

/// Blocks that touch a block, itself included.
#[inline(always)]
pub(crate) const fn neighbours<D: Dim>() -> usize {
    3_usize.pow(D::N as u32)
}

/// Neighbour `k` of a block, as steps along the axes.
pub(crate) fn offset_of<D: Dim>(k: usize) -> [i32; 3] {
    let along = |axis: usize| (k / 3_usize.pow(axis as u32) % 3) as i32 - 1;
    std::array::from_fn(|axis| if axis < D::N { along(axis) } else { 0 })
}

/// Where the grid lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice<D: Dim> {
    /// A node.
    pub(crate) origin: D::Vec,
    /// Edge of a cell.
    pub(crate) cell: f64,
}

impl<D: Dim> Lattice<D> {
    /// The block that holds a place, and the cell within it. Places beyond 2^31 cells count as at the last of them.
    #[inline(always)]
    pub(crate) fn find(&self, position: D::Vec) -> (BlockAt, usize) {
        let side = block_side::<D>() as i32;
        let (mut block, mut cell, mut stride) = ([0; 3], 0, 1);
        for (axis, along) in block.iter_mut().enumerate().take(D::N) {
            let at = ((position.component(axis) - self.origin.component(axis)) / self.cell).floor() as i32;
            *along = at.div_euclid(side);
            cell += at.rem_euclid(side) as usize * stride;
            stride *= side as usize;
        }
        (block, cell)
    }

    /// The first node of a block.
    pub(crate) fn corner(&self, block: BlockAt) -> D::Vec {
        let length = self.cell * block_side::<D>() as f64;
        let mut corner = self.origin;
        for (axis, &along) in block.iter().enumerate().take(D::N) {
            corner += D::Vec::along(axis, f64::from(along) * length);
        }
        corner
    }

    /// The first node of a block, in cells from the origin.
    pub(crate) fn in_cells(&self, block: BlockAt) -> D::Vec {
        D::Vec::from_fn(|axis| f64::from(block[axis]) * block_side::<D>() as f64)
    }

    /// A node of a block.
    pub(crate) fn node(&self, block: BlockAt, local: usize) -> D::Vec {
        let side = block_side::<D>();
        let mut at = self.corner(block);
        for axis in 0..D::N {
            let along = local / side.pow(axis as u32) % side;
            at += D::Vec::along(axis, along as f64 * self.cell);
        }
        at
    }
}

/// A row of nodes along x that a tile and a neighbour of its block share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// The first one among those that the neighbour owns.
    pub(crate) owned: usize,
    /// The first one in the tile.
    pub(crate) tile: usize,
    pub(crate) len: usize,
}

/// The extent of tiles.
#[derive(Clone, Debug)]
pub(crate) struct TileShape {
    /// Nodes along an axis.
    pub(crate) side: usize,
    /// Nodes below the first node of the block.
    pub(crate) below: usize,
    /// Nodes of a tile.
    pub(crate) nodes: usize,
    /// What a tile shares with each neighbour of its block.
    runs: Vec<Vec<Run>>,
}

impl TileShape {
    /// For particles that reach `reach` nodes along each axis: those of their cell, and with three one beside.
    pub(crate) fn new<D: Dim>(reach: usize) -> Self {
        let beside = reach - 2;
        let side = block_side::<D>() + 1 + 2 * (MARGIN + beside);
        let mut shape = Self { side, below: MARGIN + beside, nodes: side.pow(D::N as u32), runs: Vec::new() };
        shape.runs = (0..neighbours::<D>()).map(|k| shape.runs_of::<D>(offset_of::<D>(k))).collect();
        shape
    }

    fn runs_of<D: Dim>(&self, offset: [i32; 3]) -> Vec<Run> {
        let (side, tile_side, below) = (block_side::<D>() as i32, self.side as i32, self.below as i32);
        // Nodes of the neighbour along each axis that are in the tile, and what takes their number to that of the tile.
        let range = |axis: usize| {
            let shift = offset[axis] * side + below;
            ((-shift).max(0)..(tile_side - shift).min(side), shift)
        };
        let ranges = [0, 1, 2].map(|axis| if axis < D::N { range(axis) } else { (0..1, 0) });
        let [(xs, x_shift), (ys, y_shift), (zs, z_shift)] = ranges;
        let mut runs = Vec::new();
        for z in zs {
            for y in ys.clone() {
                let owned = (xs.start + side * (y + side * z)) as usize;
                let tile = xs.start + x_shift + tile_side * (y + y_shift + tile_side * (z + z_shift));
                runs.push(Run { owned, tile: tile as usize, len: xs.len() });
            }
        }
        runs
    }

    /// What a tile shares with neighbour `k` of its block.
    pub(crate) fn shared_with(&self, k: usize) -> &[Run] {
        &self.runs[k]
    }
}

/// Share of a cell by which the fastest particle may have moved before all are sorted again; less than the margin by far more
/// than round-off.
pub(crate) const LONGEST_TRAVEL: f64 = 0.9 * MARGIN as f64;

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::{D2, D3};

    fn every_node_of_a_tile_belongs_to_one_block<D: Dim>() {
        for reach in [2, 3] {
            let shape = TileShape::new::<D>(reach);
            let mut owners = vec![0; shape.nodes];
            for k in 0..neighbours::<D>() {
                for run in shape.shared_with(k) {
                    owners[run.tile..run.tile + run.len].iter_mut().for_each(|owner| *owner += 1);
                }
            }
            assert!(owners.iter().all(|&owner| owner == 1), "reach {reach}");
        }
    }

    #[test]
    fn tiles_are_covered_once() {
        every_node_of_a_tile_belongs_to_one_block::<D2>();
        every_node_of_a_tile_belongs_to_one_block::<D3>();
    }

    #[test]
    fn places_are_found_in_blocks_below_the_origin_too() {
        use granular_core::glam::DVec2;
        let lattice = Lattice::<D2> { origin: DVec2::new(0.5, 0.0), cell: 0.1 };
        assert_eq!(lattice.find(DVec2::new(0.56, 0.01)), ([0, 0, 0], 0));
        assert_eq!(lattice.find(DVec2::new(0.46, 0.11)), ([-1, 0, 0], 7 + 8));
        assert!((lattice.node([-1, 0, 0], 7 + 8) - DVec2::new(0.4, 0.1)).length() < 1e-15);
    }
}
