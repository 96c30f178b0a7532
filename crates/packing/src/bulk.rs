//! Solid fraction of the bulk of a deposit: cells away from all its boundaries.

use crate::bands::{BAND_OVER_MEDIAN_DIAMETER, homogeneity};
use crate::error::{PackingError, largest_radius, require};
use crate::grading::median_diameter;
use granular_core::{Dim, Linear, Vector};

/// More cells than this along an axis are a slip of the pen.
const MOST_CELLS: f64 = 1e5;

/// The bulk of a deposit, in horizontal bands.
///
/// It is made of cells of 2.5 median diameters ($d_{50}$ by volume). The outermost 2.5 median
/// diameters at the sides and at the bottom do not belong to it, nor those below the surface: in
/// each upright row of cells the surface is the highest point of any grain that reaches into the row. Grains
/// are cut exactly by the faces of cells. Sides and bottom are where the outermost grains end,
/// so that walls need not be known, and a slope has a bulk as a level bed has.
#[derive(Clone, Debug, PartialEq)]
pub struct Bulk {
    /// Solid volume \[m^3; m^2 in the plane\] and volume of each band, from the bottom up.
    pub bands: Vec<[f64; 2]>,
}

impl Bulk {
    /// The bulk of grains at these `positions` \[m\], with `radii` \[m\]; without bands when the
    /// deposit is too small to have one.
    ///
    /// # Errors
    /// When a radius or position is out of range, or they are not equal in number.
    pub fn of<D: Dim>(positions: &[D::Vec], radii: &[f64]) -> Result<Self, PackingError> {
        largest_radius(radii)?;
        let (found, wanted) = (positions.len(), radii.len());
        require(found == wanted, "number of positions", found as f64, format!("{wanted} (one per radius)"))?;
        let finite = positions.iter().all(|position| position.is_finite());
        require(finite, "position of a grain [m]", f64::NAN, "finite")?;
        let mut grid = Grid::of::<D>(positions, radii)?;
        grid.find_surface::<D>(positions, radii);
        Ok(Self { bands: grid.fill::<D>(positions, radii) })
    }

    /// Solid volume over volume; `None` without a bulk.
    pub fn solid_fraction(&self) -> Option<f64> {
        let [solid, volume] = self.bands.iter().fold([0.0; 2], |[s, v], band| [s + band[0], v + band[1]]);
        (volume > 0.0).then(|| solid / volume)
    }

    /// Variance of the void ratio over bands, as [`homogeneity`]; `None` with fewer than two bands.
    pub fn homogeneity(&self) -> Option<f64> {
        let fractions: Vec<f64> = self.bands.iter().map(|[solid, volume]| solid / volume).collect();
        homogeneity(&fractions).ok()
    }
}

/// Upright rows of cells, and how high each reaches. The last axis is up.
struct Grid {
    /// Corner of the first cell \[m\].
    low: [f64; 3],
    /// Edges of a cell \[m\].
    edge: [f64; 3],
    /// Rows along the axes of the base.
    rows: [usize; 2],
    /// Highest point of the grains in each row \[m\].
    surface: Vec<f64>,
}

impl Grid {
    fn of<D: Dim>(positions: &[D::Vec], radii: &[f64]) -> Result<Self, PackingError> {
        let cell = BAND_OVER_MEDIAN_DIAMETER * median_diameter::<D>(radii)?;
        let mut grid = Self { low: [0.0; 3], edge: [cell; 3], rows: [1; 2], surface: Vec::new() };
        for axis in 0..D::N {
            let ends = positions
                .iter()
                .zip(radii)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (x, r)| {
                    [low.min(x.component(axis) - r), high.max(x.component(axis) + r)]
                });
            grid.low[axis] = ends[0] + cell;
            if axis == D::UP {
                continue;
            }
            let room = ends[1] - ends[0] - 2.0 * cell;
            // A room of exactly n cells has n cells in spite of round-off.
            let count = (room / cell * (1.0 + 4.0 * f64::EPSILON)).floor().max(0.0);
            require(
                count <= MOST_CELLS,
                "width of the deposit [m]",
                room,
                format!("at most {MOST_CELLS} cells"),
            )?;
            grid.rows[axis] = count as usize;
            if count > 0.0 {
                grid.edge[axis] = room / count;
            }
        }
        grid.surface = vec![f64::NEG_INFINITY; grid.rows[0] * grid.rows[1]];
        Ok(grid)
    }

    /// Cells along an axis that a span reaches into, of `count` in all.
    fn reached(&self, axis: usize, middle: f64, radius: f64, count: usize) -> std::ops::Range<usize> {
        let at = |x: f64| (x - self.low[axis]) / self.edge[axis];
        // Float casts saturate.
        let first = at(middle - radius).floor().max(0.0) as usize;
        let end = at(middle + radius).ceil().max(0.0) as usize;
        first.min(count)..end.min(count)
    }

    /// Rows that a ball reaches into.
    fn rows_of<D: Dim>(&self, position: D::Vec, radius: f64) -> impl Iterator<Item = [usize; 2]> + use<D> {
        let mut ranges = [0..1, 0..1];
        for axis in (0..D::N).filter(|&axis| axis != D::UP) {
            ranges[axis] = self.reached(axis, position.component(axis), radius, self.rows[axis]);
        }
        let [first, second] = ranges;
        first.flat_map(move |i| second.clone().map(move |j| [i, j]))
    }

    fn find_surface<D: Dim>(&mut self, positions: &[D::Vec], radii: &[f64]) {
        for (&position, &radius) in positions.iter().zip(radii) {
            let top = position.component(D::UP) + radius;
            for [i, j] in self.rows_of::<D>(position, radius) {
                let surface = &mut self.surface[i * self.rows[1] + j];
                *surface = surface.max(top);
            }
        }
    }

    /// Cells of a row.
    fn height<D: Dim>(&self, row: usize) -> usize {
        let (cell, room) = (self.edge[D::UP], self.surface[row] - self.edge[D::UP] - self.low[D::UP]);
        (room / cell * (1.0 + 4.0 * f64::EPSILON)).floor().clamp(0.0, MOST_CELLS) as usize
    }

    /// Solid volume and volume of each band.
    fn fill<D: Dim>(&self, positions: &[D::Vec], radii: &[f64]) -> Vec<[f64; 2]> {
        let heights: Vec<usize> = (0..self.surface.len()).map(|row| self.height::<D>(row)).collect();
        let volume: f64 = self.edge[..D::N].iter().product();
        let mut bands = vec![[0.0; 2]; heights.iter().copied().max().unwrap_or(0)];
        for &height in &heights {
            bands[..height].iter_mut().for_each(|band| band[1] += volume);
        }
        for (&position, &radius) in positions.iter().zip(radii) {
            for [i, j] in self.rows_of::<D>(position, radius) {
                let height = heights[i * self.rows[1] + j];
                for k in self.reached(D::UP, position.component(D::UP), radius, height) {
                    bands[k][0] += self.part::<D>([i, j], k, position, radius);
                }
            }
        }
        bands
    }

    /// Volume of a ball in a cell, by inclusion and exclusion over its corners.
    fn part<D: Dim>(&self, row: [usize; 2], band: usize, position: D::Vec, radius: f64) -> f64 {
        let mut faces = [[0.0; 2]; 3];
        let mut whole = true;
        for axis in 0..D::N {
            let index = if axis == D::UP { band } else { row[axis] };
            let face = |k: usize| self.low[axis] + k as f64 * self.edge[axis] - position.component(axis);
            faces[axis] = [face(index), face(index + 1)];
            whole &= faces[axis][0] <= -radius && faces[axis][1] >= radius;
        }
        if whole {
            return D::ball_volume(radius);
        }
        let corner = |choice: usize| {
            (0..D::N)
                .fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, faces[axis][choice >> axis & 1]))
        };
        let sign =
            |choice: usize| if (D::N as u32 - choice.count_ones()).is_multiple_of(2) { 1.0 } else { -1.0 };
        (0..1 << D::N).map(|choice| sign(choice) * D::ball_below(radius, corner(choice))).sum()
    }
}

#[cfg(test)]
mod tests;
