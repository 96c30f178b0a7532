//! Where the fields of an output come from: the places of a solver, or a grid over which it is averaged.

use crate::methods::member::{Averages, Member};
use crate::scene::GridSpec;
use granular_core::{Location, Simulation};
use granular_io::Frame;
use std::sync::Arc;

/// Shown beside the fields of a grid: what lies beyond it.
const OUTSIDE: &str = "mass_outside";

/// Where fields come from.
#[derive(Debug)]
pub(super) struct Source {
    member: Arc<dyn Member>,
    /// Cells over which the solver is averaged; without, its own places.
    grid: Option<Box<dyn Averages>>,
    /// Voronoi cells larger than this many times the mean are free surface.
    free_surface: f64,
}

impl Source {
    /// Of an output; the check has refused what cannot be.
    pub(super) fn of(spec: Option<&GridSpec>, free_surface: f64, member: Arc<dyn Member>) -> Self {
        let grid = spec.and_then(|spec| member.averages(spec).ok());
        Self { member, grid, free_surface }
    }

    pub(super) fn location<'a>(&self, simulation: &'a Simulation) -> Location<'a> {
        match &self.grid {
            None => self.member.solver(simulation).location(),
            Some(grid) => grid.location(),
        }
    }

    /// Collects fields; with those of a grid, the mass that lies beyond it.
    pub(super) fn frame(&self, names: &[String], simulation: &Simulation) -> Frame {
        let names = names.iter().map(String::as_str);
        match &self.grid {
            None => {
                let mut frame = Frame::wanting(names);
                self.member.show(simulation, self.free_surface, &mut frame);
                frame
            }
            Some(grid) => {
                let mut frame = Frame::wanting(names.chain([OUTSIDE]));
                grid.show(simulation, self.free_surface, &mut frame);
                frame
            }
        }
    }
}
