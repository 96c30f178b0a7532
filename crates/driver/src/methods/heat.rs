//! Heat on a periodic square: a toy method that shows all that a method takes. It is part of tests only.

mod solver;
pub(crate) mod spec;
mod tests;

use super::contract::{Building, Claims, Method};
use super::member::{Member, Notes};
use super::parts::Part;
use crate::problems::Problems;
use crate::scene::Scene;
use granular_core::{NodeKey, Simulation, Solver};
use solver::Heat;
use spec::HeatSpec;
use std::sync::Arc;

impl Claims for HeatSpec {
    const PARTS: &'static [Part] = &[];
    const STEP_KEY: &'static str = "cells";
}

impl Method for HeatSpec {
    fn build(
        &self,
        _: &Scene,
        name: &str,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>> {
        if self.cells < 4 {
            problems.add(format!("solvers.{name}.cells"), self.cells, "4 or more", "");
        }
        if self.diffusivity <= 0.0 {
            problems.add(format!("solvers.{name}.diffusivity"), self.diffusivity, "above 0", "");
        }
        if !problems.0.is_empty() {
            return None;
        }
        let heat = Heat::new(self.size.value(), self.cells, self.diffusivity);
        let key = simulation.add(name, heat).ok()?;
        Some(Arc::new(Plate { name: name.to_owned(), key }))
    }
}

/// The square as a member of a simulation.
struct Plate {
    name: String,
    key: NodeKey<Heat>,
}

impl Member for Plate {
    fn name(&self) -> &str {
        &self.name
    }

    fn solver<'a>(&self, simulation: &'a Simulation) -> &'a dyn Solver {
        simulation.get::<Heat>(self.key)
    }

    fn offers(&self, part: Part) -> bool {
        HeatSpec::PARTS.contains(&part)
    }

    fn begin(&self, _: &mut Simulation, _: usize) -> Notes {
        Notes::default()
    }

    fn progress(&self, simulation: &Simulation) -> String {
        format!("largest temperature {:.3}", simulation.get(self.key).largest())
    }

    fn is_metric(&self, number: &str) -> bool {
        number == "largest_temperature"
    }
}
