//! Constitutive laws: the stress at a particle after an increment of strain.
//!
//! A law is a value of [`ConstitutiveLaw`]. Stress is a symmetric 3x3 tensor \[Pa\], positive in tension; in plane strain its
//! component across the plane is kept too. Laws know no solver and no grid.
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
