//! The grid on which fields are shown.

use super::spline::{WIDEST, Weights};
use crate::dim::{Dim, Vector};
use crate::field::Location;
use crate::grid::RegularGrid;
use crate::setup_error::SetupError;

/// Square or cubic cells, and the kernel that spreads grains over them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoarseGrid<D: Dim> {
    grid: RegularGrid<D>,
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
        Ok(Self { grid: RegularGrid::new(low, high, spacing)?, width })
    }

    /// The cells.
    pub fn grid(&self) -> &RegularGrid<D> {
        &self.grid
    }

    /// Edge of a cell \[m\].
    pub fn spacing(&self) -> f64 {
        self.grid.spacing()
    }

    /// Scale of the kernel, in cells.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Cells along each axis; 1 along z in the plane.
    pub fn cells(&self) -> [usize; 3] {
        self.grid.cells()
    }

    /// Area \[m^2\] or volume \[m^3\] of a cell.
    pub fn cell_volume(&self) -> f64 {
        self.grid.cell_volume()
    }

    /// Centre of a cell \[m\].
    pub fn centre(&self, cell: [usize; 3]) -> D::Vec {
        self.grid.centre(cell)
    }

    /// The grid as outputs take it.
    pub fn location(&self) -> Location<'static> {
        self.grid.location()
    }

    pub(super) fn count(&self) -> usize {
        self.grid.count()
    }

    /// Cells in a layer: all with one place along the last axis.
    pub(super) fn layer(&self) -> usize {
        self.cells()[..D::N - 1].iter().product()
    }

    pub(super) fn layers(&self) -> usize {
        self.cells()[D::N - 1]
    }

    #[inline(always)]
    pub(super) fn place(&self, position: D::Vec) -> [f64; 3] {
        self.grid.place(position)
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
        let margin = D::Vec::splat(2.0 * self.width as f64 * self.spacing() + reach);
        let size = self.cells().map(|cells| cells as f64 * self.spacing());
        let size = D::Vec::from_slice(&size[..D::N]).expect("one component per axis");
        [self.grid.low() - margin, self.grid.low() + size + margin]
    }

    /// Share of a grain at a place that is spread over the grid.
    pub(super) fn share(&self, place: [f64; 3]) -> f64 {
        let weights = self.weights(place);
        (0..D::N).map(|axis| weights[axis].share(self.cells()[axis])).product()
    }
}
