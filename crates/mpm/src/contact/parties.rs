//! Fields that meet at the nodes of a block.

use super::MOST_FIELDS;
use super::exchange::{Exchanged, Meets, Rules, given, normal_between};
use super::surface::Surfaces;
use crate::layout::{Node, block_cells, block_side};
use crate::nodes::{Meeting, Touch};
use crate::step::{NodeRule, put, vector_of};
use granular_core::{Dim, Linear, Vector};
use std::ops::Range;

/// Pairs of fields.
const MOST_PAIRS: usize = MOST_FIELDS * (MOST_FIELDS - 1) / 2;
/// Where a node notes with which fields before its own it meets, and to which of them it sticks: components that no velocity has.
const MEETS: usize = 6;
const STICKS: usize = 7;
/// Sweeps over pairs where more than two fields meet, for one exchange pushes a field into another.
const ROUNDS: usize = 4;

/// How the nodes of a block move that fields share.
pub(super) struct ContactRule<'a, D: Dim> {
    pub(super) rule: &'a NodeRule<'a, D>,
    pub(super) rules: &'a Rules,
    pub(super) surfaces: &'a Surfaces,
    /// The first node of the block, in cells from the origin.
    pub(super) corner: D::Vec,
    pub(super) fields: usize,
    pub(super) sums: &'a [Node],
    pub(super) outlines: &'a [Node],
    pub(super) motion: &'a mut [Node],
    /// Those of the block, once for every field.
    pub(super) touches: &'a mut [Touch<D>],
    pub(super) exchanged: &'a mut [Exchanged<D>],
}

/// A field at a node.
#[derive(Clone, Copy, Debug)]
struct Party<D: Dim> {
    field: usize,
    mass: f64,
    /// Velocity at the start of the step.
    mean: D::Vec,
    /// Its change by forces, without others.
    change: D::Vec,
    /// Velocity at the end of the step, as far as it is known.
    now: D::Vec,
    /// Mean velocity over the step.
    middle: D::Vec,
    /// Momentum that others gave.
    impulse: D::Vec,
}

/// All fields at a node.
struct Parties<D: Dim> {
    list: [Party<D>; MOST_FIELDS],
    count: usize,
}

impl<D: Dim> Parties<D> {
    fn here(&mut self) -> &mut [Party<D>] {
        &mut self.list[..self.count]
    }
}

/// What pairs gave at a node: across the normal and along it.
type Impulses<D> = [[<D as Dim>::Vec; 2]; MOST_PAIRS];

impl<D: Dim> ContactRule<'_, D> {
    /// Forces act, then walls and contacts. Returns what local damping took.
    pub(super) fn accelerate(&mut self) -> f64 {
        self.exchanged.fill(Exchanged::default());
        self.touches.iter_mut().for_each(Touch::rest);
        let (mut damped, mut from) = (0.0, 0);
        for node in 0..block_cells::<D>() {
            let touching = self.touching(node, &mut from);
            let mut parties = self.parties(node);
            let impulses = self.meet(node, &mut parties, &touching);
            for k in 0..parties.count {
                damped += self.finish(node, &mut parties.list[k], &touching);
            }
            if let Some(impulses) = impulses {
                self.book(&parties, &impulses);
            }
        }
        damped
    }

    /// The velocities of what is on nodes now, with what walls and contacts do in this step; `anew` finds what they do.
    pub(super) fn velocity(&mut self, vector: usize, anew: bool) {
        let mut from = 0;
        for node in 0..block_cells::<D>() {
            let touching = self.touching(node, &mut from);
            let mut parties = self.parties(node);
            if anew && self.meet(node, &mut parties, &touching).is_none() {
                for k in 0..parties.count {
                    let party = &parties.list[k];
                    let (mean, change) = (party.mean, party.change);
                    self.meeting(party, &touching).act(mean, change);
                }
            }
            for k in 0..parties.count {
                let party = &mut parties.list[k];
                party.now = self.meeting(party, &touching).hold(party.mean);
            }
            if parties.count > 1 {
                self.hold_together(node, &mut parties);
                for k in 0..parties.count {
                    let party = &mut parties.list[k];
                    party.now = self.meeting(party, &touching).hold(party.now);
                }
            }
            for party in parties.here() {
                put::<D>(&mut self.motion[place::<D>(party.field, node)], vector, party.now);
            }
        }
    }

    /// Touches of a node among those of a field.
    fn touching(&self, node: usize, from: &mut usize) -> Range<usize> {
        let each = self.touches.len() / self.fields;
        let first = *from;
        let here = self.touches[first..each].iter().take_while(|touch| touch.node as usize == node);
        *from += here.count();
        first..*from
    }

    fn meeting(&mut self, party: &Party<D>, touching: &Range<usize>) -> Meeting<'_, D> {
        let first = party.field * (self.touches.len() / self.fields);
        let own = first + touching.start..first + touching.end;
        self.rule.meeting(&mut self.touches[own], party.mass)
    }

    /// The fields that have mass at a node; the motion of the others becomes zero.
    fn parties(&mut self, node: usize) -> Parties<D> {
        let zero = D::Vec::ZERO;
        let nobody =
            Party { field: 0, mass: 0.0, mean: zero, change: zero, now: zero, middle: zero, impulse: zero };
        let mut parties = Parties { list: [nobody; MOST_FIELDS], count: 0 };
        for field in 0..self.fields {
            let sum = &self.sums[place::<D>(field, node)];
            let Some((mean, change)) = self.rule.mean(sum) else {
                self.motion[place::<D>(field, node)] = Node::ZERO;
                continue;
            };
            parties.list[parties.count] = Party { field, mass: sum.0[0], mean, change, ..nobody };
            parties.count += 1;
        }
        parties
    }

    /// Finds what fields at a node give to one another, after walls had their say. None where there is one alone.
    fn meet(
        &mut self,
        node: usize,
        parties: &mut Parties<D>,
        touching: &Range<usize>,
    ) -> Option<Impulses<D>> {
        for party in parties.here() {
            let motion = &mut self.motion[place::<D>(party.field, node)];
            (motion.0[MEETS], motion.0[STICKS]) = (0.0, 0.0);
        }
        if parties.count < 2 {
            return None;
        }
        for k in 0..parties.count {
            let party = &mut parties.list[k];
            party.now = self.meeting(party, touching).act(party.mean, party.change).1;
        }
        let mut impulses = [[D::Vec::ZERO; 2]; MOST_PAIRS];
        for _ in 0..rounds(parties.count) {
            for (pair, one, other) in pairs(parties.count) {
                let meets = self.exchange(node, (&mut impulses[pair], parties), one, other);
                self.note(node, &parties.list[one], &parties.list[other], meets);
            }
        }
        Some(impulses)
    }

    /// One pair gives momentum from one to the other.
    fn exchange(
        &self,
        node: usize,
        (impulse, parties): (&mut [D::Vec; 2], &mut Parties<D>),
        one: usize,
        other: usize,
    ) -> Meets {
        let [first, second] = [one, other].map(|k| parties.list[k]);
        let (_, friction) = self.rules.of(first.field, second.field);
        let normal = self.normal(node, &first, &second);
        if friction.is_some() && !self.have_met(node, (&first, &second), normal) {
            return Meets::Apart;
        }
        let reduced_mass = first.mass * second.mass / (first.mass + second.mass);
        let (gives, meets) = given::<D>(first.now - second.now, normal, reduced_mass, friction);
        let whole = gives[0] + gives[1];
        for (part, gives) in impulse.iter_mut().zip(gives) {
            *part += gives;
        }
        for (party, sign) in [(one, -1.0), (other, 1.0)] {
            let party = &mut parties.list[party];
            party.impulse += whole * sign;
            party.now += whole * (sign / party.mass);
        }
        meets
    }

    fn normal(&self, node: usize, one: &Party<D>, other: &Party<D>) -> D::Vec {
        let outline = |party: &Party<D>| vector_of::<D>(&self.outlines[place::<D>(party.field, node)], 0);
        normal_between::<D>(outline(one), outline(other))
    }

    /// Whether the ends of both have met at a node, along the normal from the first to the second.
    fn have_met(&self, node: usize, (one, other): (&Party<D>, &Party<D>), normal: D::Vec) -> bool {
        let side = block_side::<D>();
        let at = self.corner + D::Vec::from_fn(|axis| (node / side.pow(axis as u32) % side) as f64);
        let middle = |party: &Party<D>| {
            let outline = &self.outlines[place::<D>(party.field, node)];
            (vector_of::<D>(outline, 1) * (1.0 / outline.0[2 * D::N]) - at).dot(normal)
        };
        self.surfaces.gap(middle(one), middle(other)) <= 0.0
    }

    /// Notes at the second field how it meets the first.
    fn note(&mut self, node: usize, one: &Party<D>, other: &Party<D>, meets: Meets) {
        let motion = &mut self.motion[place::<D>(other.field, node)];
        let bit = 1_u32 << one.field;
        let with = |noted: f64| f64::from(noted as u32 | bit);
        if meets != Meets::Apart {
            motion.0[MEETS] = with(motion.0[MEETS]);
        }
        if meets == Meets::Sticks {
            motion.0[STICKS] = with(motion.0[STICKS]);
        }
    }

    fn met(&self, node: usize, one: &Party<D>, other: &Party<D>) -> Meets {
        let motion = &self.motion[place::<D>(other.field, node)];
        let noted = |component: usize| motion.0[component] as u32 >> one.field & 1 == 1;
        match (noted(MEETS), noted(STICKS)) {
            (_, true) => Meets::Sticks,
            (true, false) => Meets::Slides,
            _ => Meets::Apart,
        }
    }

    /// Moves a field at a node, with walls and local damping; returns what damping took.
    fn finish(&mut self, node: usize, party: &mut Party<D>, touching: &Range<usize>) -> f64 {
        let (rule, mean) = (self.rule, party.mean);
        let change = party.change + party.impulse * (1.0 / party.mass);
        let mut meeting = self.meeting(party, touching);
        let (before, mut after) = meeting.act(mean, change);
        let mut damped = 0.0;
        if rule.local_damping > 0.0 {
            let resisting = rule.resisting(after - before, before);
            after = meeting.act(mean, change + resisting).1;
            damped = -party.mass * resisting.dot((before + after) * 0.5);
        }
        party.middle = (before + after) * 0.5;
        let motion = &mut self.motion[place::<D>(party.field, node)];
        put::<D>(motion, 0, after);
        put::<D>(motion, 1, after - before);
        damped
    }

    /// Books what pairs exchanged, with the work on the mean velocities of both.
    fn book(&mut self, parties: &Parties<D>, impulses: &Impulses<D>) {
        for (pair, one, other) in pairs(parties.count) {
            let [first, second] = [one, other].map(|k| &parties.list[k]);
            let (place, _) = self.rules.of(first.field, second.field);
            let exchanged = &mut self.exchanged[place];
            exchanged.impulse += impulses[pair][0] + impulses[pair][1];
            for (lost, impulse) in exchanged.lost.iter_mut().zip(impulses[pair]) {
                *lost += impulse.dot(first.middle - second.middle);
            }
        }
    }

    /// Keeps fields together that met in this step, and others out of one another.
    fn hold_together(&self, node: usize, parties: &mut Parties<D>) {
        for _ in 0..rounds(parties.count) {
            for (_, one, other) in pairs(parties.count) {
                let [first, second] = [one, other].map(|k| parties.list[k]);
                let approach = first.now - second.now;
                let normal = self.normal(node, &first, &second);
                let gone = match self.met(node, &first, &second) {
                    Meets::Sticks => approach,
                    Meets::Slides => normal * approach.dot(normal),
                    Meets::Apart if !self.have_met(node, (&first, &second), normal) => continue,
                    Meets::Apart => normal * approach.dot(normal).max(0.0),
                };
                let share = 1.0 / (first.mass + second.mass);
                parties.list[one].now -= gone * (second.mass * share);
                parties.list[other].now += gone * (first.mass * share);
            }
        }
    }
}

/// Where a node of a field is in a block.
fn place<D: Dim>(field: usize, node: usize) -> usize {
    field * block_cells::<D>() + node
}

fn rounds(count: usize) -> usize {
    if count > 2 { ROUNDS } else { 1 }
}

/// All pairs of so many, each with its number.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (1..count).flat_map(|other| (0..other).map(move |one| (other * (other - 1) / 2 + one, one, other)))
}
