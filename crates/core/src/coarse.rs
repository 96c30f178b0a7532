//! Fields of a continuum from grains or other particles, on a grid: coarse graining after \[Goldhirsch2010\], with walls after
//! \[Weinhart2012\].
//!
//! A kernel `w` spreads every grain over a few cells. With mass `m`, velocity `v` and place `x` of grains, forces `f` on
//! the first of two bodies and branches `b` from the second to the first,
//!
//! ```text
//! density           rho(r) = sum m w(r - x)
//! momentum          p(r)   = sum m v w(r - x),     velocity V = p / rho
//! kinetic stress    s_k(r) = sum m (v - V)(v - V) w(r - x)
//! contact stress    s_c(r) = sum f b  int_0^1 w(r - x_2 - s b) ds
//! force of walls    t(r)   = sum f w(r - c),       c the point of contact
//! ```
//!
//! These fields fulfil the balances of mass and momentum at every point and time,
//!
//! ```text
//! d rho/dt + div p = 0        dp/dt + div(rho V V) = -div(s_c + s_k) + rho g + t
//! ```
//!
//! whatever the kernel, as long as it is smooth; stresses are positive in compression. At a wall the branch runs from
//! the point of contact to the grain.
//!
//! **The kernel** is the product of one cubic B-spline per axis whose knots lie on the cells: its scale is a whole number
//! of cells. It is chosen because it is the smoothest of the short kernels for which all of this holds at once:
//!
//! - values in the cells sum to one for any place of a grain (splines on a grid are a partition of unity), so that mass
//!   and momentum in cells are exactly those of the grains, and so is the sum of `f b`; no weight is corrected, which
//!   would break the balances above;
//! - it has two continuous derivatives, so that gradients of velocity are continuous;
//! - along a branch it is a polynomial of degree 9 at most between planes through the centres of cells; Gauss-Legendre
//!   quadrature with five points integrates that exactly;
//! - it ends at two scales from the grain, and is nearly the same in all directions: it differs from a normal
//!   distribution of deviation 0.577 scales by less than 4 % of its maximum.
//!
//! What a kernel spreads beyond the grid is not lost silently: it is shown as `mass_outside`.
//!
//! **A periodic cell** goes on without end: the grid sees every image of a grain and of a branch that reaches into it, so a
//! grid over the cell holds all of its mass, also where the cell leans. Velocities are those of the laboratory,
//! `u + L x` with the flow of the cell, so that gradients are those of the flow; what shear makes of velocities within the
//! reach of a kernel counts as spread about the mean here as everywhere.
//!
//! **A continuum** of particles that carry stresses themselves (material points, smoothed particles) is seen in the same
//! way: [`CoarseSource::stress`] takes the place of contacts. Its solid fraction and its inertial number need the grains that it
//! stands for ([`Constituents`]).
//!
//! ```
//! use granular_core::coarse::{CoarseFields, CoarseGrid, CoarseSource, Sizes};
//! use granular_core::{D2, glam::DVec2};
//!
//! let source = CoarseSource::<D2> {
//!     position: &[DVec2::new(0.0123, 0.0045)],
//!     velocity: vec![DVec2::X].into(),
//!     mass: &[8e-3],
//!     size: Sizes::Radii(&[1e-3]),
//!     periods: None,
//!     stress: vec![].into(),
//!     constituents: None,
//!     visit_branches: &|_| {},
//!     longest_branch: 0.0,
//! };
//! let grid = CoarseGrid::new(DVec2::ZERO, DVec2::splat(0.02), 1e-3, 2)?;
//! let fields = CoarseFields::of(&source, &grid);
//! let mass: f64 = fields.density().iter().map(|density| density * grid.cell_volume()).sum();
//! assert!((mass / 8e-3 - 1.0).abs() < 1e-14);
//! # Ok::<(), granular_core::SetupError>(())
//! ```

mod catalogue;
mod fields;
mod grid;
mod images;
mod source;
mod spline;
mod sums;
#[cfg(test)]
mod tests;

pub use fields::CoarseFields;
pub use grid::CoarseGrid;
pub use source::{CoarseSource, Constituents, ForceBranch, Periods, Sizes, VisitBranches};
