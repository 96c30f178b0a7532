//! The grid: without end, and there only where particles are.
//!
//! Particles of a block write to a tile of their own, so that no two threads write to one node; the nodes of each block then
//! collect what lies on them from the tiles around, in the order of neighbours. All sums so have the same order for any number of threads.

use crate::batch::Corner;
use crate::layout::{BlockAt, Lattice, Node, TileShape, block_cells, neighbours, offset_of};
use granular_core::{Blocks, Dim};

/// No block.
const NONE: u32 = u32::MAX;

/// Blocks of nodes, and what is on them.
#[derive(Clone, Debug)]
pub(crate) struct Grid<D: Dim> {
    pub(crate) lattice: Lattice<D>,
    tile_shape: TileShape,
    /// Blocks that hold particles, in order.
    homes: Vec<BlockAt>,
    /// Those and all around them, in order: the blocks whose nodes are there.
    blocks: Vec<BlockAt>,
    /// For each neighbour of each block its number among the homes; [`NONE`] where it is none.
    sources: Vec<u32>,
    /// For each neighbour of each home its number among the blocks.
    around: Vec<u32>,
    /// What particles gave: mass, momentum, force.
    pub(crate) sums: Vec<Node>,
    /// How nodes move: two vectors.
    pub(crate) motion: Vec<Node>,
    /// Changes whenever other nodes are there.
    pub(crate) version: u64,
    /// Sets of sums and motions on each node: one, and more where bodies are in contact.
    pub(crate) fields: usize,
}

impl<D: Dim> Grid<D> {
    pub(crate) fn new(lattice: Lattice<D>, tile_shape: TileShape) -> Self {
        Self {
            lattice,
            tile_shape,
            homes: Vec::new(),
            blocks: Vec::new(),
            sources: Vec::new(),
            around: Vec::new(),
            sums: Vec::new(),
            motion: Vec::new(),
            version: 0,
            fields: 1,
        }
    }

    pub(crate) fn tile_shape(&self) -> &TileShape {
        &self.tile_shape
    }

    pub(crate) fn homes(&self) -> &[BlockAt] {
        &self.homes
    }

    pub(crate) fn blocks(&self) -> &[BlockAt] {
        &self.blocks
    }

    /// Nodes of all tiles.
    pub(crate) fn tile_nodes(&self) -> usize {
        self.homes.len() * self.tile_shape.nodes
    }

    /// Cuts tiles, and what belongs to homes, home by home.
    pub(crate) fn tile_blocks(&self) -> Blocks {
        Blocks::new(self.tile_nodes(), self.tile_shape.nodes)
    }

    /// Cuts what is on nodes block by block; those of a block hold one field after another.
    pub(crate) fn node_blocks(&self) -> Blocks {
        let each = self.fields * block_cells::<D>();
        Blocks::new(self.blocks.len() * each, each)
    }

    /// Has as many fields on every node.
    pub(crate) fn set_fields(&mut self, fields: usize) {
        self.fields = fields;
        self.version += 1;
        self.make_room();
    }

    /// Makes room for what is on nodes.
    fn make_room(&mut self) {
        let nodes = self.blocks.len() * self.fields * block_cells::<D>();
        for on_nodes in [&mut self.sums, &mut self.motion] {
            on_nodes.clear();
            grow(on_nodes, nodes);
            on_nodes.resize(nodes, Node::ZERO);
        }
    }

    /// Where a home lies.
    pub(crate) fn corner(&self, home: usize) -> Corner<D> {
        Corner { at: self.lattice.corner(self.homes[home]), per_cell: 1.0 / self.lattice.cell }
    }

    /// Takes the blocks that hold particles, in order.
    pub(crate) fn settle(&mut self, homes: &[BlockAt]) {
        if self.homes == homes {
            return;
        }
        self.version += 1;
        self.homes.clear();
        self.homes.extend_from_slice(homes);
        let count = neighbours::<D>();
        self.blocks.clear();
        grow(&mut self.blocks, homes.len() * count);
        self.blocks.extend(homes.iter().flat_map(|&home| (0..count).map(move |k| shifted::<D>(home, k, 1))));
        self.blocks.sort_unstable();
        self.blocks.dedup();
        let Self { blocks, homes, sources, around, .. } = self;
        let number = |list: &[BlockAt], at: BlockAt| list.binary_search(&at).map_or(NONE, |k| k as u32);
        sources.clear();
        grow(sources, blocks.len() * count);
        sources.extend(blocks.iter().flat_map(|&block| {
            let homes = &*homes;
            (0..count).map(move |k| number(homes, shifted::<D>(block, k, -1)))
        }));
        around.clear();
        grow(around, homes.len() * count);
        around.extend(homes.iter().flat_map(|&home| {
            let blocks = &*blocks;
            (0..count).map(move |k| number(blocks, shifted::<D>(home, k, 1)))
        }));
        self.make_room();
    }

    /// Sums what tiles hold on the nodes of a block.
    #[inline]
    pub(crate) fn collect(&self, block: usize, tiles: &[Node], sums: &mut [Node]) {
        sums.fill(Node::ZERO);
        let count = neighbours::<D>();
        let sources = &self.sources[block * count..(block + 1) * count];
        for (k, &home) in sources.iter().enumerate().filter(|&(_, &home)| home != NONE) {
            let tile = &tiles[home as usize * self.tile_shape.nodes..];
            for run in self.tile_shape.shared_with(k) {
                let from = &tile[run.tile..run.tile + run.len];
                let to = &mut sums[run.owned..run.owned + run.len];
                to.iter_mut().zip(from).for_each(|(to, from)| to.add(from));
            }
        }
    }

    /// Brings the motion of all nodes that particles of a home and a field reach into its tile.
    pub(crate) fn fetch(&self, home: usize, field: usize, tile: &mut [Node]) {
        let (count, nodes) = (neighbours::<D>(), block_cells::<D>());
        for (k, &block) in self.around[home * count..(home + 1) * count].iter().enumerate() {
            let first = (block as usize * self.fields + field) * nodes;
            let owned = &self.motion[first..first + nodes];
            for run in self.tile_shape.shared_with(k) {
                tile[run.tile..run.tile + run.len].copy_from_slice(&owned[run.owned..run.owned + run.len]);
            }
        }
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Node>() * (self.sums.capacity() + self.motion.capacity())
            + size_of::<BlockAt>() * (self.homes.capacity() + self.blocks.capacity())
            + size_of::<u32>() * (self.sources.capacity() + self.around.capacity())
    }
}

/// Makes room, and a quarter more, so that a flow that spreads seldom asks again.
pub(crate) fn grow<T>(list: &mut Vec<T>, count: usize) {
    if list.capacity() < count {
        list.reserve_exact(count + count / 4 - list.len());
    }
}

/// The block that lies from another as neighbour `k` does, or (`sign` -1) as the one whose neighbour it is.
fn shifted<D: Dim>(block: BlockAt, k: usize, sign: i32) -> BlockAt {
    let offset = offset_of::<D>(k);
    std::array::from_fn(|axis| block[axis].saturating_add(sign * offset[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    #[test]
    fn what_tiles_hold_is_collected_once_and_fetched_back() {
        let lattice = Lattice::<D2> { origin: DVec2::ZERO, cell: 1.0 };
        let mut grid = Grid::new(lattice, TileShape::new::<D2>(3));
        grid.settle(&[[0, 0, 0], [1, 0, 0], [1, 5, 0]]);
        let mut tiles = vec![Node([1.0; 8]); grid.tile_nodes()];
        let mut sums = std::mem::take(&mut grid.sums);
        for (block, sums) in sums.chunks_mut(block_cells::<D2>()).enumerate() {
            grid.collect(block, &tiles, sums);
        }
        let total: f64 = sums.iter().map(|node| node.0[0]).sum();
        assert_eq!(total, grid.tile_nodes() as f64);
        // The places of nodes come back to where tiles have them.
        for (k, node) in grid.motion.iter_mut().enumerate() {
            let at = lattice.node(grid.blocks[k / 64], k % 64);
            node.0[..2].copy_from_slice(&at.to_array());
        }
        grid.fetch(1, 0, &mut tiles[..169]);
        let corner = grid.corner(1).at - DVec2::splat(2.0);
        for (k, node) in tiles[..169].iter().enumerate() {
            let expected = corner + DVec2::new((k % 13) as f64, (k / 13) as f64);
            assert!((DVec2::new(node.0[0], node.0[1]) - expected).length() < 1e-12);
        }
    }
}
