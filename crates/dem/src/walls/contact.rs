//! Contacts of grains with walls of one part.

use crate::kinematics::{Arm, kinematics_of, push_of};
use crate::law::{ContactLaw, Kinematics};
use crate::lists::BlockList;
use crate::pass::Kernel;
use crate::view::{Body, View};
use granular_core::walls::{Pose, Reaction};
use granular_core::{Dim, Linear};

/// A piece of surface that a grain may meet.
pub(crate) struct Surface<D: Dim> {
    /// Unit normal towards the grain.
    pub(crate) normal: D::Vec,
    pub(crate) overlap: f64,
    /// Radius of the held grain that it belongs to; none for a wall.
    pub(crate) ball: Option<f64>,
}

/// The kinematics of a grain and a wall, and the lever arm.
#[inline(always)]
pub(crate) fn meet_wall<D: Dim, L: ContactLaw<D>, const MOVING: bool>(
    view: &View<'_, D>,
    first: usize,
    wall: usize,
) -> Option<(Kinematics<D>, f64)> {
    let shape = &view.walls[wall].shape;
    let (position, radius) = (view.position[first], view.radius[first]);
    if MOVING {
        let pose = &view.poses[wall];
        let (distance, normal) = shape.distance(pose.within_wall(position));
        let surface = Surface { normal: pose.out_of_wall(normal), overlap: radius - distance, ball: None };
        return meet_surface::<D, L>(view, first, &surface, Some(pose));
    }
    let (distance, normal) = shape.distance(position);
    meet_surface::<D, L>(view, first, &Surface { normal, overlap: radius - distance, ball: None }, None)
}

/// The kinematics of a grain and a piece of surface at rest or in motion, and the lever arm.
#[inline(always)]
pub(crate) fn meet_surface<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    surface: &Surface<D>,
    pose: Option<&Pose<D>>,
) -> Option<(Kinematics<D>, f64)> {
    let Surface { normal, overlap, ball } = *surface;
    let radius = view.radius[first];
    // A wall does not give way: the contact lies on its surface. A held grain does.
    let given = if ball.is_some() { 1.0 } else { 2.0 };
    let shrinks = given * view.arm_share;
    let arm = radius - shrinks * overlap;
    // Velocities of the surface are those at the contact: its lever arm is zero.
    let mut other = Body {
        velocity: D::Vec::ZERO,
        start_velocity: D::Vec::ZERO,
        spin: D::Spin::ZERO,
        start_spin: D::Spin::ZERO,
        radius: f64::INFINITY,
        mass: f64::INFINITY,
    };
    if let Some(pose) = pose {
        (other.velocity, other.start_velocity) = pose.velocities(view.position[first] - normal * arm);
        (other.spin, other.start_spin) = (pose.rate.spin, pose.start_rate.spin);
    }
    let own = view.body::<L>(first);
    let turning = || match ball {
        Some(other_radius) => {
            (own.start_velocity - other.start_velocity) * (1.0 / (radius + other_radius - overlap))
        }
        None => D::turn(other.start_spin, normal),
    };
    let own_arm = (&own, Arm { length: arm, shrinks });
    let mut kinematics =
        kinematics_of::<D, L>(view, own_arm, (&other, Arm::NONE), (normal, turning), overlap);
    kinematics.effective_mass = view.mass[first];
    kinematics.effective_radius = ball.map_or(radius, |other| radius * other / (radius + other));
    let reached = L::REACHES && kinematics.gap < view.law_reach;
    (kinematics.presence != 0.0 || reached).then_some((kinematics, arm))
}

impl<D: Dim, L: ContactLaw<D>, const LEDGER: bool> Kernel<'_, D, L, LEDGER> {
    /// Loads of walls; with `MOVING`, of walls that may move.
    #[inline(always)]
    pub(crate) fn walls<const MOVING: bool>(
        &mut self,
        list: &mut BlockList<L::Memory>,
        reactions: &mut [Reaction<D>],
    ) {
        let view = self.view;
        self.tally.at_walls();
        for (near, memory) in list.near_walls.iter().zip(&mut list.wall_memory) {
            let (first, wall) = (near.grain as usize, near.wall as usize);
            let Some((kinematics, arm)) = meet_wall::<D, L, MOVING>(view, first, wall) else {
                let law = self.laws.between(view.material_of(first), view.walls[wall].material.0);
                law.release(memory, &mut self.tally);
                *memory = L::Memory::default();
                continue;
            };
            let reaction = if MOVING { reactions.get_mut(wall) } else { None };
            self.push_wall(first, wall, (&kinematics, arm), memory, reaction);
        }
    }

    /// Adds the load of a wall on a grain.
    #[inline(always)]
    pub(crate) fn push_wall(
        &mut self,
        first: usize,
        wall: usize,
        (kinematics, arm): (&Kinematics<D>, f64),
        memory: &mut L::Memory,
        reaction: Option<&mut Reaction<D>>,
    ) {
        let view = self.view;
        let law = self.laws.between(view.material_of(first), view.walls[wall].material.0);
        self.guard(first, kinematics.overlap, view.radius[first]);
        let load = law.load(kinematics, memory, &mut self.tally);
        if L::REACHES && kinematics.presence == 0.0 && !law.acts(kinematics.gap, memory) {
            law.release(memory, &mut self.tally);
            *memory = L::Memory::default();
            return;
        }
        let local = first - self.start;
        let push = push_of::<D, L>(&load, kinematics.normal);
        self.force[local] += push;
        if L::TANGENTIAL {
            self.torque[local] += load.rolling - load.tangential * arm;
        }
        if let Some(reaction) = reaction {
            let pose = &view.poses[wall];
            let (velocity, _) = pose.velocities(view.position[first] - kinematics.normal * arm);
            reaction.force -= push;
            reaction.power += push.dot(velocity) + load.rolling.dot(pose.rate.spin);
        }
    }
}
