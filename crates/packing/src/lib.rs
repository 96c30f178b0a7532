//! Samples of grains: sizes from a grading curve, places from ballistic deposition or a lattice,
//! and a measure of how even the packing is.
//!
//! # Equations
//!
//! A [`Grading`] is a curve $F(d)$, the share of the area (plane) or volume (space) in grains
//! finer than $d$: $F = I_x(a, b)$ with $x = (d - d_{min}) / (d_{max} - d_{min})$
//! \[Kumar2014, eq. 3.53-3.57\], or $F = x$ (equal mass per interval, \[Kumar2014, eq. 3.59\]).
//! Grains are drawn by number, $p(d) \propto F'(d) / d^N$ on $N$ axes.
//!
//! [`ballistic`] drops disks one by one; each rolls down by steepest descent until its centre
//! lies between two supports \[Vold1959\]. [`homogeneity`] is the variance of the void ratio
//! over bands of 2.5 median diameters, $S = \frac{1}{N-1} \sum_i (e - e_i)^2$
//! \[Kumar2014, eq. 3.61\].
//!
//! # Example
//!
//! ```
//! use granular_core::D2;
//! use granular_packing::{Bands, Grading, Sides, ballistic, homogeneity, solid_fraction_bands};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (width, seed) = (46e-3, 1); // 40 mean diameters
//! let grading = Grading::Beta { min: 0.92e-3, max: 1.38e-3, a: 4.0, b: 4.0 };
//! let radii = grading.sample::<D2>(3000, seed)?;
//! let deposit = ballistic(&radii, width, Sides::Periodic, seed)?;
//!
//! let top = deposit.positions.iter().map(|position| position.y).fold(0.0, f64::max);
//! let bands = Bands::of_grains::<D2>(&radii, width, 5e-3, top - 5e-3)?;
//! let solid = solid_fraction_bands::<D2>(&deposit.positions, &radii, &bands)?;
//! assert!(solid.iter().all(|fraction| (0.75..0.88).contains(fraction)));
//! assert!(homogeneity(&solid)? < 0.05);
//! # Ok(())
//! # }
//! ```
//!
//! # Options
//!
//! | choice | meaning | source |
//! |---|---|---|
//! | [`Grading::Single`] | one size | |
//! | [`Grading::Beta`] | beta curve by area or volume | \[Kumar2014, eq. 3.53-3.57\] |
//! | [`Grading::EqualMass`] | same mass in every interval of diameter | \[Kumar2014, eq. 3.59, 3.60\] |
//! | [`Lattice::Cubic`], [`Lattice::Hexagonal`] | regular packings of one size | \[Kumar2014, section 3.5.5\] |
//! | [`ballistic`] with [`Sides::Walls`] or [`Sides::Periodic`] | random packing of disks | \[Vold1959, MeakinJullien1985\] |
//! | [`scattered`] | start of a compression in a cell, plane and space | |
//! | [`loose_lattice`] | start of a deposition under gravity, plane and space | \[Kumar2014, section 3.5.5\] |
//!
//! # Limits
//!
//! - [`ballistic`] is for the plane: in space use [`loose_lattice`] and let a solver settle it.
//! - Its packing is stable grain by grain under gravity, but not in equilibrium: forces on the
//!   lower grains come later, so let it relax in a solver before use.
//! - Densities are what the method gives (about 0.82 for disks of one size), not a target. Equal
//!   disks repeat the gaps of their first layers all the way up: the density scatters from
//!   seed to seed however high the pile is, and less in a wide box.
//! - The random numbers of a seed are the same on every machine, and so are the bits of
//!   [`ballistic`] and of the order of a sample; radii use `exp` and `ln` of the platform and
//!   may differ in the last place between platforms.

mod ballistic;
mod bands;
mod beta;
mod bulk;
mod error;
mod grading;
mod lattice;
mod loose;
mod random;
mod scattered;

pub use ballistic::{Deposit, Sides, Support, ballistic};
pub use bands::{BAND_OVER_MEDIAN_DIAMETER, Bands, homogeneity, solid_fraction_bands};
pub use beta::regularised_incomplete_beta;
pub use bulk::Bulk;
pub use error::{GradingError, PackingError};
pub use grading::{Grading, finer_by_volume, median_diameter};
pub use lattice::Lattice;
pub use loose::loose_lattice;
pub use scattered::scattered;
