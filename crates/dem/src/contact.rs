//! A contact as outputs see it.

use crate::kinematics::push_of;
use crate::law::{ContactLaw, Kinematics};
use granular_core::Dim;

/// A contact between steps, for output.
#[derive(Clone, Copy, Debug)]
pub struct Contact<D: Dim> {
    /// Index of the first grain in memory.
    pub first: usize,
    /// The second body.
    pub partner: Partner,
    /// From the centre of the second grain, or of its image, to that of the first \[m\]; from the nearest
    /// point of a wall.
    pub branch: D::Vec,
    /// Edges of the periodic cell by which the image of the second grain is away from it; zeros for an
    /// ordinary pair.
    pub shift: [i8; 3],
    /// Unit vector from the second body to the first.
    pub normal: D::Vec,
    /// Overlap \[m\]; negative where a law with a reach acts on surfaces that are apart.
    pub overlap: f64,
    /// Force along the normal \[N\].
    pub normal_force: f64,
    /// Force on the first body \[N\].
    pub force: D::Vec,
    /// Torque of rolling and twisting resistance on the first body \[N m\]; the second gets the opposite.
    pub torque: D::Spin,
    /// Energy stored in the springs \[J\].
    pub energy: f64,
    /// Tangential spring as `normal x` the displacement of the first body past the second \[m\]; zero for laws without one.
    /// In this form it is the same seen from either body.
    pub spring: D::Spin,
}

impl<D: Dim> Contact<D> {
    /// Displacement \[m\] of the first body past the second that the tangential spring holds.
    pub fn tangential_displacement(&self) -> D::Vec {
        D::turn(self.spring, self.normal)
    }
}

/// The second body of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// A grain, by its index in memory.
    Grain(usize),
    /// A wall, by its index.
    Wall(usize),
}

/// Overlap between steps \[m\].
pub(crate) fn overlap_of<D: Dim, L: ContactLaw<D>>(kinematics: &Kinematics<D>) -> f64 {
    if L::REACHES { -kinematics.gap } else { kinematics.overlap }
}

/// Whether there is a contact between steps.
pub(crate) fn ongoing<D: Dim, L: ContactLaw<D>>(
    law: &L,
    kinematics: &Kinematics<D>,
    memory: &L::Memory,
) -> bool {
    kinematics.overlap > 0.0 || (L::REACHES && law.acts(kinematics.gap, memory))
}

/// A contact as outputs see it.
pub(crate) fn contact_of<D: Dim, L: ContactLaw<D>>(
    law: &L,
    kinematics: &Kinematics<D>,
    memory: L::Memory,
    (first, partner): (usize, Partner),
    branch: D::Vec,
) -> Contact<D> {
    let (load, energy) = law.at_rest(kinematics, memory);
    Contact {
        first,
        partner,
        branch,
        shift: [0; 3],
        normal: kinematics.normal,
        overlap: overlap_of::<D, L>(kinematics),
        normal_force: load.normal,
        force: push_of::<D, L>(&load, kinematics.normal),
        torque: load.rolling,
        energy,
        spring: law.spring(kinematics, &memory),
    }
}
