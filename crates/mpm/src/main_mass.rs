//! Which particles belong together: a front should be that of the body, not of a particle that flew off.

use crate::mpm::Mpm;
use granular_core::{Dim, Vector};

/// A cell of the grid.
type Cell = [i64; 3];

impl<D: Dim> Mpm<D> {
    /// Whether each particle, in the order of memory, belongs to the main mass: the largest set of cells with particles that
    /// share a face, an edge or a corner, by the number of particles.
    pub fn main_mass(&self) -> Vec<bool> {
        let cells: Vec<Cell> = self.particles.position.iter().map(|&at| self.cell_of(at)).collect();
        let mut occupied = cells.clone();
        occupied.sort_unstable();
        occupied.dedup();
        let place = |cell: &Cell| occupied.binary_search(cell).ok();
        let mut heads: Vec<usize> = (0..occupied.len()).collect();
        for (k, cell) in occupied.iter().enumerate() {
            for other in neighbours_before(*cell).iter().filter_map(place) {
                let (a, b) = (head_of(&mut heads, k), head_of(&mut heads, other));
                heads[a.max(b)] = a.min(b);
            }
        }
        let heads: Vec<usize> = (0..heads.len()).map(|k| head_of(&mut heads, k)).collect();
        let set: Vec<usize> = cells.iter().filter_map(place).map(|place| heads[place]).collect();
        let mut counts = vec![0_usize; heads.len()];
        set.iter().for_each(|&head| counts[head] += 1);
        // Of equals the first, which does not depend on the order of particles.
        let largest = (0..counts.len()).rev().max_by_key(|&head| counts[head]);
        set.iter().map(|&head| Some(head) == largest).collect()
    }

    /// Farthest points of the main mass along x and upwards \[m\], counting particles as squares or cubes; not numbers without
    /// particles.
    pub(crate) fn front_and_height(&self) -> [f64; 2] {
        let mut farthest = [f64::NAN; 2];
        for (k, _) in self.main_mass().iter().enumerate().filter(|(_, is_main)| **is_main) {
            let half = 0.5 * self.particles.volume[k].powf(1.0 / D::N as f64);
            for (most, axis) in farthest.iter_mut().zip([0, D::UP]) {
                *most = most.max(self.particles.position[k].component(axis) + half);
            }
        }
        farthest
    }

    fn cell_of(&self, at: D::Vec) -> Cell {
        let lattice = &self.grid.lattice;
        let along = |axis: usize| ((at - lattice.origin).component(axis) / lattice.cell).floor() as i64;
        std::array::from_fn(|axis| if axis < D::N { along(axis) } else { 0 })
    }
}

/// Neighbours of a cell that come before it in the order of cells.
fn neighbours_before([x, y, z]: Cell) -> [Cell; 13] {
    let mut all = [[0; 3]; 13];
    for (k, neighbour) in all.iter_mut().enumerate() {
        let k = k as i64;
        *neighbour = [x + k / 9 - 1, y + k / 3 % 3 - 1, z + k % 3 - 1];
    }
    all
}

/// The cell that stands for a set, with the way there made shorter.
fn head_of(heads: &mut [usize], mut k: usize) -> usize {
    while heads[k] != k {
        heads[k] = heads[heads[k]];
        k = heads[k];
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mpm2, Particle, Setup};
    use granular_constitutive::LinearElastic;
    use granular_core::{FieldSink, Numbers, Solver, glam::DVec2};

    #[test]
    fn neighbours_before_are_half_of_all() {
        let all = neighbours_before([0, 0, 0]);
        assert!(all.iter().all(|cell| *cell < [0, 0, 0]));
        assert_eq!(all.iter().collect::<std::collections::BTreeSet<_>>().len(), 13);
    }

    #[test]
    fn what_flew_off_is_no_front() {
        let mut mpm = Mpm2::new(Setup::new(0.1)).unwrap();
        let block = Particle::filling(DVec2::ZERO, DVec2::new(0.4, 0.2), 0.05);
        let flying = Particle::at(DVec2::new(3.0, 1.0), 0.0025);
        let all: Vec<_> = block.iter().copied().chain([flying]).collect();
        mpm.body(LinearElastic::new(1e5, 0.2).unwrap(), 1000.0, &all).unwrap();
        assert_eq!(mpm.main_mass().iter().filter(|is_main| !**is_main).count(), 1);
        let mut numbers = Numbers::wanting(["front", "height", "farthest"]);
        assert!(numbers.wants("front"));
        mpm.show(&mut numbers);
        let near = |name: &str, value: f64| (numbers.get(name).unwrap() - value).abs() < 1e-12;
        assert!(near("front", 0.4) && near("height", 0.2) && near("farthest", 3.0));
    }
}
