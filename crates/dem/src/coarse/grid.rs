//! The grid on which fields are shown.

use super::spline::{WIDEST, Weights};
use crate::material::SetupError;
use granular_core::{Dim, Location, Vector};

/// Most cells of a grid; beyond, memory and files would be in the gigabytes.
const MOST_CELLS: f64 = 1e8;

/// Square or cubic cells, and the kernel that spreads grains over them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoarseGrid<D: Dim> {
    low: D::Vec,
    spacing: f64,
    cells: [usize; 3],
    width: usize,
}

impl<D: Dim> CoarseGrid<D> {
    /// Cells of edge `spacing` \[m\] from a corner to at least the other \[m\], and a kernel of scale `width` times
    /// `spacing`: it ends at twice its scale.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn new(low: D::Vec, high: D::Vec, spacing: f64, width: usize) -> Result<Self, SetupError> {
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(SetupError::new("spacing of the grid", spacing, "positive and finite"));
        }
        if !(1..=WIDEST).contains(&width) {
            return Err(SetupError::new("width of the kernel", width as f64, "1 to 8 cells"));
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
        Ok(Self { low, spacing, cells: counts.map(|count| count as usize), width })
    }

    /// Edge of a cell \[m\].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Scale of the kernel, in cells.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Cells along each axis; 1 along z in the plane.
    pub fn cells(&self) -> [usize; 3] {
        self.cells
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

    /// The grid as outputs take it.
    pub fn location(&self) -> Location<'static> {
        let mut origin = self.low.padded();
        // One layer of cells about z = 0 in the plane.
        origin[D::N..].fill(-0.5 * self.spacing);
        Location::Grid { origin, spacing: [self.spacing; 3], cells: self.cells }
    }

    pub(super) fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Cells in a layer: all with one place along the last axis.
    pub(super) fn layer(&self) -> usize {
        self.cells[..D::N - 1].iter().product()
    }

    pub(super) fn layers(&self) -> usize {
        self.cells[D::N - 1]
    }

    /// A place in cells from the centre of the first cell.
    #[inline(always)]
    pub(super) fn place(&self, position: D::Vec) -> [f64; 3] {
        let offset = position - self.low;
        std::array::from_fn(
            |axis| {
                if axis < D::N { offset.component(axis) / self.spacing - 0.5 } else { 0.0 }
            },
        )
    }

    #[inline(always)]
    pub(super) fn weights(&self, place: [f64; 3]) -> [Weights; 3] {
        std::array::from_fn(
            |axis| {
                if axis < D::N { Weights::at(place[axis], self.width) } else { Weights::NONE }
            },
        )
    }

    #[inline(always)]
    pub(super) fn slopes(&self, place: [f64; 3]) -> [Weights; 3] {
        std::array::from_fn(
            |axis| {
                if axis < D::N { Weights::slope(place[axis], self.width) } else { Weights::NONE }
            },
        )
    }

    /// Corners \[m\] of the box about the grid in which a point matters whose kernel, or a branch of at most `reach`
    /// \[m\], touches the grid.
    pub(super) fn reached(&self, reach: f64) -> [D::Vec; 2] {
        let margin = D::Vec::splat(2.0 * self.width as f64 * self.spacing + reach);
        let size = self.cells.map(|cells| cells as f64 * self.spacing);
        let size = D::Vec::from_slice(&size[..D::N]).expect("one component per axis");
        [self.low - margin, self.low + size + margin]
    }

    /// Share of a grain at a place that is spread over the grid.
    pub(super) fn share(&self, place: [f64; 3]) -> f64 {
        let weights = self.weights(place);
        (0..D::N).map(|axis| weights[axis].share(self.cells[axis])).product()
    }
}
