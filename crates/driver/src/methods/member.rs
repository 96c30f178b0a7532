//! What a method hands the driver: a solver of the simulation, and all that is asked of it.

use super::Part;
use crate::column::ColumnSize;
use crate::failure::Failure;
use crate::records::PushRecord;
use crate::scene::{GridSpec, Scene};
use granular_core::{FieldSink, Location, Numbers, Shown, ShownAs, Simulation, Solver};
use granular_tessellate::FREE_SURFACE;
use std::fmt::{self, Debug};
use std::path::Path;

/// A solver of a scene. It owns the typed key of its solver and speaks for it.
pub trait Member: Send + Sync {
    /// Name of the solver in the scene.
    fn name(&self) -> &str;

    /// The solver.
    fn solver<'a>(&self, simulation: &'a Simulation) -> &'a dyn Solver;

    /// Whether its method uses this part of a scene.
    fn offers(&self, part: Part) -> bool;

    /// Makes the changes at the start of a stage.
    fn begin(&self, simulation: &mut Simulation, stage: usize) -> Notes;

    /// What [`Member::begin`] will do that is worth telling before, a line each.
    fn announced(&self, simulation: &Simulation, stage: usize) -> Vec<String> {
        let _ = (simulation, stage);
        Vec::new()
    }

    /// All that it can show at the places of the solver.
    fn shown(&self, simulation: &Simulation) -> Vec<Shown> {
        self.solver(simulation).shown()
    }

    /// Shows what a sink wants; works out nothing else. Cells of a tessellation larger than `free_surface` times the mean are
    /// no part of the bulk.
    fn show(&self, simulation: &Simulation, free_surface: f64, sink: &mut dyn FieldSink) {
        let _ = free_surface;
        self.solver(simulation).show(sink);
    }

    /// One number that it shows.
    fn number(&self, simulation: &Simulation, name: &str) -> Option<f64> {
        let mut numbers = Numbers::wanting([name]);
        self.show(simulation, FREE_SURFACE, &mut numbers);
        numbers.get(name)
    }

    /// All that it can show on a grid over which it is averaged; nothing for a solver that has a grid of its own.
    fn shown_on_grids(&self, simulation: &Simulation) -> Vec<Shown> {
        let _ = simulation;
        Vec::new()
    }

    /// Averages over the cells of a grid.
    ///
    /// # Errors
    /// When the solver is not averaged, or the grid makes no sense.
    fn averages(&self, spec: &GridSpec) -> Result<Box<dyn Averages>, NoGrid> {
        let _ = spec;
        let value = format!("given for `{}`, whose fields are on a grid already", self.name());
        Err(NoGrid { key: "grid", value, allowed: "no grid, or a scene of grains".to_owned() })
    }

    /// Whether the last value of a number belongs to the result of a run.
    fn is_metric(&self, number: &str) -> bool;

    /// Numbers that the figure of energies draws: those that there are, and losses.
    fn energies(&self) -> &'static [&'static str] {
        &["potential_energy", "kinetic_energy"]
    }

    /// What the progress of a run says of it: the number that tells soonest whether all is well.
    fn progress(&self, simulation: &Simulation) -> String;

    /// Step that the scene chose \[s\].
    fn time_step(&self) -> Option<f64> {
        None
    }

    /// Tells the simulation the step that the scene chose, when it shares a long one with others.
    fn choose_step(&self, simulation: &mut Simulation) {
        let _ = simulation;
    }

    /// Size of the column that the sample is.
    fn column(&self) -> Option<ColumnSize> {
        None
    }

    /// What a check says of a scene that can be run, and of which little will come.
    fn warnings(&self, scene: &Scene, simulation: &Simulation) -> Vec<String> {
        let _ = (scene, simulation);
        Vec::new()
    }

    /// Why the scene cannot run with these steps of its stages \[s\].
    fn refusals(&self, scene: &Scene, steps: &[f64]) -> Vec<String> {
        let _ = (scene, steps);
        Vec::new()
    }

    /// What costs nothing since the scene does not ask for it.
    fn left_out(&self, scene: &Scene, simulation: &Simulation) -> Vec<String> {
        let _ = (scene, simulation);
        Vec::new()
    }

    /// Whether the run may come to nothing in the present stage: then [`Member::why_gone`] is asked now and then.
    fn may_be_gone(&self, simulation: &Simulation) -> bool {
        let _ = simulation;
        false
    }

    /// Why there is nothing left to see.
    fn why_gone(&self, simulation: &Simulation) -> Option<String> {
        let _ = simulation;
        None
    }

    /// Saves the state as a sample for other scenes.
    ///
    /// # Errors
    /// When the file cannot be written.
    fn save_sample(&self, scene: &Scene, simulation: &Simulation, path: &Path) -> Result<(), Failure> {
        let _ = (scene, simulation);
        Err(Failure::io(path.display(), format!("`{}` has no sample to save", self.name())))
    }
}

impl fmt::Debug for dyn Member {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Member").field(&self.name()).finish()
    }
}

/// What happened at the start of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Notes {
    /// What pushes did, if there were any.
    pub push: Option<PushRecord>,
}

/// Means over the cells of a grid.
pub trait Averages: Debug + Send {
    /// The grid.
    fn location(&self) -> Location<'static>;
    /// Shows what a sink wants of the fields; see [`Member::show`].
    fn show(&self, simulation: &Simulation, free_surface: f64, sink: &mut dyn FieldSink);
}

/// Why there is no grid: key of the scene, value, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoGrid {
    /// Key below `write` of an output.
    pub key: &'static str,
    /// What stands there.
    pub value: String,
    /// What may.
    pub allowed: String,
}

/// A number or field that a method adds to those of its solver: name, unit, meaning.
#[derive(Clone, Copy, Debug)]
pub struct Number(pub &'static str, pub &'static str, pub &'static str);

impl Number {
    /// As an entry of a list.
    pub fn shown(self, kind: ShownAs) -> Shown {
        let Self(name, unit, meaning) = self;
        Shown::new(name, unit, meaning, kind)
    }
}
