//! What the passes over contacts read: grains at one instant, walls, and laws between materials.

use crate::law::ContactLaw;
use crate::periodic::PeriodicCell;
use crate::walls::Wall;
use granular_core::walls::Pose;
use granular_core::{Dim, Linear};

/// Overlap over the smaller radius at which contacts stop making sense.
pub(crate) const DEEPEST: f64 = 0.5;

/// What the kernels read: grains at one instant, with walls and step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a, D: Dim> {
    pub(crate) position: &'a [D::Vec],
    pub(crate) velocity: &'a [D::Vec],
    pub(crate) spin: &'a [D::Spin],
    /// Velocity and spin at the start of the step, which move the grains up to its middle.
    pub(crate) start_velocity: &'a [D::Vec],
    pub(crate) start_spin: &'a [D::Spin],
    pub(crate) radius: &'a [f64],
    pub(crate) mass: &'a [f64],
    pub(crate) material: &'a [u8],
    pub(crate) first_material: u8,
    pub(crate) walls: &'a [Wall<D>],
    /// Where each wall is; empty when none moves.
    pub(crate) poses: &'a [Pose<D>],
    pub(crate) cell: Option<&'a PeriodicCell<D>>,
    /// The step \[s\]; zero between steps.
    pub(crate) dt: f64,
    /// The last step taken \[s\].
    pub(crate) last_dt: f64,
    /// Whether a law asks how surfaces pass each other in the middle of the step, as predicted.
    pub(crate) predicts: bool,
    /// Surfaces farther apart than this do not meet within the step \[m\].
    pub(crate) margin: f64,
    /// Distance of surfaces up to which some law acts \[m\].
    pub(crate) law_reach: f64,
    /// Part of the overlap by which each lever arm is shorter than the radius.
    pub(crate) arm_share: f64,
    /// Share of the sum of spins about the normal with which springs turn: one half, or nothing.
    pub(crate) twist_share: f64,
}

/// Laws between materials.
pub(crate) struct Laws<'a, L> {
    pub(crate) list: &'a [L],
    pub(crate) materials: usize,
}

impl<L> Clone for Laws<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L> Copy for Laws<'_, L> {}

impl<'a, L> Laws<'a, L> {
    #[inline(always)]
    pub(crate) fn between(self, a: u8, b: u8) -> &'a L {
        &self.list[self.number(a, b)]
    }

    /// The place of a law in the list.
    #[inline(always)]
    pub(crate) fn number(self, a: u8, b: u8) -> usize {
        a as usize * self.materials + b as usize
    }
}

impl<'a, D: Dim> View<'a, D> {
    /// Of one length as far as the compiler knows: one check then serves for all.
    #[inline(always)]
    pub(crate) fn cut<L: ContactLaw<D>>(&self) -> View<'a, D> {
        let n = self.position.len();
        let mut view = *self;
        view.velocity = &view.velocity[..n];
        view.radius = &view.radius[..n];
        view.mass = &view.mass[..n];
        view.start_velocity = &view.start_velocity[..n];
        if L::TANGENTIAL {
            view.start_spin = &view.start_spin[..n];
            view.spin = &view.spin[..n];
        }
        view
    }

    #[inline(always)]
    pub(crate) fn material_of(&self, grain: usize) -> u8 {
        if self.material.is_empty() { self.first_material } else { self.material[grain] }
    }

    /// A grain; what law `L` does not read is left out.
    #[inline(always)]
    pub(crate) fn body<L: ContactLaw<D>>(&self, grain: usize) -> Body<D> {
        let mut body = Body {
            velocity: self.velocity[grain],
            start_velocity: self.start_velocity[grain],
            spin: D::Spin::ZERO,
            start_spin: D::Spin::ZERO,
            radius: self.radius[grain],
            mass: self.mass[grain],
        };
        if L::TANGENTIAL {
            body.start_spin = self.start_spin[grain];
            if self.predicts || L::TWISTING {
                body.spin = self.spin[grain];
            }
        }
        body
    }
}

/// What a contact reads of a body, besides its place.
#[derive(Clone, Copy, Default)]
pub(crate) struct Body<D: Dim> {
    pub(crate) velocity: D::Vec,
    pub(crate) start_velocity: D::Vec,
    pub(crate) spin: D::Spin,
    pub(crate) start_spin: D::Spin,
    pub(crate) radius: f64,
    pub(crate) mass: f64,
}
