//! Where the fields of an output come from: the places of a solver, or a grid over which it is averaged.

use crate::methods::member::{Averages, Member};
use crate::scene::Writer;
use granular_core::{Location, Shown, Simulation};
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
    /// Name of the place of the solver where the fields live, if they are not averaged.
    place: &'static str,
    /// Voronoi cells larger than this many times the mean are free surface.
    free_surface: f64,
}

/// The place where the first of some fields lives; none when it is not shown.
pub(crate) fn place_of(names: &[String], shown: &[Shown]) -> Option<&'static str> {
    let first = names.first()?;
    shown.iter().find(|shown| shown.name == *first).map(|shown| shown.place)
}

impl Source {
    /// Of an output; the check has refused what cannot be.
    pub(super) fn of(write: &Writer, member: Arc<dyn Member>, simulation: &Simulation) -> Self {
        let grid = write.grid().and_then(|spec| member.averages(spec).ok());
        let place = place_of(write.names(), &member.shown(simulation)).unwrap_or_default();
        Self { member, grid, place, free_surface: write.free_surface() }
    }

    pub(super) fn location<'a>(&self, simulation: &'a Simulation) -> Location<'a> {
        match &self.grid {
            None => {
                let solver = self.member.solver(simulation);
                solver.place(self.place).unwrap_or_else(|| solver.location())
            }
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
