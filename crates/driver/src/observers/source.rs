//! Where the fields of an output come from: the places of the solver, or grains averaged on a grid.

use crate::scene::GridSpec;
use crate::voronoi;
use granular_core::units::Length;
use granular_core::{D2, D3, Dim, FieldSink, Location, Shown, Simulation, Solver, Vector};
use granular_dem::{CoarseGrid, Dem};
use granular_io::Frame;
use std::any::Any;

/// Shown beside the fields of a grid: what lies beyond it.
const OUTSIDE: &str = "mass_outside";

/// Cells over which grains are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Grid {
    Plane(CoarseGrid<D2>),
    Space(CoarseGrid<D3>),
}

/// Why there is no grid: key of the scene, value, and what is allowed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NoGrid {
    pub(crate) key: &'static str,
    pub(crate) value: String,
    pub(crate) allowed: String,
}

impl Grid {
    /// For the grains of a solver.
    ///
    /// # Errors
    /// When the solver has no grains, or a value is out of range.
    pub(crate) fn of(spec: &GridSpec, solver: &dyn Solver) -> Result<Self, NoGrid> {
        let any: &dyn Any = solver;
        if any.is::<Dem<D2>>() {
            grid(spec).map(Self::Plane)
        } else if any.is::<Dem<D3>>() {
            grid(spec).map(Self::Space)
        } else {
            let value = format!("given for `{}`, whose fields are on a grid already", solver.name());
            Err(NoGrid { key: "grid", value, allowed: "no grid, or a scene of grains".to_owned() })
        }
    }

    pub(crate) fn location(&self) -> Location<'static> {
        match self {
            Self::Plane(grid) => grid.location(),
            Self::Space(grid) => grid.location(),
        }
    }

    /// Names and meanings of the fields.
    pub(crate) fn shown(solver: &dyn Solver) -> Vec<Shown> {
        let mut list = Dem::<D3>::coarse_catalogue();
        list.extend(voronoi::shown_on_grid(solver));
        list
    }

    fn show(&self, solver: &dyn Solver, free_surface: f64, sink: &mut dyn FieldSink) {
        let any: &dyn Any = solver;
        match self {
            Self::Plane(grid) => {
                if let Some(dem) = any.downcast_ref::<Dem<D2>>() {
                    dem.show_coarse(grid, sink);
                    voronoi::show_on_grid(grid, solver, free_surface, sink);
                }
            }
            Self::Space(grid) => {
                if let Some(dem) = any.downcast_ref::<Dem<D3>>() {
                    dem.show_coarse(grid, sink);
                }
            }
        }
    }
}

fn grid<D: Dim>(spec: &GridSpec) -> Result<CoarseGrid<D>, NoGrid> {
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
    CoarseGrid::new(from, to, spec.spacing.value(), spec.width).map_err(|error| {
        let key = match error.what.split(' ').next() {
            Some("spacing" | "cells") => "grid.spacing",
            Some("width") => "grid.width",
            _ => "grid.to",
        };
        NoGrid { key, value: error.value.to_string(), allowed: format!("{}: {}", error.what, error.allowed) }
    })
}

/// Where fields come from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    /// Cells over which grains are averaged; without, the places of the solver.
    grid: Option<Grid>,
    /// Voronoi cells larger than this many times the mean are free surface.
    free_surface: f64,
}

impl Source {
    /// Of an output; the check has refused what cannot be.
    pub(super) fn of(spec: Option<&GridSpec>, free_surface: f64, simulation: &Simulation) -> Self {
        let grid = spec.and_then(|spec| Grid::of(spec, simulation.solver()).ok());
        Self { grid, free_surface }
    }

    pub(super) fn location<'a>(&self, simulation: &'a Simulation) -> Location<'a> {
        match &self.grid {
            None => simulation.solver().location(),
            Some(grid) => grid.location(),
        }
    }

    /// Collects fields; with those of a grid, the mass that lies beyond it.
    pub(super) fn frame(&self, names: &[String], simulation: &Simulation) -> Frame {
        let names = names.iter().map(String::as_str);
        match &self.grid {
            None => {
                let mut frame = Frame::wanting(names);
                simulation.solver().show(&mut frame);
                voronoi::show(simulation.solver(), self.free_surface, &mut frame);
                frame
            }
            Some(grid) => {
                let mut frame = Frame::wanting(names.chain([OUTSIDE]));
                grid.show(simulation.solver(), self.free_surface, &mut frame);
                frame
            }
        }
    }
}
