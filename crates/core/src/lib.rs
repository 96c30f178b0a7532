//! What the solvers of the granular workspace share: dimensions, neighbour search, sums with
//! the same bits for any number of threads, values with units, and the contract that every
//! solver keeps.
//!
//! A solver is used alone or inside a [`Simulation`]:
//!
//! ```
//! use granular_core::{Blocks, D2, Dim, Linear};
//!
//! // The same bits for any number of threads: block sizes come from the data.
//! let disks = [0.5e-3, 0.6e-3, 0.7e-3];
//! let area = Blocks::new(disks.len(), 64).sum(|i| D2::ball_volume(disks[i]));
//! assert!((area - std::f64::consts::PI * 1.10e-6).abs() < 1e-18);
//!
//! // Tangential quantities are kept as cross products with the contact normal.
//! let normal = glam::DVec2::X;
//! let slip = D2::cross(normal, glam::DVec2::new(3.0, 2.0));
//! assert_eq!(D2::turn(slip, normal), glam::DVec2::new(0.0, 2.0));
//! assert!(slip.is_finite());
//! ```

mod ball;
pub mod blocks;
pub mod clock;
pub mod coarse;
pub mod dim;
pub mod exchange;
pub mod field;
pub mod grid;
pub mod matrix;
pub mod observer;
pub mod push;
pub mod quantity;
pub mod random;
pub mod search;
mod setup_error;
pub mod shape;
pub mod simulation;
pub mod snapshot;
pub mod solver;
pub mod tensor;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
pub mod units;
pub mod walls;

pub use blocks::{Blocks, PerBlock};
pub use clock::StepClock;
pub use dim::{D2, D3, Dim, Linear, Spin, Vector};
pub use exchange::{Accepts, Coupling, CouplingError, Provides, Quantity};
pub use field::{FieldRef, FieldSink, Location, Numbers, Shown, ShownAs};
pub use glam;
pub use grid::RegularGrid;
pub use matrix::Matrix;
pub use observer::{Every, Flow, Observer, ObserverError, Scheduled};
pub use quantity::{
    CoveredFluid, FlowLoad, FlowLoads, GrainMotion, Grains, HydroLoad, ImmersedGrain, ImmersedGrains, Load,
    LoadsMut, Motion, ObstacleMotion,
};
pub use setup_error::SetupError;
pub use shape::Shape;
pub use simulation::{Clock, CouplingView, Ending, NodeKey, RunError, Simulation};
pub use snapshot::{EntrySink, Section, SnapshotError, Stored};
pub use solver::{Bound, Limits, Memory, Solver, StepError, StepLimit, StepRule};
pub use tensor::SymmetricTensor;
pub use walls::WallMotion;
