//! Grains averaged over the cells of a grid.

use super::voronoi;
use crate::methods::grids::coarse_grid;
use crate::methods::member::{Averages, NoGrid};
use crate::scene::GridSpec;
use granular_core::{D2, Dim, FieldSink, Location, NodeKey, Simulation};
use granular_dem::{CoarseGrid, Dem};
use std::any::Any;

/// The cells, and the grains that are averaged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<D: Dim> {
    cells: CoarseGrid<D>,
    key: NodeKey<Dem<D>>,
}

impl<D: Dim> Grid<D> {
    /// Of a scene.
    ///
    /// # Errors
    /// When a value is out of range.
    pub(super) fn of(spec: &GridSpec, key: NodeKey<Dem<D>>) -> Result<Self, NoGrid> {
        Ok(Self { cells: coarse_grid(spec)?, key })
    }
}

impl<D: Dim> Averages for Grid<D> {
    fn location(&self) -> Location<'static> {
        self.cells.location()
    }

    fn show(&self, simulation: &Simulation, free_surface: f64, sink: &mut dyn FieldSink) {
        let dem = simulation.get(self.key);
        dem.show_coarse(&self.cells, sink);
        // Voronoi cells are shared out to a grid in the plane.
        let cells: &dyn Any = &self.cells;
        if let Some(cells) = cells.downcast_ref::<CoarseGrid<D2>>() {
            voronoi::show_on_grid(cells, dem, free_surface, sink);
        }
    }
}
