//! How two bodies move at their contact, from how they move as a whole.

use crate::law::{ContactLaw, ContactLoad, Kinematics};
use crate::view::{Body, View};
use granular_core::{Dim, Linear};

/// Share of the step during which surfaces overlap, and the overlap averaged over the step,
/// when the motion through the step is uniform; zero when they do not meet. This is what makes entry
/// and exit of second order: a force that jumps at contact counts for exactly the time it acts.
#[inline(always)]
pub(crate) fn share_of_step(overlap: f64, approach: f64, dt: f64) -> (f64, f64) {
    let half = 0.5 * approach.abs() * dt;
    let reach = overlap + half;
    let part = reach / (2.0 * half);
    if overlap >= half {
        (1.0, overlap)
    } else if reach <= 0.0 {
        (0.0, 0.0)
    } else {
        (part, 0.5 * part * reach)
    }
}

/// Force vector of a load.
#[inline(always)]
pub(crate) fn push_of<D: Dim, L: ContactLaw<D>>(load: &ContactLoad<D>, normal: D::Vec) -> D::Vec {
    let along = normal * load.normal;
    if L::TANGENTIAL { along + D::turn(load.tangential, normal) } else { along }
}

/// The lever arm of a body at a contact.
#[derive(Clone, Copy)]
pub(crate) struct Arm {
    /// Length in the middle of the step \[m\].
    pub(crate) length: f64,
    /// By how much it is shorter for each metre of overlap.
    pub(crate) shrinks: f64,
}

impl Arm {
    /// Of a surface, whose velocities are those at the contact.
    pub(crate) const NONE: Self = Self { length: 0.0, shrinks: 0.0 };
}

/// The kinematics of a body with another, each with its lever arm, if they meet within the step.
///
/// `turning` is the rate of the normal at the start of the step \[1/s\].
#[inline(always)]
pub(crate) fn kinematics_of<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    (own, own_arm): (&Body<D>, Arm),
    (other, other_arm): (&Body<D>, Arm),
    (normal, turning): (D::Vec, impl FnOnce() -> D::Vec),
    overlap: f64,
) -> Kinematics<D> {
    let relative = own.velocity - other.velocity;
    let approach = -relative.dot(normal);
    let start_relative = own.start_velocity - other.start_velocity;
    let gap = -overlap;
    let (presence, overlap) = share_of_step(overlap, approach, view.dt);
    let mut kinematics = Kinematics {
        normal,
        gap,
        overlap,
        presence,
        approach,
        start_approach: -start_relative.dot(normal),
        slip: D::Spin::ZERO,
        roll: D::Spin::ZERO,
        start_slip: D::Spin::ZERO,
        start_roll: D::Spin::ZERO,
        twist: 0.0,
        twisting: 0.0,
        start_twisting: 0.0,
        effective_mass: 0.0,
        effective_radius: 0.0,
        dt: view.dt,
        last_dt: view.last_dt,
    };
    if L::TANGENTIAL {
        if view.predicts {
            let surface = D::tangential(own.spin * own_arm.length + other.spin * other_arm.length, normal);
            kinematics.slip = D::cross(normal, relative) - surface;
            kinematics.roll = D::tangential(own.spin - other.spin, normal);
        }
        // The velocities are those half a step before the normal. Bodies that turn as one with a
        // component along it would slide on each other by this difference.
        let start_normal = D::normal_before(normal, turning, 0.5 * view.dt);
        // So are their arms, which were longer by what the bodies have approached.
        let since = 0.5 * view.dt * kinematics.start_approach;
        let start_arm = |arm: Arm| arm.length + arm.shrinks * since;
        let turned = own.start_spin * start_arm(own_arm) + other.start_spin * start_arm(other_arm);
        let surface = D::tangential(turned, start_normal);
        // Within the tangent plane of now, or the moments on the two bodies would not balance.
        kinematics.start_slip = D::tangential(D::cross(start_normal, start_relative) - surface, normal);
        kinematics.start_roll = D::tangential(own.start_spin - other.start_spin, normal);
        kinematics.twist = view.twist_share * D::twist(own.start_spin + other.start_spin, normal);
        if L::TWISTING {
            kinematics.twisting = D::twist(own.spin - other.spin, normal);
            kinematics.start_twisting = D::twist(own.start_spin - other.start_spin, normal);
        }
    }
    kinematics
}

/// Two grains at a distance: `arm` leads from the second to the first.
#[derive(Clone, Copy, Default)]
pub(crate) struct Pair<D: Dim> {
    pub(crate) own: Body<D>,
    pub(crate) other: Body<D>,
    pub(crate) arm: D::Vec,
    pub(crate) distance_squared: f64,
}

impl<D: Dim> Pair<D> {
    #[inline(always)]
    pub(crate) fn overlap(&self) -> f64 {
        self.own.radius + self.other.radius - self.distance_squared.sqrt()
    }

    /// The kinematics and both lever arms.
    #[inline(always)]
    pub(crate) fn meet<L: ContactLaw<D>>(&self, view: &View<'_, D>) -> (Kinematics<D>, (f64, f64)) {
        let Self { own, other, .. } = self;
        let distance = self.distance_squared.sqrt();
        let overlap = own.radius + other.radius - distance;
        let arm_of = |radius: f64| Arm { length: radius - view.arm_share * overlap, shrinks: view.arm_share };
        let arms = (arm_of(own.radius), arm_of(other.radius));
        let normal = self.arm * (1.0 / distance);
        let turning = || (own.start_velocity - other.start_velocity) * (1.0 / distance);
        let mut kinematics =
            kinematics_of::<D, L>(view, (own, arms.0), (other, arms.1), (normal, turning), overlap);
        kinematics.effective_mass = own.mass * other.mass / (own.mass + other.mass);
        kinematics.effective_radius = own.radius * other.radius / (own.radius + other.radius);
        (kinematics, (arms.0.length, arms.1.length))
    }
}

/// The kinematics of two grains that overlap now, or are within the reach of a law.
pub(crate) fn overlapping<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    second: usize,
) -> Option<Kinematics<D>> {
    let arm = view.position[first] - view.position[second];
    let (own, other) = (view.body::<L>(first), view.body::<L>(second));
    let pair = Pair { own, other, arm, distance_squared: arm.length_squared() };
    let least = if L::REACHES { -view.law_reach } else { 0.0 };
    (pair.overlap() > least && pair.distance_squared > 0.0).then(|| pair.meet::<L>(view).0)
}
