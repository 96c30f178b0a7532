//! What a simulation is made of.

use crate::grains::Grain;
use crate::material::{Materials, PairProperties, SetupError, Tension};
use crate::walls::Wall;
use granular_core::Dim;

/// Where a contact force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LeverArm {
    /// At the middle of the overlap: angular momentum is kept to round-off.
    #[default]
    Exact,
    /// At the radius, as in the thesis \[Kumar2014, eq. 3.43\]: angular momentum is off by the
    /// overlap over the radius.
    Radius,
}

/// How the normal force grows with the overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactModel {
    /// In proportion: springs of [`Material::normal_stiffness`](crate::Material).
    #[default]
    Linear,
    /// Elastic spheres, from [`Material::elasticity`](crate::Material): see
    /// [`HertzNormal`](crate::HertzNormal), also for what that means for disks.
    Hertz,
}

/// How the tangential spring of two spheres is carried along when they turn about their normal. Spheres that roll over each
/// other carry it with the normal in either case; disks have nothing to turn about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpringTurning {
    /// It turns about the normal with the mean spin of the two: a pair that turns as one keeps the force in its own frame.
    #[default]
    MeanSpin,
    /// It does not turn about the normal, as in codes that only lay it into the new tangent plane: the
    /// force of a pair that turns as one then turns against it.
    NormalOnly,
}

/// Choices of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How the normal force grows with the overlap.
    pub contact: ContactModel,
    /// Whether parting contacts may pull.
    pub tension: Tension,
    /// Where a contact force acts.
    pub lever_arm: LeverArm,
    /// How tangential springs of spheres turn about the normal.
    pub spring_turning: SpringTurning,
    /// Whether losses of energy are integrated. Costs a few per cent; off unless asked for.
    pub ledger: bool,
    /// Steps in the shortest contact time, for the recommended step.
    pub steps_per_contact: f64,
    /// Longest reach of the neighbour lists over the mean diameter. Lists of slow grains are shorter. It changes the
    /// speed, never the forces.
    pub skin: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            contact: ContactModel::Linear,
            tension: Tension::Cut,
            lever_arm: LeverArm::Exact,
            spring_turning: SpringTurning::MeanSpin,
            ledger: false,
            steps_per_contact: 25.0,
            skin: 0.25,
        }
    }
}

/// All that makes a simulation.
#[derive(Clone, Debug)]
pub struct Setup<D: Dim> {
    /// Materials of grains and walls.
    pub materials: Materials,
    /// Grains; their index is their stable identifier.
    pub grains: Vec<Grain<D>>,
    /// Walls.
    pub walls: Vec<Wall<D>>,
    /// Gravity \[m/s^2\].
    pub gravity: D::Vec,
    /// Choices of the method.
    pub options: Options,
}

pub(crate) fn check_options(options: &Options, gravity_is_finite: bool) -> Result<(), SetupError> {
    let fits = |value: f64| value.is_finite() && value > 0.0;
    if !fits(options.steps_per_contact) || options.steps_per_contact < 1.0 {
        return Err(SetupError::new("steps per contact", options.steps_per_contact, "at least 1"));
    }
    if !fits(options.skin) {
        return Err(SetupError::new("skin", options.skin, "positive and finite"));
    }
    if !gravity_is_finite {
        return Err(SetupError::new("gravity", f64::NAN, "finite"));
    }
    Ok(())
}

/// Every material has what the contact model asks for.
pub(crate) fn check_stiffness(materials: &Materials, contact: ContactModel) -> Result<(), SetupError> {
    let given = |(.., pair): (usize, usize, PairProperties)| pair.normal_damping.or(pair.tangential_damping);
    if let (ContactModel::Hertz, Some(damping)) = (contact, materials.pairs().find_map(given)) {
        return Err(SetupError::new(
            "damping given for a pair",
            damping,
            "left out: contacts are those of Hertz",
        ));
    }
    for material in materials.iter() {
        match contact {
            ContactModel::Linear if material.normal_stiffness <= 0.0 => {
                return Err(SetupError::new("normal stiffness", 0.0, "positive: contacts are linear"));
            }
            ContactModel::Hertz if material.elasticity.is_none() => {
                return Err(SetupError::new("young modulus", 0.0, "positive: contacts are those of Hertz"));
            }
            _ => {}
        }
    }
    Ok(())
}
