//! What a method does for the driver.

use super::member::Member;
use super::parts::Part;
use crate::problems::Problems;
use crate::scene::Scene;
use granular_core::{CouplingError, Limits, NodeKey, Simulation, Solver};
use std::sync::Arc;

/// What a method uses of a scene.
pub trait Claims {
    /// Parts that it uses. One that no method of a scene uses is refused in one place, with those that would.
    const PARTS: &'static [Part];
    /// Key below the name of the solver by which its step is chosen.
    const STEP_KEY: &'static str;
}

/// How a scene is solved. The value is what the scene says under the name of a solver.
pub trait Method {
    /// Adds a solver called `name` to the simulation. None when there are problems.
    fn build(
        &self,
        scene: &Scene,
        name: &str,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>>;

    /// Limits that can be told without building what takes long to build; none where all is quick.
    fn early_limits(&self, scene: &Scene, name: &str) -> Option<Limits> {
        let _ = (scene, name);
        None
    }
}

/// A simulation to which methods add their solvers.
#[derive(Debug, Default)]
pub struct Building(Option<Simulation>);

impl Building {
    /// Adds a solver.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn add<S: Solver>(&mut self, name: &str, solver: S) -> Result<NodeKey<S>, CouplingError> {
        match &mut self.0 {
            Some(simulation) => simulation.add(name, solver),
            None => {
                let simulation = self.0.insert(Simulation::named(name, Box::new(solver)));
                Ok(simulation.find(name).expect("the solver was just put there"))
            }
        }
    }

    /// A solver that was added before.
    pub fn find<S: Solver>(&self, name: &str) -> Option<NodeKey<S>> {
        self.0.as_ref()?.find(name)
    }

    /// The simulation so far.
    ///
    /// # Panics
    /// Before the first solver.
    pub fn simulation(&mut self) -> &mut Simulation {
        self.0.as_mut().expect("a solver was added before")
    }

    pub(crate) fn done(self) -> Option<Simulation> {
        self.0
    }
}
