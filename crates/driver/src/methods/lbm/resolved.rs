//! Free grains of the same scene in a fluid.

#[cfg(feature = "dem")]
mod grains;
#[cfg(feature = "dem")]
pub(super) use grains::couple;

/// Without grains there are none.
#[cfg(not(feature = "dem"))]
pub(super) fn couple<L: granular_lbm::Lattice<Q>, T: granular_lbm::Real, const Q: usize>(
    _: &crate::scene::Scene,
    _: &str,
    _: granular_core::NodeKey<granular_lbm::Lbm<L, Q, T>>,
    _: &mut crate::methods::contract::Building,
    _: &mut crate::problems::Problems,
) -> Option<()> {
    Some(())
}
