//! Couplings between solvers of granular flows.
//!
//! A law here knows no solver: it is written against what one provides and another accepts, and so serves
//! grains of the discrete element method and bodies on prescribed paths alike.
//!
//! | law | from | to |
//! |---|---|---|
//! | [`CarriedObstacles`] | motion of grains | obstacles of a fluid |
//! | [`ResolvedGrains`] | motion of grains | grains in a fluid, and back: its loads on them |
//!
//! [`PrescribedMotion`] is a solver whose bodies follow [`Path`]s known beforehand. A disk that oscillates in water:
//!
//! ```
//! use granular_core::Simulation;
//! use granular_core::glam::DVec2;
//! use granular_coupling::{Body, CarriedObstacles, Path, PrescribedMotion};
//! use granular_lbm::{Ball, Lbm2, Obstacle, Setup};
//!
//! let centre = DVec2::new(0.02, 0.02);
//! let mut setup = Setup::new([40, 40, 1], 1e-3, 1e-6, 0.8);
//! setup.obstacles.push(Obstacle::new("disk", Ball { centre, radius: 4e-3 }));
//! let dt = setup.time_step;
//! let path = Path::Oscillation { amplitude: DVec2::new(2e-3, 0.0), frequency: 0.1, phase: 0.0 };
//! let disk = PrescribedMotion::new(vec![Body::new(centre, 4e-3, path)])?;
//!
//! let mut simulation = Simulation::named("water", Box::new(Lbm2::new(setup)?));
//! let water = simulation.find::<Lbm2>("water").expect("it was named so");
//! let disk = simulation.add("disk", disk)?;
//! simulation.couple(water, disk, CarriedObstacles::all())?;
//! simulation.begin_segment(dt)?;
//! simulation.advance(5)?;
//! assert!(simulation.get(water).force_on(0).x < 0.0); // the water resists
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod carried;
mod middle;
mod path;
mod prescribed;
mod resolved;

pub use carried::CarriedObstacles;
pub use path::{Body, Path, PathError};
pub use prescribed::PrescribedMotion;
pub use resolved::{HeldLoad, ResolvedGrains, ResolvedOptions};
