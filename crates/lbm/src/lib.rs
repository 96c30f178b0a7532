//! Lattice Boltzmann method in the plane ([`Lbm2`], D2Q9) and in space ([`Lbm3`], D3Q19), one
//! lattice updated in place.
//!
//! Populations `f_i` of fluid that moves along `c_i` collide and move on \[Kumar2014, section 5.1; Qian1992\]:
//!
//! ```text
//! f_i(x + c_i dt, t + dt) = f_i - w+ (f_i - f_i^eq)^+ - w- (f_i - f_i^eq)^- + F_i
//! f_i^eq = w_i rho (1 + 3 c_i.u + 9/2 (c_i.u)^2 - 3/2 u.u)
//! p = rho c_s^2,  c_s = h / (sqrt(3) dt),  nu = (tau - 1/2) c_s^2 dt,  w+ = 1/tau
//! ```
//!
//! which solves the Navier-Stokes equations to second order in the cell `h` and in the Mach number.
//!
//! ```
//! use granular_core::{Solver, glam::DVec2};
//! use granular_lbm::{Face, Lbm2, Setup};
//!
//! // Water between plates 9 mm apart, driven by a body force: the parabola is exact.
//! let mut setup = Setup::new([4, 9, 1], 1e-3, 1e-6, 0.9);
//! setup.faces[1] = [Face::REST, Face::REST];
//! setup.acceleration = DVec2::new(1e-6, 0.0);
//! let dt = setup.time_step;
//! let mut water = Lbm2::new(setup)?;
//! water.advance(dt, 4000)?;
//! let peak = 1e-6 * 9e-3_f64.powi(2) / (8.0 * 1e-6);
//! let middle = water.flow([2, 4, 0]).expect("fluid").velocity.x;
//! assert!((middle / peak - 1.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | option | choices | source |
//! |---|---|---|
//! | [`Operator`] | one, two or multiple relaxation times, regularised | \[Qian1992; Ginzburg2008; Lallemand2000; DHumieres2002; LattChopard2006\] |
//! | eddy viscosity | Smagorinsky in closed form, `(C h)^2 sqrt(2 S:S)` | \[Hou1996\] |
//! | body force | second order, relaxed by the same rates; constant, or varying in space and time ([`BodyForce`]) | \[Guo2002\] |
//! | [`Face`] | periodic, wall at rest, moving or with a profile of velocities, slip length, free slip, velocity, pressure, absorbing | \[ZouHe1997; HechtHarting2010; Latt2008; PoinsotLele1992; IzquierdoFueyo2008\] |
//! | [`Obstacle`] | any [`SolidShape`], also from an image ([`Bitmap`]) or around the fluid ([`Hole`]); half-way or interpolated wall | \[Bouzidi2001; Yu2003\] |
//! | number type | `f64`, `f32` | |
//!
//! [`Setup::for_flow`] finds cells and step from length, speed, viscosity and resolution; [`Lbm::flow_field`] gives pressure and
//! velocity of all cells; [`Lbm::set_obstacle_motion`] and [`Lbm::set_face_velocity`] change motions by name.
//!
//! Obstacles move when a motion is lent to the fluid (`Accepts<ObstacleMotion>`), as by a coupling. Open faces bear less than
//! the fluid within: in a stream of 0.1
//! cells per step, [`Operator::EXACT_WALLS`] needs a relaxation time of 0.55 beside any of them, the default 0.53; [`Operator::Regularised`]
//! needs 0.53 where fluid leaves through a velocity, and in the plane 0.505 where it leaves through a pressure. A sudden
//! start between pressures leaves a momentum of alternating sign from cell to cell and step to step that nothing damps
//! (3/2 of the pressure drop per cell, in lattice units): start from the pressure at rest with
//! [`Lbm::set_flow`], or take the mean over two steps.

// Components and directions index several arrays at once.
#![allow(clippy::needless_range_loop)]

mod absorbing;
mod advice;
mod bitmap;
mod body_force;
mod boundary;
mod choice;
mod collision;
mod edges;
mod flow_field;
mod gauge;
#[cfg(feature = "png")]
mod image;
mod immersed;
mod immersion;
mod kernel;
mod lattice;
mod lbm;
mod links;
mod mass;
mod moving;
mod named;
mod obstacle;
mod open;
mod openings;
mod pages;
mod pair;
mod populations;
mod probes;
mod real;
mod relax;
mod rows;
mod saturated;
mod scales;
mod setup;
mod show;
mod solver;
#[cfg(feature = "serde")]
pub mod spec;
mod wall_faces;

pub use advice::Sloshing;
pub use bitmap::{Bitmap, Solid};
pub use body_force::BodyForce;
pub use collision::{OddRate, Operator};
pub use flow_field::FlowField;
pub use gauge::Gauge;
pub use granular_core::shape::{Ball, Block, Extruded, Hole, Polygon, ShapeError, SolidShape};
pub use lattice::{D2Q9, D3Q19, Lattice, opposite};
pub use lbm::{Flow, Lbm};
pub use links::WallScheme;
pub use obstacle::{Obstacle, Reference};
pub use open::OpenScheme;
pub use pages::Pages;
pub use real::Real;
pub use scales::FlowScales;
pub use setup::{Face, PressureLevel, Profile, Setup, SetupError};

/// A fluid in the plane, per metre of depth.
pub type Lbm2 = Lbm<D2Q9, 9>;
/// A fluid in space.
pub type Lbm3 = Lbm<D3Q19, 19>;

// Vectors and the solver contract, so that this crate alone is enough to use its solver.
pub use granular_core;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
