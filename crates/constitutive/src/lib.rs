//! Constitutive laws: the stress at a particle after an increment of strain.
//!
//! A law is a value of [`ConstitutiveLaw`]. Stress is a symmetric 3x3 tensor \[Pa\], positive in tension; in plane strain its
//! component across the plane is kept too. Laws know no solver and no grid. Each says what work is stored and what is lost, and
//! remembers no more numbers than it needs.
//!
//! ```
//! use granular_constitutive::{ConstitutiveLaw, Increment, InPlane, LinearElastic};
//! use granular_core::SymmetricTensor;
//!
//! let rubber = LinearElastic::new(1e6, 0.3).unwrap();
//! let squeezed = Increment::of_strain(SymmetricTensor { yy: -1e-3, ..SymmetricTensor::ZERO });
//! let after = rubber.respond::<InPlane>(SymmetricTensor::ZERO, &mut [], &squeezed);
//! // Confined compression: the sides are pressed with nu / (1 - nu) of the axial stress.
//! assert!((after.stress.xx / after.stress.yy - 0.3 / 0.7).abs() < 1e-12);
//! ```
//!
//! | law | equation | remembers | source |
//! |---|---|---|---|
//! | [`LinearElastic`] | `d sigma = lambda tr(d eps) 1 + 2 G d eps` | nothing | |
//! | [`MohrCoulomb`] | `s1 - s3 <= -(s1 + s3) sin(phi) + 2 c cos(phi)`, and `s1 <= T` where it is cut | gap, plastic strain | \[Clausen2006\], \[DeSouzaNeto2008\] |
//! | [`DruckerPrager`] | `sqrt(J2) + A I1 <= B` | gap, plastic strain | \[DruckerPrager1952\] |
//! | [`MuI`] | `sqrt(J2) = mu(I) p`, linear or saturating, dry or in a liquid | gap, plastic strain | \[Jop2006\], \[DunatungaKamrin2015\] |
//! | [`NorSand`] | `q / p <= (M / N) (1 - (1 - N) (p / p_i)^(N / (1 - N)))` | gap, plastic strain, image pressure | \[Jefferies1993\], \[Robert2010\] |
//! | [`Newtonian`] | `sigma = -p 1 + 2 eta e'` | nothing | \[Monaghan1994\] |
//! | [`Bingham`] | the same with `eta = mu_B + tau_y (1 - exp(-m g)) / g` | nothing | \[Papanastasiou1987\] |
//!
//! [`rotation`] turns stress with the material, [`measures`] describes a state, [`element`] leads one point along a path of strains and
//! stresses, [`AnyLaw`] is any of these laws, and with the feature `serde` scenes name them (`spec`).
//!
//! Limits: rate form, so elastic strains are small; no hardening but that of NorSand; no anisotropy; pore pressure is the business of a solver. What
//! yields without hardening or rate localises in bands as wide as a cell.

mod any;
mod axes;
mod drucker_prager;
mod elastic;
pub mod element;
mod fluid;
mod gap;
mod law;
pub mod measures;
mod mohr_coulomb;
mod mu_i;
mod norsand;
pub mod rotation;
#[cfg(feature = "serde")]
pub mod spec;

pub use any::{AnyLaw, LawVisitor};
pub use axes::{Axes, InPlane, InSpace, Principal};
pub use drucker_prager::{ConeMatch, DruckerPrager};
pub use elastic::LinearElastic;
pub use fluid::{Bingham, Newtonian, Tait};
pub use granular_core;
pub use law::{ConstitutiveLaw, Increment, Kept, Memory, Response};
pub use mohr_coulomb::{MohrCoulomb, Strength};
pub use mu_i::{Grains, LinearFriction, MuI, RateFriction, SaturatingFriction};
pub use norsand::{NorSand, NorSandConstants, NorSandState, PressureElastic};
