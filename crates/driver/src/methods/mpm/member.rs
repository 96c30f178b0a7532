//! A continuum as a member of a simulation.

use super::stages::{self, Action};
use crate::column::ColumnSize;
use crate::methods::contract::{Building, Claims};
use crate::methods::member::{Member, Notes};
use crate::methods::parts::Part;
use crate::problems::Problems;
use granular_core::units::Time;
use granular_core::{Dim, NodeKey, Simulation, Solver};
use granular_mpm::Mpm;
use granular_mpm::spec::MpmSpec;
use std::sync::Arc;

/// The continuum of a scene.
pub(super) struct Continuum<D: Dim> {
    name: String,
    key: NodeKey<Mpm<D>>,
    /// What happens at the start of each stage, in their order.
    stages: Vec<Vec<Action<D>>>,
    column: Option<ColumnSize>,
    time_step: Option<f64>,
}

/// What a scene makes of a continuum, besides the solver.
type Made<D> = (Vec<Vec<Action<D>>>, Option<ColumnSize>, Option<Time>);

impl<D: Dim> Continuum<D> {
    /// Adds a solver to a simulation.
    pub(super) fn add(
        name: &str,
        mpm: Mpm<D>,
        (stages, column, time_step): Made<D>,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>> {
        let key = match simulation.add(name, mpm) {
            Ok(key) => key,
            Err(error) => {
                problems.add("solvers", error.place, error.reason, "");
                return None;
            }
        };
        let time_step = time_step.map(|step| step.value());
        Some(Arc::new(Self { name: name.to_owned(), key, stages, column, time_step }))
    }
}

/// Energies of a continuum, for the figure of them.
const ENERGIES: &[&str] = &[
    "potential_energy",
    "kinetic_energy",
    "elastic_energy",
    "loss_plastic",
    "loss_viscous",
    "loss_sliding_at_walls",
    "loss_stopping_at_walls",
    "loss_local_damping",
    "loss_pic",
    "energy_residual",
];

impl<D: Dim> Member for Continuum<D> {
    fn name(&self) -> &str {
        &self.name
    }

    fn solver<'a>(&self, simulation: &'a Simulation) -> &'a dyn Solver {
        simulation.get::<Mpm<D>>(self.key)
    }

    fn offers(&self, part: Part) -> bool {
        MpmSpec::PARTS.contains(&part)
    }

    fn begin(&self, simulation: &mut Simulation, stage: usize) -> Notes {
        let mpm = simulation.get_mut(self.key);
        self.stages[stage].iter().for_each(|action| stages::apply(action, mpm));
        Notes::default()
    }

    fn is_metric(&self, number: &str) -> bool {
        ["front", "height", "energy_residual"].contains(&number)
    }

    fn energies(&self) -> &'static [&'static str] {
        ENERGIES
    }

    fn progress(&self, simulation: &Simulation) -> String {
        let fastest = self.number(simulation, "max_speed");
        fastest.map_or(String::new(), |speed| format!("fastest {speed:.3} m/s"))
    }

    fn time_step(&self) -> Option<f64> {
        self.time_step
    }

    fn choose_step(&self, simulation: &mut Simulation) {
        if let Some(step) = self.time_step {
            simulation.choose_step(self.key, step);
        }
    }

    fn column(&self) -> Option<ColumnSize> {
        self.column
    }
}
