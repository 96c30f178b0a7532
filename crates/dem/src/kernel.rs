//! The pass over the contacts of a block: who meets within the step, and the load between them.

use crate::cell::Cell;
use crate::contacts::{Contact, Partner};
use crate::law::{ContactLaw, Load, Meeting};
use crate::ledger::Tally;
use crate::lists::BlockList;
use crate::moving::Reaction;
use crate::pose::Pose;
use crate::wall::Wall;
use granular_core::{Dim, Linear};

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
    pub(crate) cell: Option<&'a Cell<D>>,
    /// The step \[s\]; zero between steps.
    pub(crate) dt: f64,
    /// The last step taken \[s\].
    pub(crate) last_dt: f64,
    /// Whether a law asks how surfaces pass each other in the middle of the step, as predicted.
    pub(crate) predicts: bool,
    /// Surfaces farther apart than this do not meet within the step \[m\].
    pub(crate) margin: f64,
    /// Part of the overlap by which each lever arm is shorter than the radius.
    pub(crate) arm_share: f64,
}

/// Overlap over the smaller radius at which contacts stop making sense.
pub(crate) const DEEPEST: f64 = 0.5;

/// A contact deeper than [`DEEPEST`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trouble {
    pub(crate) first: u32,
    pub(crate) overlap: f64,
    pub(crate) radius: f64,
}

/// What a block owes to a grain of an earlier block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Owed<D: Dim> {
    pub(crate) force: D::Vec,
    pub(crate) torque: D::Spin,
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
        &self.list[a as usize * self.materials + b as usize]
    }
}

impl<D: Dim> View<'_, D> {
    #[inline(always)]
    pub(crate) fn material_of(&self, grain: usize) -> u8 {
        if self.material.is_empty() { self.first_material } else { self.material[grain] }
    }
}

/// Two bodies before they are known to meet: what is needed of the second one.
struct Other<D: Dim> {
    velocity: D::Vec,
    spin: D::Spin,
    start_velocity: D::Vec,
    start_spin: D::Spin,
    arm: f64,
}

/// Share of the step during which surfaces overlap, and the overlap averaged over the step,
/// when the motion through the step is uniform. This is what makes entry and exit of second
/// order: a force that jumps at contact counts for exactly the time it acts.
#[inline(always)]
pub(crate) fn share_of_step(overlap: f64, approach: f64, dt: f64) -> Option<(f64, f64)> {
    let half = 0.5 * approach.abs() * dt;
    if overlap >= half {
        return Some((1.0, overlap));
    }
    let reach = overlap + half;
    if reach <= 0.0 {
        return None;
    }
    let presence = reach / (2.0 * half);
    Some((presence, 0.5 * presence * reach))
}

/// One pass over the contacts of a block.
pub(crate) struct Kernel<'a, D: Dim, L: ContactLaw<D>, const LEDGER: bool> {
    pub(crate) view: &'a View<'a, D>,
    pub(crate) laws: Laws<'a, L>,
    pub(crate) start: usize,
    pub(crate) force: &'a mut [D::Vec],
    pub(crate) torque: &'a mut [D::Spin],
    pub(crate) tally: Tally<LEDGER>,
    pub(crate) trouble: Option<Trouble>,
}

impl<D: Dim, L: ContactLaw<D>, const LEDGER: bool> Kernel<'_, D, L, LEDGER> {
    #[inline(always)]
    pub(crate) fn pairs(&mut self, list: &mut BlockList<L::Memory>, outgoing: &mut [Owed<D>]) {
        let view = self.view;
        let mut owed = 0;
        for local in 0..self.force.len() {
            let first = self.start + local;
            let (position, radius) = (view.position[first], view.radius[first]);
            let (mut force, mut torque) = (D::Vec::ZERO, D::Spin::ZERO);
            let range = list.starts[local] as usize..list.starts[local + 1] as usize;
            for (&partner, memory) in list.partners[range.clone()].iter().zip(&mut list.memory[range]) {
                let second = partner as usize;
                let abroad = second < self.start;
                let arm = position - view.position[second];
                let reach = radius + view.radius[second] + view.margin;
                let squared = arm.length_squared();
                let given = if squared < reach * reach {
                    self.touch(first, second, arm, squared.sqrt(), memory, (&mut force, &mut torque))
                } else {
                    None
                };
                if given.is_none() && *memory != L::Memory::default() {
                    let law = self.laws.between(view.material_of(first), view.material_of(second));
                    law.release(memory, &mut self.tally);
                    *memory = L::Memory::default();
                }
                if abroad {
                    outgoing[owed] = given.unwrap_or_default();
                    owed += 1;
                } else if let Some(given) = given {
                    let place = second - self.start;
                    self.force[place] += given.force;
                    if L::TANGENTIAL {
                        self.torque[place] += given.torque;
                    }
                }
            }
            // Later grains of the block add to this one after it was set here.
            self.force[local] = force;
            if L::TANGENTIAL {
                self.torque[local] = torque;
            }
        }
    }

    /// Adds the load between two grains at `distance`, if they meet within the step, to force and
    /// torque of the first; returns what the second one gets.
    #[inline(always)]
    fn touch(
        &mut self,
        first: usize,
        second: usize,
        arm: D::Vec,
        distance: f64,
        memory: &mut L::Memory,
        (force, torque): (&mut D::Vec, &mut D::Spin),
    ) -> Option<Owed<D>> {
        let view = self.view;
        let (meeting, arms) = meet_grain::<D, L>(view, first, second, arm, distance)?;
        let (radius, other) = (view.radius[first], view.radius[second]);
        self.guard(first, radius + other - distance, radius.min(other));
        let law = self.laws.between(view.material_of(first), view.material_of(second));
        let load = law.load(&meeting, memory, &mut self.tally);
        let on_first = push_of::<D, L>(&load, meeting.normal);
        *force += on_first;
        let mut given = Owed { force: -on_first, torque: D::Spin::ZERO };
        if L::TANGENTIAL {
            *torque += load.rolling - load.tangential * arms.0;
            given.torque = -load.rolling - load.tangential * arms.1;
        }
        Some(given)
    }

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
            let Some((meeting, arm)) = meet_wall::<D, L, MOVING>(view, first, wall) else {
                let law = self.laws.between(view.material_of(first), view.walls[wall].material.0);
                law.release(memory, &mut self.tally);
                *memory = L::Memory::default();
                continue;
            };
            let reaction = if MOVING { reactions.get_mut(wall) } else { None };
            self.push_wall(first, wall, (&meeting, arm), memory, reaction);
        }
    }

    /// Adds the load of a wall on a grain.
    #[inline(always)]
    pub(crate) fn push_wall(
        &mut self,
        first: usize,
        wall: usize,
        (meeting, arm): (&Meeting<D>, f64),
        memory: &mut L::Memory,
        reaction: Option<&mut Reaction<D>>,
    ) {
        let view = self.view;
        let law = self.laws.between(view.material_of(first), view.walls[wall].material.0);
        self.guard(first, meeting.overlap, view.radius[first]);
        let load = law.load(meeting, memory, &mut self.tally);
        let local = first - self.start;
        let push = push_of::<D, L>(&load, meeting.normal);
        self.force[local] += push;
        if L::TANGENTIAL {
            self.torque[local] += load.rolling - load.tangential * arm;
        }
        if let Some(reaction) = reaction {
            let pose = &view.poses[wall];
            let (velocity, _) = pose.velocities(view.position[first] - meeting.normal * arm);
            reaction.force -= push;
            reaction.power += push.dot(velocity) + load.rolling.dot(pose.rate.spin);
        }
    }

    /// Notes a contact that is too deep; the step then ends in an error.
    #[inline(always)]
    pub(crate) fn guard(&mut self, first: usize, overlap: f64, radius: f64) {
        if overlap > DEEPEST * radius {
            self.trouble.get_or_insert(Trouble { first: first as u32, overlap, radius });
        }
    }
}

/// Force vector of a load.
#[inline(always)]
pub(crate) fn push_of<D: Dim, L: ContactLaw<D>>(load: &Load<D>, normal: D::Vec) -> D::Vec {
    let along = normal * load.normal;
    if L::TANGENTIAL { along + D::turn(load.tangential, normal) } else { along }
}

/// The meeting of a body with another, if they meet within the step.
#[inline(always)]
fn meeting<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    own_arm: f64,
    normal: D::Vec,
    overlap: f64,
    other: &Other<D>,
) -> Option<Meeting<D>> {
    let relative = view.velocity[first] - other.velocity;
    let approach = -relative.dot(normal);
    let (presence, overlap) = share_of_step(overlap, approach, view.dt)?;
    let mut meeting = Meeting {
        normal,
        overlap,
        presence,
        approach,
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
            let spin = view.spin[first];
            let surface = D::tangential(spin * own_arm + other.spin * other.arm, normal);
            meeting.slip = D::cross(normal, relative) - surface;
            meeting.roll = D::tangential(spin - other.spin, normal);
        }
        let relative = view.start_velocity[first] - other.start_velocity;
        let spin = view.start_spin[first];
        let surface = D::tangential(spin * own_arm + other.start_spin * other.arm, normal);
        meeting.start_slip = D::cross(normal, relative) - surface;
        meeting.start_roll = D::tangential(spin - other.start_spin, normal);
        meeting.twist = 0.5 * D::twist(spin + other.start_spin, normal);
        if L::TWISTING {
            meeting.twisting = D::twist(view.spin[first] - other.spin, normal);
            meeting.start_twisting = D::twist(spin - other.start_spin, normal);
        }
    }
    Some(meeting)
}

/// The meeting of two grains at `distance` and their lever arms.
#[inline(always)]
fn meet_grain<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    second: usize,
    arm: D::Vec,
    distance: f64,
) -> Option<(Meeting<D>, (f64, f64))> {
    let start_velocity = if L::TANGENTIAL { view.start_velocity[second] } else { D::Vec::ZERO };
    meet_other::<D, L>(view, first, second, arm, distance, (view.velocity[second], start_velocity))
}

/// [`meet_grain`] where the second grain has other velocities, at the middle and at the start of the step.
#[inline(always)]
pub(crate) fn meet_other<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    second: usize,
    arm: D::Vec,
    distance: f64,
    (velocity, start_velocity): (D::Vec, D::Vec),
) -> Option<(Meeting<D>, (f64, f64))> {
    let (radius, mass) = (view.radius[first], view.mass[first]);
    let (other_radius, other_mass) = (view.radius[second], view.mass[second]);
    let overlap = radius + other_radius - distance;
    let other = Other {
        velocity,
        spin: if L::TANGENTIAL { view.spin[second] } else { D::Spin::ZERO },
        start_velocity,
        start_spin: if L::TANGENTIAL { view.start_spin[second] } else { D::Spin::ZERO },
        arm: other_radius - view.arm_share * overlap,
    };
    let own_arm = radius - view.arm_share * overlap;
    let normal = arm * (1.0 / distance);
    let mut meeting = meeting::<D, L>(view, first, own_arm, normal, overlap, &other)?;
    meeting.effective_mass = mass * other_mass / (mass + other_mass);
    meeting.effective_radius = radius * other_radius / (radius + other_radius);
    Some((meeting, (own_arm, other.arm)))
}

/// A piece of surface that a grain may meet.
pub(crate) struct Surface<D: Dim> {
    /// Unit normal towards the grain.
    pub(crate) normal: D::Vec,
    pub(crate) overlap: f64,
    /// Radius of the held grain that it belongs to; none for a wall.
    pub(crate) ball: Option<f64>,
}

/// The meeting of a grain and a wall, and the lever arm.
#[inline(always)]
pub(crate) fn meet_wall<D: Dim, L: ContactLaw<D>, const MOVING: bool>(
    view: &View<'_, D>,
    first: usize,
    wall: usize,
) -> Option<(Meeting<D>, f64)> {
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

/// The meeting of a grain and a piece of surface at rest or in motion, and the lever arm.
#[inline(always)]
pub(crate) fn meet_surface<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    surface: &Surface<D>,
    pose: Option<&Pose<D>>,
) -> Option<(Meeting<D>, f64)> {
    let Surface { normal, overlap, ball } = *surface;
    let radius = view.radius[first];
    // A wall does not give way: the contact lies on its surface. A held grain does.
    let given = if ball.is_some() { 1.0 } else { 2.0 };
    let arm = radius - given * view.arm_share * overlap;
    let mut other = Other {
        velocity: D::Vec::ZERO,
        spin: D::Spin::ZERO,
        start_velocity: D::Vec::ZERO,
        start_spin: D::Spin::ZERO,
        // Velocities are those at the contact.
        arm: 0.0,
    };
    if let Some(pose) = pose {
        (other.velocity, other.start_velocity) = pose.velocities(view.position[first] - normal * arm);
        (other.spin, other.start_spin) = (pose.rate.spin, pose.start_rate.spin);
    }
    let mut meeting = meeting::<D, L>(view, first, arm, normal, overlap, &other)?;
    meeting.effective_mass = view.mass[first];
    meeting.effective_radius = ball.map_or(radius, |other| radius * other / (radius + other));
    Some((meeting, arm))
}

/// The meeting of two grains that overlap now.
pub(crate) fn overlapping<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    second: usize,
) -> Option<Meeting<D>> {
    let arm = view.position[first] - view.position[second];
    let distance = arm.length();
    let overlap = view.radius[first] + view.radius[second] - distance;
    let met = if overlap > 0.0 && distance > 0.0 {
        meet_grain::<D, L>(view, first, second, arm, distance)
    } else {
        None
    };
    met.map(|(meeting, _)| meeting)
}

/// A contact as outputs see it.
pub(crate) fn contact_of<D: Dim, L: ContactLaw<D>>(
    law: &L,
    meeting: &Meeting<D>,
    memory: L::Memory,
    (first, partner): (usize, Partner),
    branch: D::Vec,
) -> Contact<D> {
    let (load, energy) = law.at_rest(meeting, memory);
    Contact {
        first,
        partner,
        branch,
        shift: [0; 3],
        normal: meeting.normal,
        overlap: meeting.overlap,
        normal_force: load.normal,
        force: push_of::<D, L>(&load, meeting.normal),
        energy,
    }
}
