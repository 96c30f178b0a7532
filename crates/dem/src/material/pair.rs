//! Contacts between two materials that are stated instead of mixed.

use super::{Material, PairProperties, SetupError};

/// What is stated of the contact between two materials; the rest is mixed.
///
/// ```
/// use granular_dem::{Material, Materials, PairOverride};
///
/// let mut materials = Materials::new();
/// let steel = materials.add(Material { friction: 0.2, ..Material::default() })?;
/// let rubber = materials.add(Material { friction: 0.5, ..Material::default() })?;
/// materials.set_pair(steel, rubber, PairOverride { friction: Some(0.8), ..PairOverride::default() })?;
/// assert_eq!(materials.pair(0, 1).friction, 0.8);
/// assert_eq!(materials.pair(0, 1).restitution, 0.75);
/// # Ok::<(), granular_dem::material::SetupError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairOverride {
    /// Normal stiffness \[N/m\], for linear contacts.
    pub normal_stiffness: Option<f64>,
    /// Tangential over normal stiffness \[-\] of linear contacts.
    pub stiffness_ratio: Option<f64>,
    /// Coefficient of restitution \[-\], between 0 (excluded) and 1.
    pub restitution: Option<f64>,
    /// Tangential over normal damping coefficient \[-\].
    pub damping_ratio: Option<f64>,
    /// Damping of the normal dashpot \[N s/m\] of linear contacts, whatever the masses, in place of the one that follows from
    /// the restitution.
    pub normal_damping: Option<f64>,
    /// Damping of the tangential dashpot \[N s/m\] of linear contacts, in place of the ratio to the normal one.
    pub tangential_damping: Option<f64>,
    /// Coulomb friction \[-\].
    pub friction: Option<f64>,
    /// Rolling resistance \[-\].
    pub rolling_friction: Option<f64>,
    /// Twisting resistance \[-\].
    pub twisting_friction: Option<f64>,
}

impl PairOverride {
    /// The mixed properties with what is stated in their place. A stated normal stiffness keeps the
    /// ratio of the stiffnesses.
    pub(super) fn over(&self, mixed: PairProperties) -> PairProperties {
        let normal_stiffness = self.normal_stiffness.unwrap_or(mixed.normal_stiffness);
        let tangential_stiffness = match self.stiffness_ratio {
            Some(ratio) => ratio * normal_stiffness,
            // The mixed value as it is where nothing is stated, without the round-off of a ratio.
            None if self.normal_stiffness.is_none() => mixed.tangential_stiffness,
            None if mixed.normal_stiffness > 0.0 => {
                normal_stiffness * (mixed.tangential_stiffness / mixed.normal_stiffness)
            }
            None => 0.0,
        };
        PairProperties {
            normal_stiffness,
            tangential_stiffness,
            restitution: self.restitution.unwrap_or(mixed.restitution),
            damping_ratio: self.damping_ratio.unwrap_or(mixed.damping_ratio),
            normal_damping: self.normal_damping,
            tangential_damping: self.tangential_damping,
            friction: self.friction.unwrap_or(mixed.friction),
            rolling_friction: self.rolling_friction.unwrap_or(mixed.rolling_friction),
            twisting_friction: self.twisting_friction.unwrap_or(mixed.twisting_friction),
            ..mixed
        }
    }

    /// Whether all values are in the ranges of a material.
    pub(super) fn check(&self) -> Result<(), SetupError> {
        let given =
            [("normal damping", self.normal_damping), ("tangential damping", self.tangential_damping)];
        for (what, value) in given {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value >= 0.0)) {
                return Err(SetupError::new(what, value, "zero or more, and finite"));
            }
        }
        let usual = Material { normal_stiffness: 1.0, elasticity: None, ..Material::default() };
        super::check(&Material {
            normal_stiffness: self.normal_stiffness.unwrap_or(usual.normal_stiffness),
            stiffness_ratio: self.stiffness_ratio.unwrap_or(usual.stiffness_ratio),
            restitution: self.restitution.unwrap_or(usual.restitution),
            damping_ratio: self.damping_ratio.unwrap_or(usual.damping_ratio),
            friction: self.friction.unwrap_or(usual.friction),
            rolling_friction: self.rolling_friction.unwrap_or(usual.rolling_friction),
            twisting_friction: self.twisting_friction.unwrap_or(usual.twisting_friction),
            ..usual
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Materials;

    fn two() -> (Materials, [crate::MaterialId; 2]) {
        let mut materials = Materials::new();
        let soft = Material { normal_stiffness: 1e5, stiffness_ratio: 0.5, ..Material::default() };
        let hard = Material { normal_stiffness: 3e5, friction: 0.2, ..Material::default() };
        let ids = [materials.add(soft).unwrap(), materials.add(hard).unwrap()];
        (materials, ids)
    }

    #[test]
    fn what_is_not_stated_stays_mixed_to_the_bit() {
        let (mut materials, [soft, hard]) = two();
        let mixed = materials.pair(0, 1);
        materials.set_pair(soft, hard, PairOverride::default()).unwrap();
        assert_eq!(materials.pair(0, 1), mixed);
        let stated = PairOverride { restitution: Some(0.3), ..PairOverride::default() };
        materials.set_pair(hard, soft, stated).unwrap();
        assert_eq!(materials.pair(1, 0), PairProperties { restitution: 0.3, ..mixed });
        // The last word holds, and other pairs are left alone.
        let stated = PairOverride { normal_stiffness: Some(8e5), ..PairOverride::default() };
        materials.set_pair(soft, hard, stated).unwrap();
        let pair = materials.pair(0, 1);
        assert_eq!((pair.normal_stiffness, pair.restitution), (8e5, mixed.restitution));
        let ratios = [pair, mixed].map(|pair| pair.tangential_stiffness / pair.normal_stiffness);
        assert!((ratios[0] - ratios[1]).abs() < 1e-15, "{ratios:?}");
        let (untouched, _) = two();
        assert_eq!(materials.pair(0, 0), untouched.pair(0, 0));
        let stated = PairOverride { stiffness_ratio: Some(0.0), ..PairOverride::default() };
        materials.set_pair(soft, hard, stated).unwrap();
        assert_eq!(materials.pair(0, 1), PairProperties { tangential_stiffness: 0.0, ..mixed });
    }

    #[test]
    fn friction_follows_its_materials_unless_it_is_stated() {
        let (mut materials, [soft, hard]) = two();
        let rolling = PairOverride { rolling_friction: Some(0.1), ..PairOverride::default() };
        materials.set_pair(soft, hard, rolling).unwrap();
        materials.set_friction(hard, 0.0);
        assert_eq!((materials.pair(0, 1).friction, materials.pair(0, 1).rolling_friction), (0.0, 0.1));
        materials.set_pair(soft, hard, PairOverride { friction: Some(0.9), ..rolling }).unwrap();
        materials.set_friction(soft, 0.0);
        assert_eq!(materials.pair(0, 1).friction, 0.9);
    }

    #[test]
    fn values_out_of_range_are_refused_and_change_nothing() {
        let (mut materials, [soft, hard]) = two();
        let mixed = materials.pair(0, 1);
        let none = PairOverride::default();
        for (stated, what) in [
            (PairOverride { friction: Some(-0.1), ..none }, "friction"),
            (PairOverride { restitution: Some(1.1), ..none }, "restitution"),
            (PairOverride { restitution: Some(f64::NAN), ..none }, "restitution"),
            (PairOverride { normal_stiffness: Some(0.0), ..none }, "normal stiffness"),
            (PairOverride { stiffness_ratio: Some(-1.0), ..none }, "stiffness ratio"),
            (PairOverride { twisting_friction: Some(f64::INFINITY), ..none }, "twisting friction"),
        ] {
            assert_eq!(materials.set_pair(soft, hard, stated).unwrap_err().what, what);
        }
        assert_eq!(materials.pair(0, 1), mixed);
    }
}
