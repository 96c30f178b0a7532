//! Methods: what solves a scene.
//!
//! A method is one folder here and one line in the table (`table.rs`). Outside its folder no file of the driver names its solver
//! crate: the rest of the driver asks a [`Method`] what it uses of a scene, lets it build a solver, and asks the [`Member`]
//! that comes of it for all that outputs, figures and reports show. `docs/adding-a-solver.md` leads through it.

pub(crate) mod contract;
pub(crate) mod couplings;
#[cfg(feature = "dem")]
pub(crate) mod dem;
#[cfg(any(feature = "dem", feature = "mpm"))]
pub(crate) mod fronts;
#[cfg(any(feature = "dem", feature = "mpm"))]
pub(crate) mod grids;
#[cfg(test)]
mod heat;
#[cfg(feature = "lbm")]
mod lbm;
pub(crate) mod member;
#[cfg(feature = "mpm")]
pub(crate) mod mpm;
pub(crate) mod parts;
#[cfg(any(feature = "dem", feature = "mpm"))]
pub(crate) mod push;
pub(crate) mod specs;
mod table;
pub(crate) mod unused;

pub use contract::{Building, Claims, Method};
pub use member::{Averages, Member, NoGrid, Notes, Number};
pub use parts::Part;
pub use specs::{ContinuumSpec, GrainSpec, MaterialSpec, PairSpec, SolverSpec, left_out, names};

use table::methods;

macro_rules! dispatch {
    ($($(#[doc = $doc:literal])+ $name:ident($spec:ty) if $key:ident $(= $value:literal)?;)+) => {
        impl SolverSpec {
            /// The method, of whatever kind.
            pub fn method(&self) -> &dyn Method {
                match self {
                    $(#[cfg($key $(= $value)?)] Self::$name(method) => method,)+
                }
            }

            /// Parts of a scene that the method uses.
            pub fn parts(&self) -> &'static [Part] {
                match self {
                    $(#[cfg($key $(= $value)?)] Self::$name(_) => <$spec as Claims>::PARTS,)+
                }
            }

            /// Key below the name of the solver by which its step is chosen.
            pub fn step_key(&self) -> &'static str {
                match self {
                    $(#[cfg($key $(= $value)?)] Self::$name(_) => <$spec as Claims>::STEP_KEY,)+
                }
            }
        }

        /// All methods of this program: names, and parts of a scene that they use.
        pub fn all() -> Vec<(&'static str, &'static [Part])> {
            vec![$(#[cfg($key $(= $value)?)] (stringify!($name), <$spec as Claims>::PARTS),)+]
        }
    };
}
methods!(dispatch);
