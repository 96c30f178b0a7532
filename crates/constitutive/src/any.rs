//! All laws of this crate as one type.

use crate::{DruckerPrager, LinearElastic, MohrCoulomb};

/// One of the laws of this crate, chosen while a program runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyLaw {
    /// Linear elasticity.
    LinearElastic(LinearElastic),
    /// Mohr-Coulomb.
    MohrCoulomb(MohrCoulomb),
    /// Mohr-Coulomb with a tensile strength.
    MohrCoulombWithCut(MohrCoulomb<true>),
    /// Drucker-Prager.
    DruckerPrager(DruckerPrager),
}
