//! Grains averaged over the cells of a grid.

use super::voronoi;
use crate::methods::member::{Averages, NoGrid};
use crate::scene::GridSpec;
use granular_core::units::Length;
use granular_core::{D2, Dim, FieldSink, Location, NodeKey, Simulation, Vector};
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
        let corner = |key, values: &[Length]| {
            let numbers: Vec<f64> = values.iter().map(|value| value.value()).collect();
            let wrong = || NoGrid {
                key,
                value: format!("a list of {}", values.len()),
                allowed: format!("{} values, one per axis", D::N),
            };
            D::Vec::from_slice(&numbers).ok_or_else(wrong)
        };
        let (from, to) = (corner("grid.from", &spec.from)?, corner("grid.to", &spec.to)?);
        let cells = CoarseGrid::new(from, to, spec.spacing.value(), spec.width).map_err(|error| {
            let key = match error.what.split(' ').next() {
                Some("spacing" | "cells") => "grid.spacing",
                Some("width") => "grid.width",
                _ => "grid.to",
            };
            let allowed = format!("{}: {}", error.what, error.allowed);
            NoGrid { key, value: error.value.to_string(), allowed }
        })?;
        Ok(Self { cells, key })
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
