//! Sorting particles by block and cell.

use crate::body::Body;
use crate::grid::Grid;
use crate::layout::{BlockAt, block_cells};
use crate::particles::{Particles, Spare};
use granular_core::{Blocks, Dim};

/// Room for sorting.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sorting<D: Dim> {
    /// Blocks that hold particles.
    homes: Vec<BlockAt>,
    /// For each particle the cell that holds it, counted through all homes.
    cells: Vec<u32>,
    /// Where particles of each cell go next.
    next: Vec<u32>,
    /// Where each comes from.
    order: Vec<u32>,
    spare: Spare<D>,
}

/// A body and the particles that it has.
#[derive(Debug)]
pub(crate) struct Group<D: Dim> {
    pub(crate) body: Box<dyn Body<D>>,
    /// Density at the start \[kg/m^3\].
    pub(crate) density: f64,
    /// Where each home begins among all particles, and the end of the last.
    pub(crate) starts: Vec<u32>,
    /// Mean volume of particles that carry stress over that at the start.
    pub(crate) looseness: f64,
    /// The set of nodal sums and motions that is its own, or shared with others.
    pub(crate) field: usize,
}

impl<D: Dim> Sorting<D> {
    /// Brings particles into the order of blocks and cells, and lets the grid follow.
    pub(crate) fn sort(&mut self, particles: &mut Particles<D>, groups: &mut [Group<D>], grid: &mut Grid<D>) {
        self.find_homes(particles, grid);
        grid.settle(&self.homes);
        self.find_cells(particles, grid);
        for group in groups {
            self.sort_group(particles, group);
        }
    }

    fn find_homes(&mut self, particles: &Particles<D>, grid: &Grid<D>) {
        self.homes.clear();
        for &position in &particles.position {
            let (block, _) = grid.lattice.find(position);
            // Neighbours in memory are mostly in one block.
            if self.homes.last() == Some(&block) {
                continue;
            }
            if self.homes.len() == self.homes.capacity() {
                self.homes.sort_unstable();
                self.homes.dedup();
            }
            self.homes.push(block);
        }
        self.homes.sort_unstable();
        self.homes.dedup();
    }

    fn find_cells(&mut self, particles: &Particles<D>, grid: &Grid<D>) {
        let count = particles.len();
        self.cells.resize(count, 0);
        let (blocks, homes) = (Blocks::new(count, 4096), &self.homes);
        blocks.for_each(&mut self.cells[..], |block, cells| {
            let mut last = 0;
            for (k, to) in blocks.range(block).zip(cells) {
                let (at, cell) = grid.lattice.find(particles.position[k]);
                if homes[last] != at {
                    last = homes.binary_search(&at).expect("the block of every particle is a home");
                }
                *to = (last * block_cells::<D>() + cell) as u32;
            }
        });
    }

    /// A counting sort.
    fn sort_group(&mut self, particles: &mut Particles<D>, group: &mut Group<D>) {
        let (first, last) = (group.starts[0], *group.starts.last().expect("there is always an end"));
        let range = first as usize..last as usize;
        let cells = &self.cells[range.clone()];
        let all_cells = self.homes.len() * block_cells::<D>();
        self.next.clear();
        self.next.resize(all_cells + 1, 0);
        for &cell in cells {
            self.next[cell as usize + 1] += 1;
        }
        let mut sum = 0;
        for next in &mut self.next {
            sum += *next;
            *next = sum;
        }
        group.starts.clear();
        group.starts.extend(self.next.iter().step_by(block_cells::<D>()).map(|&next| first + next));
        self.order.resize(range.len(), 0);
        for (k, &cell) in cells.iter().enumerate() {
            let next = &mut self.next[cell as usize];
            self.order[*next as usize] = k as u32;
            *next += 1;
        }
        particles.permute(range, &self.order, &mut self.spare);
        group.body.permute(&self.order);
    }

    /// Bytes held for each of `count` particles.
    pub(crate) fn bytes_each() -> usize {
        // The cell, the order, and one property at a time of each kind.
        3 * size_of::<u32>() + size_of::<f64>() + size_of::<D::Vec>()
    }
}
