//! The pass over the contacts of a block: who meets within the step, and the load between them.

use crate::batch::{Address, Batch};
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

/// How far the pairs of a block are noted.
#[derive(Clone, Copy, Debug, Default)]
struct Cursor {
    local: usize,
    place: usize,
    owed: usize,
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
        self.force.fill(D::Vec::ZERO);
        self.torque.fill(D::Spin::ZERO);
        outgoing.fill(Owed::default());
        let mut batch = Batch::<D, L, LEDGER>::new();
        let mut cursor = Cursor::default();
        loop {
            let done = self.note_near(list, &mut cursor, &mut batch);
            batch.gather(self.view, &list.memory);
            let deep = batch.load(self.view, self.laws.list);
            self.hand_out(&batch, deep, list, outgoing);
            batch.clear();
            if done {
                break;
            }
        }
    }

    /// Notes near pairs from the cursor on, as many as a batch takes. Returns whether these were the last.
    #[inline(always)]
    fn note_near(
        &mut self,
        list: &mut BlockList<L::Memory>,
        cursor: &mut Cursor,
        batch: &mut Batch<D, L, LEDGER>,
    ) -> bool {
        let view = self.view;
        while let Some(&end) = list.starts.get(cursor.local + 1) {
            let first = self.start + cursor.local;
            let (position, radius) = (view.position[first], view.radius[first] + view.margin);
            let material = view.material_of(first);
            for place in cursor.place..end as usize {
                let second = list.partners[place] as usize;
                let arm = position - view.position[second];
                let reach = radius + view.radius[second];
                let distance_squared = arm.length_squared();
                if distance_squared < reach * reach {
                    let law = self.laws.number(material, view.material_of(second));
                    let Some(in_batch) = batch.place(law) else {
                        cursor.place = place;
                        return false;
                    };
                    let address = Address {
                        first: first as u32,
                        second: second as u32,
                        memory: place as u32,
                        owed: cursor.owed as u32,
                        place: in_batch as u32,
                    };
                    batch.note(address, (arm, distance_squared));
                } else if list.touching[place] {
                    let law = self.laws.between(material, view.material_of(second));
                    list.touching[place] = false;
                    law.release(&list.memory[place], &mut self.tally);
                    list.memory[place] = L::Memory::default();
                }
                cursor.owed += usize::from(second < self.start);
            }
            cursor.place = end as usize;
            cursor.local += 1;
        }
        true
    }

    /// Adds the loads of a batch to both grains.
    #[inline(always)]
    fn hand_out(
        &mut self,
        batch: &Batch<D, L, LEDGER>,
        deep: bool,
        list: &mut BlockList<L::Memory>,
        outgoing: &mut [Owed<D>],
    ) {
        for to in batch.addresses() {
            let k = to.place as usize;
            let (first, second) = (to.first as usize, to.second as usize);
            let kept = &mut list.memory[to.memory as usize];
            let touching = &mut list.touching[to.memory as usize];
            // What is not a number goes on to the grains, where it is found.
            if batch.presence[k] == 0.0 {
                if *touching {
                    *touching = false;
                    let materials = [first, second].map(|grain| self.view.material_of(grain));
                    self.laws.between(materials[0], materials[1]).release(kept, &mut self.tally);
                    *kept = L::Memory::default();
                }
                continue;
            }
            *touching = true;
            *kept = batch.memories[k];
            if deep {
                let pair = batch.pair(k);
                self.guard(first, pair.overlap(), pair.own.radius.min(pair.other.radius));
            }
            self.tally.add(|| batch.losses(k));
            let first = first - self.start;
            self.force[first] += batch.force[k];
            if L::TANGENTIAL {
                self.torque[first] += batch.torques[0][k];
            }
            if let Some(second) = second.checked_sub(self.start) {
                self.force[second] -= batch.force[k];
                if L::TANGENTIAL {
                    self.torque[second] += batch.torques[1][k];
                }
            } else {
                outgoing[to.owed as usize] = Owed { force: -batch.force[k], torque: batch.torques[1][k] };
            }
        }
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

/// The meeting of a body with another, each with its lever arm, if they meet within the step.
///
/// `turning` is the rate of the normal at the start of the step \[1/s\].
#[inline(always)]
fn meeting<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    (own, own_arm): (&Body<D>, f64),
    (other, other_arm): (&Body<D>, f64),
    (normal, turning): (D::Vec, impl FnOnce() -> D::Vec),
    overlap: f64,
) -> Meeting<D> {
    let relative = own.velocity - other.velocity;
    let approach = -relative.dot(normal);
    let start_relative = own.start_velocity - other.start_velocity;
    let (presence, overlap) = share_of_step(overlap, approach, view.dt);
    let mut meeting = Meeting {
        normal,
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
            let surface = D::tangential(own.spin * own_arm + other.spin * other_arm, normal);
            meeting.slip = D::cross(normal, relative) - surface;
            meeting.roll = D::tangential(own.spin - other.spin, normal);
        }
        // The velocities are those half a step before the normal. Bodies that turn as one with a
        // component along it would slide on each other by this difference.
        let start_normal = D::normal_before(normal, turning, 0.5 * view.dt);
        let surface = D::tangential(own.start_spin * own_arm + other.start_spin * other_arm, start_normal);
        // Within the tangent plane of now, or the moments on the two bodies would not balance.
        meeting.start_slip = D::tangential(D::cross(start_normal, start_relative) - surface, normal);
        meeting.start_roll = D::tangential(own.start_spin - other.start_spin, normal);
        meeting.twist = 0.5 * D::twist(own.start_spin + other.start_spin, normal);
        if L::TWISTING {
            meeting.twisting = D::twist(own.spin - other.spin, normal);
            meeting.start_twisting = D::twist(own.start_spin - other.start_spin, normal);
        }
    }
    meeting
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

    /// The meeting and both lever arms.
    #[inline(always)]
    pub(crate) fn meet<L: ContactLaw<D>>(&self, view: &View<'_, D>) -> (Meeting<D>, (f64, f64)) {
        let Self { own, other, .. } = self;
        let distance = self.distance_squared.sqrt();
        let overlap = own.radius + other.radius - distance;
        let shorter = view.arm_share * overlap;
        let arms = (own.radius - shorter, other.radius - shorter);
        let normal = self.arm * (1.0 / distance);
        let turning = || (own.start_velocity - other.start_velocity) * (1.0 / distance);
        let mut meeting = meeting::<D, L>(view, (own, arms.0), (other, arms.1), (normal, turning), overlap);
        meeting.effective_mass = own.mass * other.mass / (own.mass + other.mass);
        meeting.effective_radius = own.radius * other.radius / (own.radius + other.radius);
        (meeting, arms)
    }
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
    let mut meeting = meeting::<D, L>(view, (&own, arm), (&other, 0.0), (normal, turning), overlap);
    meeting.effective_mass = view.mass[first];
    meeting.effective_radius = ball.map_or(radius, |other| radius * other / (radius + other));
    (meeting.presence != 0.0).then_some((meeting, arm))
}

/// The meeting of two grains that overlap now.
pub(crate) fn overlapping<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    second: usize,
) -> Option<Meeting<D>> {
    let arm = view.position[first] - view.position[second];
    let (own, other) = (view.body::<L>(first), view.body::<L>(second));
    let pair = Pair { own, other, arm, distance_squared: arm.length_squared() };
    (pair.overlap() > 0.0 && pair.distance_squared > 0.0).then(|| pair.meet::<L>(view).0)
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
        torque: load.rolling,
        energy,
    }
}
