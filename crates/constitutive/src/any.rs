//! One type for all laws of this crate, for programs that choose a law at run time.

use crate::element::{ElementError, ElementTest, Path, run};
use crate::law::{ConstitutiveLaw, Kept};
use crate::{
    Bingham, DruckerPrager, LinearElastic, LinearFriction, MohrCoulomb, MuI, Newtonian, NorSand,
    SaturatingFriction,
};

/// Code that is compiled for each law; [`AnyLaw::visit`] calls it with the one at hand. A solver so gets a kernel of its own for each law, and asks
/// which law it is once, not once per particle.
pub trait LawVisitor {
    /// What it returns.
    type Output;

    /// Called with the law.
    fn visit<L: ConstitutiveLaw>(self, law: &L) -> Self::Output;
}

macro_rules! laws {
    ($($(#[$about:meta])* $variant:ident($law:ty), $name:literal;)*) => {
        /// Any law of this crate.
        #[derive(Clone, Copy, Debug, PartialEq)]
        // A program has a few of them.
        #[allow(clippy::large_enum_variant)]
        pub enum AnyLaw {
            $($(#[$about])* $variant($law),)*
        }

        impl AnyLaw {
            /// Name of the law.
            pub const fn name(&self) -> &'static str {
                match self { $(Self::$variant(_) => $name,)* }
            }

            /// Calls the visitor with the law.
            pub fn visit<V: LawVisitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$variant(law) => visitor.visit(law),)* }
            }

            /// The numbers that a particle remembers.
            pub const fn kept(&self) -> &'static [Kept] {
                match self { $(Self::$variant(_) => <$law as ConstitutiveLaw>::KEPT,)* }
            }
        }

        $(impl From<$law> for AnyLaw {
            fn from(law: $law) -> Self {
                Self::$variant(law)
            }
        })*
    };
}

laws! {
    /// Linear elasticity.
    LinearElastic(LinearElastic), "linear elastic";
    /// Mohr-Coulomb.
    MohrCoulomb(MohrCoulomb), "Mohr-Coulomb";
    /// Mohr-Coulomb with a tensile strength.
    MohrCoulombWithCut(MohrCoulomb<true>), "Mohr-Coulomb with a tensile strength";
    /// Drucker-Prager.
    DruckerPrager(DruckerPrager), "Drucker-Prager";
    /// mu(I) with friction in proportion to I.
    LinearMuI(MuI<LinearFriction>), "linear mu(I)";
    /// mu(I) with bounded friction.
    MuI(MuI<SaturatingFriction>), "mu(I)";
    /// NorSand.
    NorSand(NorSand), "NorSand";
    /// Newtonian fluid.
    Newtonian(Newtonian), "Newtonian";
    /// Bingham fluid.
    Bingham(Bingham), "Bingham";
}

impl AnyLaw {
    /// Leads the material along a path: see [`element::run`](crate::element::run).
    ///
    /// # Errors
    /// When a stress that is prescribed cannot be reached, or the stress is not finite.
    pub fn run(&self, path: &Path) -> Result<ElementTest, ElementError> {
        struct Run<'a>(&'a Path);
        impl LawVisitor for Run<'_> {
            type Output = Result<ElementTest, ElementError>;
            fn visit<L: ConstitutiveLaw>(self, law: &L) -> Self::Output {
                run(law, self.0)
            }
        }
        self.visit(Run(path))
    }

    /// Speed \[m/s\] of the fastest wave at a density \[kg/m^3\].
    pub fn wave_speed(&self, density: f64) -> f64 {
        struct Speed(f64);
        impl LawVisitor for Speed {
            type Output = f64;
            fn visit<L: ConstitutiveLaw>(self, law: &L) -> f64 {
                law.wave_speed(self.0)
            }
        }
        self.visit(Speed(density))
    }

    /// Greatest dynamic viscosity \[Pa s\]; zero for solids.
    pub fn greatest_viscosity(&self) -> f64 {
        struct Viscosity;
        impl LawVisitor for Viscosity {
            type Output = f64;
            fn visit<L: ConstitutiveLaw>(self, law: &L) -> f64 {
                law.greatest_viscosity()
            }
        }
        self.visit(Viscosity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Strength;

    #[test]
    fn a_law_chosen_at_run_time_is_the_law() {
        let elastic = LinearElastic::new(1e6, 0.25).unwrap();
        let sand = MohrCoulomb::new(elastic, Strength::of_friction(0.5)).unwrap();
        let any = AnyLaw::from(sand);
        let path = Path::triaxial_compression(1e4, 0.05).in_increments(20);
        assert_eq!(any.run(&path), run(&sand, &path));
        assert_eq!((any.name(), any.kept()), ("Mohr-Coulomb", <MohrCoulomb as ConstitutiveLaw>::KEPT));
        assert_eq!(any.wave_speed(2000.0), elastic.compression_speed(2000.0));
        assert_eq!(any.greatest_viscosity(), 0.0);
    }
}
