//! Material point method for soils that deform without bound.
//!
//! Particles carry mass, momentum and stress through a grid that is there for one step only. In each step they hand mass and
//! momentum to the nodes around them, nodes move by the forces of stresses, gravity and walls, and particles take from them how they move
//! and strain \[Sulsky1994\]. In plane strain and in space from one source; the same bits for any number of threads.
//!
//! ```
//! use granular_constitutive::LinearElastic;
//! use granular_core::{Solver, glam::DVec2};
//! use granular_mpm::{Condition, Mpm2, Particle, Setup, Wall};
//!
//! let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, Condition::frictional(0.4))?;
//! let gravity = DVec2::new(0.0, -9.81);
//! let mut mpm = Mpm2::new(Setup { gravity, walls: vec![floor], ..Setup::new(0.05) })?;
//! let jelly = LinearElastic::new(2e4, 0.3)?;
//! let column = Particle::filling(DVec2::ZERO, DVec2::new(0.5, 1.0), 0.0125); // 16 in a cell
//! mpm.body(jelly, 1000.0, &column)?;
//! let dt = mpm.recommended_step();
//! mpm.advance(dt, (0.2 / dt) as u64)?;
//! let base = mpm.wall_forces()[0]; // the column has sunk, and bounces on its base
//! assert!(base.y < 0.0 && mpm.energies().potential < 0.5 * 0.5 * 1000.0 * 9.81);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batch;
mod body;
mod changes;
mod choice;
mod coarse;
mod contact;
mod grid;
mod layout;
mod ledger;
mod limits;
mod load;
mod main_mass;
mod motion;
mod mpm;
mod nodes;
mod particle;
mod particles;
mod push;
mod setup;
mod shape;
mod show;
mod sorting;
#[cfg(feature = "serde")]
pub mod spec;
mod state;
mod step;
mod thin;
mod traction;
mod turning;
mod wall;

pub use choice::BodyLaw;
pub use contact::Contact;
pub use granular_core::push::{Push, PushProfile, Strength};
pub use granular_core::walls::WallMotion;
pub use ledger::{Energies, Losses};
pub use mpm::{BodyId, Mpm};
pub use particle::Particle;
pub use push::{Pushed, VelocityField};
pub use setup::{ObjectiveRate, Options, Scheme, Setup, ShapeFunctions, VelocityUpdate};
pub use wall::{Condition, Wall};

/// In the plane (plane strain), per metre of depth.
pub type Mpm2 = Mpm<granular_core::D2>;
/// In space.
pub type Mpm3 = Mpm<granular_core::D3>;

// Vectors and the solver contract, and laws, so that this crate alone is enough to use its solver.
pub use granular_constitutive;
pub use granular_core;
