//! Materials, and what two of them make of a contact.

mod elasticity;
mod pair;

pub use elasticity::{Elasticity, HertzImpact};
pub use pair::PairOverride;

pub use granular_core::SetupError;

/// What a grain or wall is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Mass per area and metre of depth, or per volume \[kg/m^3\]. Walls ignore it.
    pub density: f64,
    /// Normal stiffness between two bodies of this material \[N/m\], for linear contacts. May be
    /// zero where elastic constants are given.
    pub normal_stiffness: f64,
    /// Elastic constants, for Hertz contacts.
    pub elasticity: Option<Elasticity>,
    /// Tangential over normal stiffness \[-\] of linear contacts.
    pub stiffness_ratio: f64,
    /// Coefficient of restitution of a normal impact \[-\], between 0 (excluded) and 1.
    pub restitution: f64,
    /// Tangential over normal damping coefficient \[-\].
    pub damping_ratio: f64,
    /// Coulomb friction \[-\].
    pub friction: f64,
    /// Rolling resistance \[-\]: largest rolling moment over normal force and effective radius.
    pub rolling_friction: f64,
    /// Twisting resistance \[-\]: largest moment about the normal over normal force and effective
    /// radius. Disks cannot twist.
    pub twisting_friction: f64,
}

impl Default for Material {
    /// Glass beads as in table 4.2 of \[Kumar2014\], with a stiffness that gives overlaps of
    /// 0.1 % of the diameter under the weight of a column instead of far less.
    fn default() -> Self {
        Self {
            density: 2650.0,
            normal_stiffness: 1.6e6,
            elasticity: None,
            stiffness_ratio: 1.0,
            restitution: 0.75,
            damping_ratio: 0.5,
            friction: 0.53,
            rolling_friction: 0.0,
            twisting_friction: 0.0,
        }
    }
}

/// What happens where the dashpot of a parting contact would pull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tension {
    /// The force is cut at zero: contacts never attract \[SchwagerPoeschel2007\].
    #[default]
    Cut,
    /// The force is kept, and the contact ends where the overlap does.
    Kept,
}

/// The properties of a contact between two materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairProperties {
    /// Normal stiffness \[N/m\].
    pub normal_stiffness: f64,
    /// Tangential stiffness \[N/m\].
    pub tangential_stiffness: f64,
    /// Coefficient of restitution \[-\].
    pub restitution: f64,
    /// Tangential over normal damping coefficient \[-\].
    pub damping_ratio: f64,
    /// Damping of the normal dashpot \[N s/m\] of linear contacts, in place of the one that follows from the restitution.
    pub normal_damping: Option<f64>,
    /// Damping of the tangential dashpot \[N s/m\] of linear contacts, in place of the ratio to the normal one.
    pub tangential_damping: Option<f64>,
    /// Coulomb friction \[-\].
    pub friction: f64,
    /// Rolling resistance \[-\].
    pub rolling_friction: f64,
    /// Twisting resistance \[-\].
    pub twisting_friction: f64,
    /// Effective modulus `E*` \[Pa\] of Hertz contacts; zero without elastic constants.
    pub effective_modulus: f64,
    /// Effective shear modulus `G*` \[Pa\] of Hertz contacts.
    pub effective_shear_modulus: f64,
}

impl PairProperties {
    /// Mixes two materials: springs act in series and are scaled so that equal materials keep
    /// their stiffness; elastic constants combine as [`Elasticity::effective`] says; of friction,
    /// rolling and twisting resistance and restitution the lower one holds.
    pub fn mix(a: &Material, b: &Material) -> Self {
        let series = |a: f64, b: f64| if a + b > 0.0 { 2.0 * a * b / (a + b) } else { 0.0 };
        let elastic = a.elasticity.zip(b.elasticity).map(|(a, b)| a.effective(&b));
        let (effective_modulus, effective_shear_modulus) = elastic.unwrap_or_default();
        Self {
            effective_modulus,
            effective_shear_modulus,
            twisting_friction: a.twisting_friction.min(b.twisting_friction),
            normal_stiffness: series(a.normal_stiffness, b.normal_stiffness),
            tangential_stiffness: series(
                a.normal_stiffness * a.stiffness_ratio,
                b.normal_stiffness * b.stiffness_ratio,
            ),
            restitution: a.restitution.min(b.restitution),
            damping_ratio: a.damping_ratio.min(b.damping_ratio),
            normal_damping: None,
            tangential_damping: None,
            friction: a.friction.min(b.friction),
            rolling_friction: a.rolling_friction.min(b.rolling_friction),
        }
    }

    /// Damping ratio zeta that gives the restitution asked for, for either treatment of tension.
    pub fn zeta(&self, tension: Tension) -> f64 {
        damping_for_restitution(self.restitution, tension)
    }

    /// Damping of the normal dashpot \[N s/m\] of a linear contact of this effective mass \[kg\].
    pub fn damping(&self, effective_mass: f64, tension: Tension) -> f64 {
        let of_restitution = || 2.0 * self.zeta(tension) * (self.normal_stiffness * effective_mass).sqrt();
        self.normal_damping.unwrap_or_else(of_restitution)
    }

    /// Contact time \[s\] of two bodies of this effective mass \[kg\].
    pub fn contact_time(&self, effective_mass: f64, tension: Tension) -> f64 {
        let critical = 2.0 * (self.normal_stiffness * effective_mass).sqrt();
        let zeta = self.normal_damping.map_or_else(|| self.zeta(tension), |damping| damping / critical);
        contact_phase(zeta, tension) / (self.normal_stiffness / effective_mass).sqrt()
    }
}

/// Restitution of a linear spring-dashpot of damping ratio `zeta` \[DEM-4 after
/// SchwagerPoeschel2007\]. With the tension kept, `e = exp(-pi zeta / w)`, `w = sqrt(1 -
/// zeta^2)`; with the tension cut the contact ends where the force vanishes, earlier:
/// `e = exp(-(zeta / w) phase)` with the phase of [`contact_phase`].
pub fn restitution_of_damping(zeta: f64, tension: Tension) -> f64 {
    match tension {
        Tension::Kept if zeta >= 1.0 => 0.0,
        _ => (-zeta * contact_phase(zeta, tension)).exp(),
    }
}

/// Contact time times the undamped frequency: `pi / w` with the tension kept, `2 acos(zeta) / w`
/// with it cut. From critical damping on, the cut form goes on as `2 acosh(zeta) / s`, `s =
/// sqrt(zeta^2 - 1)`; a kept contact never parts, and the undamped `pi` stands for its time scale.
pub fn contact_phase(zeta: f64, tension: Tension) -> f64 {
    let w = (1.0 - zeta * zeta).abs().sqrt();
    match tension {
        Tension::Kept if zeta < 1.0 => std::f64::consts::PI / w,
        Tension::Kept => std::f64::consts::PI,
        Tension::Cut if w < 1e-6 => 2.0,
        Tension::Cut if zeta < 1.0 => 2.0 * zeta.acos() / w,
        Tension::Cut => 2.0 * zeta.acosh() / w,
    }
}

/// Damping ratio that gives a restitution in (0, 1]: closed form with the tension kept,
/// bisection with it cut (restitution falls monotonously with damping).
pub fn damping_for_restitution(restitution: f64, tension: Tension) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    if tension == Tension::Kept {
        let log = restitution.ln();
        return -log / (std::f64::consts::PI.powi(2) + log * log).sqrt();
    }
    let (mut low, mut high) = (0.0, 1.0);
    while restitution_of_damping(high, tension) > restitution && high < 1e3 {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if restitution_of_damping(middle, tension) > restitution {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Materials by index, and the contacts between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    list: Vec<Material>,
    overrides: Vec<((u8, u8), PairOverride)>,
}

/// Index of a material in [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialId(pub(crate) u8);

impl MaterialId {
    /// The identifier of the material that was added after so many others.
    pub const fn of_index(index: u8) -> Self {
        Self(index)
    }

    /// How many materials were added before this one.
    pub fn index(self) -> usize {
        self.0.into()
    }
}

impl Materials {
    /// No materials.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material.
    ///
    /// # Errors
    /// When a value is out of its range, or there are 256 materials already.
    pub fn add(&mut self, material: Material) -> Result<MaterialId, SetupError> {
        check(&material)?;
        let index =
            u8::try_from(self.list.len()).map_err(|_| SetupError::new("materials", 257.0, "at most 256"))?;
        self.list.push(material);
        Ok(MaterialId(index))
    }

    /// States the contact between two materials, or what matters of it, instead of mixing it.
    ///
    /// # Errors
    /// When a value is out of its range.
    pub fn set_pair(&mut self, a: MaterialId, b: MaterialId, stated: PairOverride) -> Result<(), SetupError> {
        stated.check()?;
        let key = (a.0.min(b.0), a.0.max(b.0));
        self.overrides.retain(|(pair, _)| *pair != key);
        self.overrides.push((key, stated));
        Ok(())
    }

    /// Number of materials.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The material.
    pub fn get(&self, id: MaterialId) -> &Material {
        &self.list[id.0 as usize]
    }

    /// All materials, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = &Material> {
        self.list.iter()
    }

    /// Gives a material its normal stiffness \[N/m\], once the size of the grains is known.
    ///
    /// # Errors
    /// When it is not positive and finite.
    pub fn set_normal_stiffness(&mut self, id: MaterialId, stiffness: f64) -> Result<(), SetupError> {
        let material = &mut self.list[id.0 as usize];
        let changed = Material { normal_stiffness: stiffness, elasticity: None, ..*material };
        check(&changed)?;
        material.normal_stiffness = stiffness;
        Ok(())
    }

    /// Changes the friction of one material \[-\]; pairs whose friction is stated keep theirs.
    pub fn set_friction(&mut self, id: MaterialId, friction: f64) {
        self.list[id.0 as usize].friction = friction;
    }

    /// The contact between two materials.
    pub fn pair(&self, a: usize, b: usize) -> PairProperties {
        let key = (a.min(b) as u8, a.max(b) as u8);
        let mixed = PairProperties::mix(&self.list[a], &self.list[b]);
        let stated = self.overrides.iter().find(|(pair, _)| *pair == key);
        stated.map_or(mixed, |(_, stated)| stated.over(mixed))
    }

    /// All pairs, each once.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, PairProperties)> {
        let n = self.len();
        (0..n).flat_map(move |a| (a..n).map(move |b| (a, b))).map(|(a, b)| (a, b, self.pair(a, b)))
    }
}

fn check(material: &Material) -> Result<(), SetupError> {
    let positive = "positive and finite";
    let at_least_zero = "zero or more, and finite";
    let elastic = material.elasticity;
    let Elasticity { young_modulus, poisson_ratio } =
        elastic.unwrap_or(Elasticity { young_modulus: 1.0, poisson_ratio: 0.0 });
    let rules = [
        ("density", material.density, positive, material.density > 0.0),
        ("normal stiffness", material.normal_stiffness, positive, {
            material.normal_stiffness > 0.0 || (material.normal_stiffness == 0.0 && elastic.is_some())
        }),
        ("young modulus", young_modulus, positive, young_modulus > 0.0),
        ("poisson ratio", poisson_ratio, "above -1 and at most 0.5", {
            poisson_ratio > -1.0 && poisson_ratio <= 0.5
        }),
        ("stiffness ratio", material.stiffness_ratio, at_least_zero, material.stiffness_ratio >= 0.0),
        ("damping ratio", material.damping_ratio, at_least_zero, material.damping_ratio >= 0.0),
        ("friction", material.friction, at_least_zero, material.friction >= 0.0),
        ("rolling friction", material.rolling_friction, at_least_zero, material.rolling_friction >= 0.0),
        ("twisting friction", material.twisting_friction, at_least_zero, material.twisting_friction >= 0.0),
        ("restitution", material.restitution, "above 0 and at most 1", {
            material.restitution > 0.0 && material.restitution <= 1.0
        }),
    ];
    match rules.iter().find(|(_, value, _, fits)| !(*fits && value.is_finite())) {
        Some(&(what, value, allowed, _)) => Err(SetupError::new(what, value, allowed)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
