//! What a solver lends so that its particles can be seen as a continuum.

use crate::dim::Dim;
use crate::matrix::Matrix;
use crate::tensor::SymmetricTensor;
use std::borrow::Cow;

/// Sizes of particles.
#[derive(Clone, Copy, Debug)]
pub enum Sizes<'a> {
    /// Radii of balls \[m\].
    Radii(&'a [f64]),
    /// Areas \[m^2\] or volumes \[m^3\] of particles of no given shape; their diameter is that of a ball as large.
    Volumes(&'a [f64]),
}

impl Sizes<'_> {
    /// Area or volume, and diameter, of one particle.
    #[inline(always)]
    pub(super) fn of<D: Dim>(self, index: usize) -> (f64, f64) {
        match self {
            Self::Radii(radii) => (D::ball_volume(radii[index]), 2.0 * radii[index]),
            Self::Volumes(volumes) => {
                let unit = D::ball_volume(1.0);
                (volumes[index], 2.0 * (volumes[index] / unit).powf(1.0 / D::N as f64))
            }
        }
    }
}

/// Grains that the particles of a continuum stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constituents {
    /// Density of a grain \[kg/m^3\].
    pub density: f64,
    /// Diameter of the grains \[m\].
    pub diameter: f64,
}

/// A periodic cell: what is in it is repeated without end.
#[derive(Clone, Copy, Debug)]
pub struct Periods<D: Dim> {
    /// Edges \[m\], one per column; any along axes that are not periodic, as long as they span a volume.
    pub edges: Matrix<D>,
    /// Which axes are periodic.
    pub is_periodic: [bool; 3],
    /// Velocity gradient \[1/s\], with which images move.
    pub gradient: Matrix<D>,
}

/// A force between two bodies.
#[derive(Clone, Copy, Debug)]
pub struct ForceBranch<D: Dim> {
    /// Index of the first particle.
    pub first: usize,
    /// Index of the second particle; none for a wall.
    pub second: Option<usize>,
    /// Unit vector from the second body to the first.
    pub normal: D::Vec,
    /// Distance \[m\] along the normal from the second particle, or from the point of contact with a wall, to the first. It
    /// is laid from the first particle, so that a neighbour across a periodic side is met where it acts.
    pub length: f64,
    /// Force on the first \[N\].
    pub force: D::Vec,
}

/// Calls its argument with every force, in a fixed order.
pub type VisitBranches<'a, D> = dyn Fn(&mut dyn FnMut(ForceBranch<D>)) + Sync + 'a;

/// Particles and the forces between them: grains with contacts, or points of a continuum with stresses.
pub struct CoarseSource<'a, D: Dim> {
    /// Positions \[m\].
    pub position: &'a [D::Vec],
    /// Velocities \[m/s\], those of the laboratory.
    pub velocity: Cow<'a, [D::Vec]>,
    /// Masses \[kg\].
    pub mass: &'a [f64],
    /// Sizes.
    pub size: Sizes<'a>,
    /// The periodic cell, if there is one.
    pub periods: Option<Periods<D>>,
    /// Stress that each particle carries itself \[Pa\], positive in compression; empty for grains, whose stress is in the
    /// forces between them.
    pub stress: Cow<'a, [SymmetricTensor]>,
    /// Grains of a continuum, for its solid fraction and its inertial number; none for particles that are grains themselves, and
    /// where nobody says.
    pub constituents: Option<Constituents>,
    /// Calls back with every force between particles, or between a particle and a wall, in a fixed order.
    pub visit_branches: &'a VisitBranches<'a, D>,
    /// No branch is longer \[m\].
    pub longest_branch: f64,
}

impl<D: Dim> CoarseSource<'_, D> {
    /// What is seen on the grid.
    pub(super) fn kind(&self) -> Kind {
        match (self.stress.is_empty(), self.constituents) {
            (true, _) => Kind::Grains,
            (false, None) => Kind::Continuum,
            (false, Some(_)) => Kind::ContinuumOfGrains,
        }
    }

    /// Volume of the solid in a particle, and diameter.
    #[inline(always)]
    pub(super) fn solid(&self, index: usize) -> (f64, f64) {
        match self.constituents {
            Some(grains) => (self.mass[index] / grains.density, grains.diameter),
            None => self.size.of::<D>(index),
        }
    }
}

/// What particles are, which says what can be shown of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Grains with contacts.
    Grains,
    /// Particles with stresses.
    Continuum,
    /// Those, of grains that are known.
    ContinuumOfGrains,
}
