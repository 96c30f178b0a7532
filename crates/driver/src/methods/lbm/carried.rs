//! Obstacles of a fluid that grains of the same scene carry.

#[cfg(feature = "dem")]
mod grains;
#[cfg(feature = "dem")]
pub(super) use grains::Carried;

/// Without grains there are none.
#[cfg(not(feature = "dem"))]
mod nothing {
    use crate::methods::contract::Building;
    use crate::problems::Problems;
    use crate::scene::Scene;
    use granular_core::{Dim, NodeKey};
    use granular_lbm::{Lattice, Lbm, Real, Setup};
    use std::marker::PhantomData;

    pub(crate) struct Carried<D>(PhantomData<D>);

    impl<D: Dim> Carried<D> {
        pub(crate) fn of(
            _: &Scene,
            _: &str,
            _: &mut Setup<D>,
            _: &mut Building,
            _: &mut Problems,
        ) -> Option<Vec<Self>> {
            Some(Vec::new())
        }

        pub(crate) fn couple<L: Lattice<Q, Dim = D>, T: Real, const Q: usize>(
            self,
            _: NodeKey<Lbm<L, Q, T>>,
            _: &mut Building,
            _: &mut Problems,
        ) -> Option<()> {
            Some(())
        }
    }
}
#[cfg(not(feature = "dem"))]
pub(super) use nothing::Carried;
