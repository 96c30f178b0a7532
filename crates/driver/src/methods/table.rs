//! The table of methods.

/// Hands the table to a macro: what the method says, the name that scenes use, the type that is read of a scene, and when it is on.
macro_rules! methods {
    ($apply:ident) => {
        $apply! {
            /// Discrete element method, for grains.
            Dem(granular_dem::spec::DemSpec) if feature = "dem";
            /// Lattice Boltzmann method, for a fluid.
            Lbm(granular_lbm::spec::LbmSpec) if feature = "lbm";
            /// Material point method, for a continuum.
            Mpm(granular_mpm::spec::MpmSpec) if feature = "mpm";
            /// Heat on a grid: a toy that shows what a method takes.
            Heat(crate::methods::heat::spec::HeatSpec) if test;
        }
    };
}
pub(crate) use methods;
