//! The shares of cells that one grain covers.

use granular_core::{Dim, Vector};

/// A box of cells around a grain and the share of each that the grain covers. Lengths are in cells; cell `i` reaches from `i`
/// to `i + 1`.
#[derive(Clone, Debug, Default)]
pub(super) struct Tile {
    low: [i64; 3],
    size: [usize; 3],
    shares: Vec<f64>,
    /// Per row of the box: the first cell that is covered and the one after the last, from `low` on.
    covered: Vec<[u32; 2]>,
    /// Sum of all shares, in the order in which they lie.
    total: f64,
}

/// Covered cells of one row of a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// The first cell; it may lie outside of the domain.
    pub(super) cell: [i64; 3],
    pub(super) count: usize,
    /// Index of the share of the first cell.
    pub(super) at: usize,
}

impl Tile {
    /// Covers nothing.
    pub(super) fn clear(&mut self) {
        self.size = [0; 3];
        self.covered.clear();
        self.total = 0.0;
    }

    /// Shares of all cells near a ball. Only cells that its surface cuts cost more than a store.
    pub(super) fn cover<D: Dim>(&mut self, centre: D::Vec, radius: f64) {
        (self.low, self.size) = ([0; 3], [1; 3]);
        for axis in 0..D::N {
            let at = centre.component(axis);
            self.low[axis] = (at - radius).floor() as i64;
            self.size[axis] = ((at + radius).floor() as i64 - self.low[axis]) as usize + 1;
        }
        let [nx, ny, nz] = self.size;
        self.shares.clear();
        self.shares.resize(nx * ny * nz, 0.0);
        self.covered.clear();
        for row in 0..ny * nz {
            let covered = self.cover_row::<D>([row % ny, row / ny], row * nx, centre, radius);
            self.covered.push(covered);
        }
        let mut total = 0.0;
        for stretch in self.stretches() {
            self.shares(stretch.at, stretch.count).iter().for_each(|share| total += share);
        }
        self.total = total;
    }

    /// Sum of all shares; that of the cells of all stretches one after the other, to the bit.
    pub(super) fn total(&self) -> f64 {
        self.total
    }

    fn cover_row<D: Dim>(&mut self, row: [usize; 2], at: usize, centre: D::Vec, radius: f64) -> [u32; 2] {
        // Squared distances from the axis along x through the centre: of the nearest and the farthest point of the row.
        let (mut nearest, mut farthest) = (0.0, 0.0);
        for axis in 1..D::N {
            let low = (self.low[axis] + row[axis - 1] as i64) as f64 - centre.component(axis);
            nearest += low.max(-1.0 - low).max(0.0).powi(2);
            farthest += (low + 1.0).max(-low).powi(2);
        }
        let square = radius * radius;
        if nearest >= square {
            return [0; 2];
        }
        let x = centre.component(0) - self.low[0] as f64;
        let cells = |at: f64| at.clamp(0.0, self.size[0] as f64) as usize;
        let reach = (square - nearest).sqrt();
        let (mut first, mut end) = (cells((x - reach).floor()), cells((x + reach).ceil()));
        let within = if farthest < square { (square - farthest).sqrt() } else { f64::NEG_INFINITY };
        let (full, rest) = (cells((x - within).ceil()), cells((x + within).floor()));
        for k in first..end {
            let is_full = (full..rest).contains(&k);
            self.shares[at + k] =
                if is_full { 1.0 } else { self.share::<D>([k, row[0], row[1]], centre, radius) };
        }
        while first < end && self.shares[at + first] <= 0.0 {
            first += 1;
        }
        while first < end && self.shares[at + end - 1] <= 0.0 {
            end -= 1;
        }
        [first as u32, end as u32]
    }

    fn share<D: Dim>(&self, cell: [usize; 3], centre: D::Vec, radius: f64) -> f64 {
        let low = D::Vec::from_fn(|axis| (self.low[axis] + cell[axis] as i64) as f64) - centre;
        D::ball_in_box(radius, low, low + D::Vec::splat(1.0)).clamp(0.0, 1.0)
    }

    /// Rows that are covered.
    pub(super) fn stretches(&self) -> impl Iterator<Item = Stretch> + '_ {
        let [nx, ny, _] = self.size;
        self.covered.iter().enumerate().filter(|(_, [first, end])| first < end).map(
            move |(row, &[first, end])| {
                let cell = [
                    self.low[0] + i64::from(first),
                    self.low[1] + (row % ny) as i64,
                    self.low[2] + (row / ny) as i64,
                ];
                Stretch { cell, count: (end - first) as usize, at: row * nx + first as usize }
            },
        )
    }

    pub(super) fn shares(&self, at: usize, count: usize) -> &[f64] {
        &self.shares[at..at + count]
    }

    pub(super) fn bytes(&self) -> usize {
        size_of::<f64>() * self.shares.capacity() + size_of::<[u32; 2]>() * self.covered.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    fn covered<D: Dim>(centre: D::Vec, radius: f64) -> f64 {
        let mut tile = Tile::default();
        tile.cover::<D>(centre, radius);
        tile.stretches().flat_map(|s| tile.shares(s.at, s.count).to_vec()).sum()
    }

    #[test]
    fn shares_sum_to_the_ball_wherever_it_is() {
        for (x, y, z) in [(0.0, 0.0, 0.0), (3.2, -7.9, 0.3), (100.5, 0.999, -1.0), (-0.25, 0.5, 12.4)] {
            for radius in [0.3, 1.0, 4.0, 9.7] {
                let plane = covered::<D2>(DVec2::new(x, y), radius) / D2::ball_volume(radius);
                assert!((plane - 1.0).abs() < 1e-12, "{x} {y} {radius}: {plane}");
                let space = covered::<D3>(DVec3::new(x, y, z), radius) / D3::ball_volume(radius);
                // Errors of cells are of either sign.
                let allowed = 2e-3 / (radius * radius).max(1.0);
                assert!((space - 1.0).abs() < allowed, "{x} {y} {z} {radius}: {space}");
            }
        }
    }
}
