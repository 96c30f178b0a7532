//! Regular grids: square or cubic cells along the axes.

use crate::dim::{Dim, Vector};
use crate::field::Location;
use crate::setup_error::SetupError;

/// Most cells of a grid; beyond, memory and files would be in the gigabytes.
const MOST_CELLS: f64 = 1e8;

/// Square or cubic cells of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegularGrid<D: Dim> {
    low: D::Vec,
    spacing: f64,
    cells: [usize; 3],
}

impl<D: Dim> RegularGrid<D> {
    /// Cells of edge `spacing` \[m\] from a corner to at least the other \[m\].
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn new(low: D::Vec, high: D::Vec, spacing: f64) -> Result<Self, SetupError> {
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(SetupError::new("spacing of the grid", spacing, "positive and finite"));
        }
        let mut counts = [1.0; 3];
        for (axis, count) in counts.iter_mut().enumerate().take(D::N) {
            let extent = (high - low).component(axis);
            if !(extent.is_finite() && extent > 0.0) {
                return Err(SetupError::new("extent of the grid", extent, "positive and finite"));
            }
            // A corner that is a whole number of cells away up to round-off adds no cell.
            *count = (extent / spacing - 1e-9).ceil().max(1.0);
        }
        let total: f64 = counts.iter().product();
        if total > MOST_CELLS {
            return Err(SetupError::new("cells of the grid", total, "at most 1e8; take a larger spacing"));
        }
        Ok(Self { low, spacing, cells: counts.map(|count| count as usize) })
    }

    /// Lowest corner \[m\].
    pub fn low(&self) -> D::Vec {
        self.low
    }

    /// Edge of a cell \[m\].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Cells along each axis; 1 along z in the plane.
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Number of cells.
    pub fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Area \[m^2\] or volume \[m^3\] of a cell.
    pub fn cell_volume(&self) -> f64 {
        self.spacing.powi(D::N as i32)
    }

    /// Centre of a cell \[m\].
    pub fn centre(&self, cell: [usize; 3]) -> D::Vec {
        let place = |axis: usize| D::Vec::along(axis, self.spacing * (cell[axis] as f64 + 0.5));
        (0..D::N).fold(self.low, |sum, axis| sum + place(axis))
    }

    /// A place in cells from the centre of the first cell.
    #[inline(always)]
    pub fn place(&self, position: D::Vec) -> [f64; 3] {
        let offset = position - self.low;
        std::array::from_fn(
            |axis| {
                if axis < D::N { offset.component(axis) / self.spacing - 0.5 } else { 0.0 }
            },
        )
    }

    /// The grid as outputs take it.
    pub fn location(&self) -> Location<'static> {
        let mut origin = self.low.padded();
        // One layer of cells about z = 0 in the plane.
        origin[D::N..].fill(-0.5 * self.spacing);
        Location::Grid { origin, spacing: [self.spacing; 3], cells: self.cells }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::D2;
    use glam::DVec2;

    #[test]
    fn cells_cover_the_box_and_round_off_adds_none() {
        let grid = RegularGrid::<D2>::new(DVec2::new(1.0, 2.0), DVec2::new(1.3, 2.25), 0.1).unwrap();
        assert_eq!(grid.cells(), [3, 3, 1]);
        assert!((grid.centre([2, 0, 0]) - DVec2::new(1.25, 2.05)).length() < 1e-15);
        let place = grid.place(DVec2::new(1.25, 2.05));
        assert!((place[0] - 2.0).abs() < 1e-12 && place[1].abs() < 1e-12);
        for (high, spacing) in
            [(DVec2::new(1.0, 3.0), 0.1), (DVec2::new(9.0, 9.0), 0.0), (DVec2::new(2e9, 9.0), 0.1)]
        {
            assert!(RegularGrid::<D2>::new(DVec2::new(1.0, 2.0), high, spacing).is_err());
        }
    }
}
