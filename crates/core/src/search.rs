//! Neighbour search: every pair of balls whose surfaces are nearer than a reach.
//!
//! Positions are sorted into a regular grid of cells no smaller than the largest diameter plus
//! the reach, so that neighbours lie in adjoining cells. The grid covers where most balls are;
//! balls outside (one that was shot away) are counted to the nearest cell of the border, which
//! never separates neighbours because clamping does not push cell numbers apart. A far ball
//! therefore costs nothing.

mod levels;

pub use levels::SizeLevels;

use crate::dim::{Dim, Linear, Vector};

/// Visits the balls near a ball.
pub trait Neighbours<D: Dim> {
    /// Calls `visit` at least for every ball whose surface is nearer than the reach of the search to that of a ball of this
    /// centre and radius \[m\], itself included; in a fixed order that depends on the balls only.
    fn visit_near(&self, position: D::Vec, radius: f64, visit: impl FnMut(u32));
}

/// Sorts positions into cells and visits neighbours.
#[derive(Clone, Debug, Default)]
pub struct CellGrid<D: Dim> {
    origin: D::Vec,
    cell: f64,
    cells: [usize; 3],
    starts: Vec<u32>,
    members: Vec<u32>,
    scratch: Vec<u32>,
}

/// Cells per ball that the grid may have before it is shrunk to where most balls are.
const CELLS_PER_BALL: usize = 8;

impl<D: Dim> CellGrid<D> {
    /// Sorts positions \[m\] into cells of at least this edge \[m\].
    pub fn fill(&mut self, positions: &[D::Vec], cell: f64) {
        self.lay_out(positions, cell);
        let count = self.cells.iter().product::<usize>();
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        self.scratch.clear();
        for &position in positions {
            let cell = self.number(self.coordinates(position)) as u32;
            self.scratch.push(cell);
            self.starts[cell as usize + 1] += 1;
        }
        for k in 0..count {
            self.starts[k + 1] += self.starts[k];
        }
        self.members.resize(positions.len(), 0);
        // Counting sort from the back: `starts[k + 1]` runs down to the start of cell k.
        for (index, &cell) in self.scratch.iter().enumerate().rev() {
            let end = &mut self.starts[cell as usize + 1];
            *end -= 1;
            self.members[*end as usize] = index as u32;
        }
        self.starts.remove(0);
        self.starts.push(positions.len() as u32);
    }

    /// Chooses origin, edge and number of cells.
    fn lay_out(&mut self, positions: &[D::Vec], cell: f64) {
        self.cells = [1; 3];
        self.cell = cell;
        let Some(&first) = positions.first() else {
            return;
        };
        let mut low = positions.iter().fold(first, |low, &p| low.min(p));
        let mut high = positions.iter().fold(first, |high, &p| high.max(p));
        let most = CELLS_PER_BALL * positions.len() + 64;
        if cells_between::<D>(low, high, cell) > most as f64 {
            (low, high) = bulk::<D>(positions);
        }
        while cells_between::<D>(low, high, self.cell) > most as f64 {
            self.cell *= 1.25;
        }
        self.origin = low;
        for axis in 0..D::N {
            self.cells[axis] = ((high - low).component(axis) / self.cell).floor() as usize + 1;
        }
    }

    fn coordinates(&self, position: D::Vec) -> [usize; 3] {
        let mut coordinates = [0; 3];
        for (axis, coordinate) in coordinates.iter_mut().enumerate().take(D::N) {
            let offset = (position - self.origin).component(axis) / self.cell;
            // A float cast saturates: negative offsets become 0.
            *coordinate = (offset as usize).min(self.cells[axis] - 1);
        }
        coordinates
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// Calls `visit` for every ball in the cells around `position`, itself included, in a fixed
    /// order that depends on positions only.
    #[inline(always)]
    pub fn visit_around(&self, position: D::Vec, visit: impl FnMut(u32)) {
        let centre = self.coordinates(position);
        let low = centre.map(|c| c.saturating_sub(1));
        let high: [usize; 3] = std::array::from_fn(|axis| (centre[axis] + 1).min(self.cells[axis] - 1));
        self.visit_cells(low, high, visit);
    }

    /// Calls `visit` for every ball in the cells within `reach` \[m\] of `position` along each axis.
    pub fn visit_within(&self, position: D::Vec, reach: f64, visit: impl FnMut(u32)) {
        let corner = D::Vec::splat(reach);
        self.visit_cells(self.coordinates(position - corner), self.coordinates(position + corner), visit);
    }

    #[inline(always)]
    fn visit_cells(&self, low: [usize; 3], high: [usize; 3], mut visit: impl FnMut(u32)) {
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                // Cells along x follow one another, and so do their members.
                let from = self.starts[self.number([low[0], y, z])] as usize;
                let to = self.starts[self.number([high[0], y, z]) + 1] as usize;
                for &member in &self.members[from..to] {
                    visit(member);
                }
            }
        }
    }
}

impl<D: Dim> Neighbours<D> for CellGrid<D> {
    /// Every radius up to that for which the cells were made sees the same cells.
    #[inline(always)]
    fn visit_near(&self, position: D::Vec, _radius: f64, visit: impl FnMut(u32)) {
        self.visit_around(position, visit);
    }
}

fn cells_between<D: Dim>(low: D::Vec, high: D::Vec, cell: f64) -> f64 {
    (0..D::N).map(|axis| ((high - low).component(axis) / cell).floor() + 1.0).product()
}

/// A box that holds the middle 98 % of the positions along each axis, twice as wide.
fn bulk<D: Dim>(positions: &[D::Vec]) -> (D::Vec, D::Vec) {
    let (mut low, mut high) = (D::Vec::ZERO, D::Vec::ZERO);
    let mut values = vec![0.0; positions.len()];
    for axis in 0..D::N {
        values.iter_mut().zip(positions).for_each(|(value, p)| *value = p.component(axis));
        values.sort_unstable_by(f64::total_cmp);
        let (a, b) = (values[values.len() / 100], values[values.len() - 1 - values.len() / 100]);
        let margin = 0.5 * (b - a);
        low += D::Vec::along(axis, a - margin);
        high += D::Vec::along(axis, b + margin);
    }
    (low, high)
}

/// Order of positions along a space-filling curve (Morton), by cells of edge `cell` \[m\]:
/// balls that are near in space become near in memory. Ties keep their order.
pub fn curve_order<D: Dim>(positions: &[D::Vec], cell: f64) -> Vec<u32> {
    let Some(&first) = positions.first() else {
        return Vec::new();
    };
    let low = positions.iter().fold(first, |low, &p| low.min(p));
    let bits = 63 / D::N;
    let largest = ((1_u64 << bits) - 1) as f64;
    let key = |position: D::Vec| {
        let mut key = 0_u64;
        for axis in 0..D::N {
            let coordinate = ((position - low).component(axis) / cell).clamp(0.0, largest) as u64;
            for bit in 0..bits {
                key |= (coordinate >> bit & 1) << (bit * D::N + axis);
            }
        }
        key
    };
    let mut order: Vec<(u64, u32)> = positions.iter().enumerate().map(|(i, &p)| (key(p), i as u32)).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests;
