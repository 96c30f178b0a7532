//! Discrete element method for disks ([`Dem2`]) and spheres ([`Dem3`]), from one source.
//!
//! Solves Newton's equations of translation and rotation \[Kumar2014, eq. 3.28-3.31\]
//!
//! ```text
//! m x'' = sum F + m g        I w' = sum l x F
//! ```
//!
//! with contacts that are linear springs and dashpots or those of elastic spheres (Hertz and
//! Mindlin), Coulomb friction with a tangential spring, and optional resistance against rolling
//! and twisting. The scheme is of second order in time with damping, and contact entry
//! and exit included (see [`law::Kinematics`]).
//!
//! ```
//! use granular_dem::{Dem2, Grain, Material, Materials, Options, Setup, Wall};
//! use granular_core::{Solver, glam::DVec2};
//!
//! let mut materials = Materials::new();
//! let glass = materials.add(Material { restitution: 0.5, ..Material::default() })?;
//! let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass)?;
//! let grain = Grain::at(DVec2::new(0.0, 0.101), 1e-3, glass); // 0.1 m above the floor
//! let mut dem = Dem2::new(Setup {
//!     materials,
//!     grains: vec![grain],
//!     walls: vec![floor],
//!     gravity: DVec2::new(0.0, -9.81),
//!     options: Options::default(),
//! })?;
//! let dt = dem.recommended_step();
//! let fall = (2.0_f64 * 0.1 / 9.81).sqrt();
//! dem.advance(dt, (1.25 * fall / dt) as u64)?; // fall, bounce, and half of the way up
//! assert!((dem.grain(0).velocity.y - (0.5 - 0.25) * 9.81 * fall).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batch;

mod choice;
pub mod coarse;
mod contact;
mod contacts;
mod dem;
mod grains;
mod inlets;
mod kinematics;
pub mod law;
mod ledger;
mod limits;
mod lists;
mod loads;
pub mod material;
mod motion;
mod pass;
pub mod periodic;
mod push;
mod setup;
mod shaking;
mod show;
mod softness;
#[cfg(feature = "serde")]
pub mod spec;
mod state;

mod view;
pub mod walls;

pub use contact::{Contact, Partner};
pub use dem::{Dem, OtherBody};
pub use grains::Grain;
pub use granular_core::coarse::{CoarseFields, CoarseGrid};
pub use granular_core::push::{Push, PushProfile, Strength};
pub use granular_core::shape::{Facets, Shape};
pub use granular_core::walls::{PressureBetween, Servo, WallMotion};
pub use inlets::{Exchanged, Inlet, Outlet, STEPS_PER_LOOK};
pub use law::{
    ContactLaw, ContactLoad, HertzMindlin, HertzNormal, Kinematics, LawLimits, LinearFrictional,
    LinearNormal, LinearRolling, MaterialLaw, Rolling, Twisting,
};
pub use ledger::{Losses, Tally};
pub use limits::stability_step;
pub use material::{
    Elasticity, HertzImpact, Material, MaterialId, Materials, PairOverride, PairProperties, SetupError,
    Tension,
};
pub use periodic::{CellControl, Control, Matrix, PeriodicCell};
pub use push::Pushed;
pub use setup::{ContactModel, LeverArm, Options, Setup, SpringTurning};
pub use shaking::Shaking;
pub use show::Energies;
pub use walls::{Falling, Gates, Wall};

/// Disks in the plane, per metre of depth.
pub type Dem2 = Dem<granular_core::D2>;
/// Spheres in space.
pub type Dem3 = Dem<granular_core::D3>;

// Vectors and the solver contract, so that this crate alone is enough to use its solver.
pub use granular_core;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The snippet of the README of the workspace.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct WorkspaceReadme;
