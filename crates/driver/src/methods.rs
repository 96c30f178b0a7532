//! Methods: what solves a scene.
//!
//! A method is one folder here and one line in the table below. Outside its folder no file of the driver names its solver
//! crate: the rest of the driver asks a [`Method`] what it uses of a scene, lets it build a solver, and asks the [`Member`]
//! that comes of it for all that outputs, figures and reports show. `docs/adding-a-solver.md` leads through it.

pub(crate) mod couplings;
#[cfg(feature = "dem")]
pub(crate) mod dem;
#[cfg(test)]
mod heat;
#[cfg(feature = "lbm")]
pub(crate) mod lbm;
mod member;
mod off;
mod parts;

#[cfg(feature = "dem")]
pub(crate) use dem::{GrainSpec, MaterialSpec, PairSpec};
pub use member::{Averages, Member, NoGrid, Notes, Number};
pub(crate) use off::explain;
#[cfg(not(feature = "dem"))]
pub(crate) use off::{GrainSpec, MaterialSpec, PairSpec};
pub use parts::Part;
pub(crate) use parts::{given, refuse_unused};

use crate::model::Problems;
use crate::scene::Scene;
use granular_core::{CouplingError, Limits, NodeKey, Simulation, Solver};
use schemars::JsonSchema;
use serde::Deserialize;
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

/// The table of methods: the name that scenes use, what it says, and the type that is read of a scene.
macro_rules! methods {
    ($($(#[doc = $doc:literal])+ $(#[cfg($condition:meta)])? $name:ident($spec:ty),)+) => {
        /// The method that solves the scene.
        #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
        pub enum SolverSpec {
            $($(#[doc = $doc])+ $(#[cfg($condition)])? $name($spec),)+
        }

        impl SolverSpec {
            /// The method, of whatever kind.
            pub fn method(&self) -> &dyn Method {
                match self {
                    $($(#[cfg($condition)])? Self::$name(method) => method,)+
                }
            }

            /// What the method is called in a scene.
            pub fn name(&self) -> &'static str {
                match self {
                    $($(#[cfg($condition)])? Self::$name(_) => stringify!($name),)+
                }
            }

            /// Parts of a scene that the method uses.
            pub fn parts(&self) -> &'static [Part] {
                match self {
                    $($(#[cfg($condition)])? Self::$name(_) => <$spec as Claims>::PARTS,)+
                }
            }

            /// Key below the name of the solver by which its step is chosen.
            pub fn step_key(&self) -> &'static str {
                match self {
                    $($(#[cfg($condition)])? Self::$name(_) => <$spec as Claims>::STEP_KEY,)+
                }
            }
        }

        /// All methods of this program: names, and parts of a scene that they use.
        pub fn all() -> Vec<(&'static str, &'static [Part])> {
            vec![$($(#[cfg($condition)])? (stringify!($name), <$spec as Claims>::PARTS),)+]
        }
    };
}

methods! {
    /// Discrete element method, for grains.
    #[cfg(feature = "dem")]
    Dem(dem::DemSpec),
    /// Lattice Boltzmann method, for a fluid.
    #[cfg(feature = "lbm")]
    Lbm(lbm::LbmSpec),
    /// Heat on a grid: a toy that shows what a method takes.
    #[cfg(test)]
    Heat(heat::HeatSpec),
}

/// Methods that this program was built without, and the cargo feature of each.
pub fn left_out() -> Vec<(&'static str, &'static str)> {
    let known = all();
    let is_off = |(name, _): &(&str, &str)| !known.iter().any(|(other, _)| other == name);
    [("Dem", "dem"), ("Lbm", "lbm")].into_iter().filter(is_off).collect()
}
