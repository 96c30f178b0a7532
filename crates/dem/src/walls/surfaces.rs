//! Contacts of grains with surfaces of many parts.
//!
//! A surface is touched where the distance to it is smallest nearby. Parts that the grain reaches are sorted by
//! depth; a part is left out when it is met at nearly the direction of a deeper one, or when its nearest point
//! lies on the tangent plane of a deeper one. A grain that rolls over a flat strip of parts thus has one
//! contact, at their joints too, and a grain in a corner has one with each side. Balls are bodies of their own
//! and are never left out.
//!
//! What a contact remembers belongs to the grain and the wall, not to the part: from step to step the contact
//! at the nearest direction takes it over. Together with the turning of springs with the normal
//! ([`Dim::follow`]) this carries history across joints.

use super::contact::{Surface, meet_surface};
use crate::contact::Contact;
use crate::contact::Partner;
use crate::contact::{contact_of, ongoing, overlap_of};
use crate::law::{ContactLaw, Kinematics};
use crate::lists::Places;
use crate::pass::Kernel;
use crate::view::View;
use crate::walls::Wall;
use granular_core::Shape;
use granular_core::shape::Facets;
use granular_core::snapshot::check_entry;
use granular_core::walls::Pose;
use granular_core::walls::Reaction;
use granular_core::{Blocks, Dim, Linear, Section, SnapshotError, Stored};
use std::ops::Range;

/// Cosine of the angle below which two parts are one: 15 degrees. Contacts at a larger angle begin with no
/// overlap wherever the overlap is below 3 % of the radius, so that neither rule makes energy.
const SAME_DIRECTION: f64 = 0.965_925_826_289_068_3;
/// Cosine of the largest turn of a contact from one step to the next: 20 degrees.
const SAME_CONTACT: f64 = 0.939_692_620_785_908_4;
/// Part of the radius by which a point may stand out of a tangent plane and still lie on it.
const FLAT: f64 = 1e-9;

/// A grain near a surface, and where its parts are in the list.
#[derive(Clone, Copy, Debug)]
struct Entry {
    grain: u32,
    wall: u32,
    from: u32,
    to: u32,
}

/// What one contact with a surface remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slot<D: Dim, M> {
    /// Direction of the contact when it was last used; tells contacts of one grain with a surface apart.
    normal: D::Vec,
    memory: M,
}

/// A part that a grain may touch.
#[derive(Clone, Copy, Debug)]
struct Candidate<D: Dim> {
    /// Place of the part in the list of the entry.
    place: u32,
    part: u32,
    normal: D::Vec,
    overlap: f64,
}

/// A memory between two lists: grain, wall, part (of a ball only), and what it was.
type Live<D, M> = (u32, u32, u32, Slot<D, M>);

/// Memories of an entry, and room for those of the step before.
struct Memories<'a, D: Dim, M> {
    slots: &'a mut [Slot<D, M>],
    old: &'a mut Vec<Slot<D, M>>,
}

/// The contacts of the grains of one block with surfaces of many parts.
#[derive(Clone, Debug)]
pub(crate) struct FacetList<D: Dim, M> {
    entries: Vec<Entry>,
    parts: Vec<u32>,
    /// As many as parts. Those of a ball belong to it; those of a chain or mesh are used from the front.
    slots: Vec<Slot<D, M>>,
    live: Vec<Live<D, M>>,
    candidates: Vec<Candidate<D>>,
    old: Vec<Slot<D, M>>,
}

impl<D: Dim, M> Default for FacetList<D, M> {
    fn default() -> Self {
        let (entries, parts, slots) = (Vec::new(), Vec::new(), Vec::new());
        Self { entries, parts, slots, live: Vec::new(), candidates: Vec::new(), old: Vec::new() }
    }
}

impl<D: Dim, M: Copy + Default + PartialEq> FacetList<D, M> {
    fn fresh() -> Slot<D, M> {
        Slot { normal: D::Vec::ZERO, memory: M::default() }
    }

    /// Lists the parts near the grains in `range`; memories that are not fresh move along.
    pub(crate) fn build(&mut self, view: &View<'_, D>, range: Range<usize>, skin: f64) {
        self.harvest(view.walls);
        for first in range {
            let reach = view.radius[first] + skin;
            for (wall, description) in view.walls.iter().enumerate() {
                let Shape::Facets(facets) = &description.shape else { continue };
                if description.open {
                    continue;
                }
                let from = self.parts.len();
                let point = match view.poses.get(wall) {
                    Some(pose) => pose.within_wall(view.position[first]),
                    None => view.position[first],
                };
                facets.visit_near(point, reach, |part| {
                    if facets.distance_to(part as usize, point).0 < reach {
                        self.parts.push(part);
                    }
                });
                self.parts[from..].sort_unstable();
                if self.parts.len() > from {
                    let (from, to) = (from as u32, self.parts.len() as u32);
                    self.entries.push(Entry { grain: first as u32, wall: wall as u32, from, to });
                }
            }
        }
        self.sow(view);
    }

    /// Takes the memories that are not fresh out of the list, which is then empty.
    pub(crate) fn harvest(&mut self, walls: &[Wall<D>]) {
        for entry in &self.entries {
            let balls = facets_of(walls, entry.wall).are_balls();
            for place in entry.from as usize..entry.to as usize {
                if self.slots[place].memory != M::default() {
                    let part = if balls { self.parts[place] } else { u32::MAX };
                    self.live.push((entry.grain, entry.wall, part, self.slots[place]));
                }
            }
        }
        self.entries.clear();
        self.parts.clear();
    }

    fn sow(&mut self, view: &View<'_, D>) {
        self.slots.clear();
        self.slots.resize(self.parts.len(), Self::fresh());
        for &(grain, wall, part, slot) in &self.live {
            let key = |entry: &Entry| (entry.grain, entry.wall);
            let Ok(found) = self.entries.binary_search_by_key(&(grain, wall), key) else { continue };
            let places = self.entries[found].from as usize..self.entries[found].to as usize;
            let place = if facets_of(view.walls, wall).are_balls() {
                self.parts[places.clone()].binary_search(&part).ok()
            } else {
                self.slots[places.clone()].iter().position(|slot| slot.memory == M::default())
            };
            if let Some(place) = place {
                self.slots[places.start + place] = slot;
            }
        }
        self.live.clear();
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<Entry>() * self.entries.capacity()
            + (size_of::<u32>() + size_of::<Slot<D, M>>()) * self.parts.capacity()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

fn facets_of<D: Dim>(walls: &[Wall<D>], wall: u32) -> &Facets<D> {
    match &walls[wall as usize].shape {
        Shape::Facets(facets) => facets,
        _ => unreachable!("only walls of many parts are listed here"),
    }
}

/// Finds the parts that a grain touches within the step, deepest first; for balls in the order of the list.
fn find<D: Dim>(
    view: &View<'_, D>,
    entry: Entry,
    parts: &[u32],
    pose: &Pose<D>,
    found: &mut Vec<Candidate<D>>,
) {
    found.clear();
    let facets = facets_of(view.walls, entry.wall);
    let (position, radius) = (view.position[entry.grain as usize], view.radius[entry.grain as usize]);
    let point = pose.within_wall(position);
    for (place, &part) in parts.iter().enumerate() {
        let (distance, normal) = facets.distance_to(part as usize, point);
        let overlap = radius - distance;
        if overlap > -view.margin.max(view.law_reach) {
            found.push(Candidate { place: place as u32, part, normal, overlap });
        }
    }
    if !facets.are_balls() && found.len() > 1 {
        found.sort_unstable_by(|a, b| b.overlap.total_cmp(&a.overlap).then(a.part.cmp(&b.part)));
        let mut kept = 0;
        for next in 0..found.len() {
            let candidate = found[next];
            if !found[..kept].iter().any(|deeper| covers(deeper, &candidate, radius)) {
                found[kept] = candidate;
                kept += 1;
            }
        }
        found.truncate(kept);
    }
    for candidate in found {
        candidate.normal = pose.out_of_wall(candidate.normal);
    }
}

/// Whether a contact is part of a deeper one.
fn covers<D: Dim>(deeper: &Candidate<D>, other: &Candidate<D>, radius: f64) -> bool {
    let cosine = deeper.normal.dot(other.normal);
    // Height of the nearest point of the other part over the tangent plane of the deeper one.
    let height = (radius - deeper.overlap) - (radius - other.overlap) * cosine;
    cosine > SAME_DIRECTION || height <= FLAT * radius
}

/// Takes the memory of the contact at the nearest direction out of `old`.
fn inherit<D: Dim, M: Copy + Default + PartialEq>(old: &mut Vec<Slot<D, M>>, normal: D::Vec) -> M {
    let alike = |slot: &Slot<D, M>| slot.normal.dot(normal);
    let best = (0..old.len()).max_by(|&a, &b| alike(&old[a]).total_cmp(&alike(&old[b])).then(b.cmp(&a)));
    match best.filter(|&place| alike(&old[place]) > SAME_CONTACT) {
        Some(place) => old.remove(place).memory,
        None => M::default(),
    }
}

/// The kinematics of a grain and a part, and the lever arm.
fn meet<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    entry: Entry,
    pose: &Pose<D>,
    candidate: &Candidate<D>,
) -> Option<(Kinematics<D>, f64)> {
    let ball = facets_of(view.walls, entry.wall).radius(candidate.part as usize);
    let surface = Surface { normal: candidate.normal, overlap: candidate.overlap, ball };
    meet_surface::<D, L>(view, entry.grain as usize, &surface, Some(pose))
}

impl<D: Dim, L: ContactLaw<D>, const LEDGER: bool> Kernel<'_, D, L, LEDGER> {
    /// Loads of surfaces of many parts on the grains of the block.
    pub(crate) fn facets(&mut self, list: &mut FacetList<D, L::Memory>, reactions: &mut [Reaction<D>]) {
        if list.is_empty() {
            return;
        }
        let FacetList { entries, parts, slots, candidates, old, .. } = list;
        let view = self.view;
        self.tally.at_walls();
        for &entry in entries.iter() {
            let range = entry.from as usize..entry.to as usize;
            let pose = view.poses.get(entry.wall as usize).copied().unwrap_or_default();
            find(view, entry, &parts[range.clone()], &pose, candidates);
            let slots = &mut slots[range];
            let reaction = reactions.get_mut(entry.wall as usize);
            if facets_of(view.walls, entry.wall).are_balls() {
                self.push_balls(entry, &pose, candidates, slots, reaction);
            } else {
                self.push_facets(entry, &pose, candidates, Memories { slots, old }, reaction);
            }
        }
    }

    fn push_balls(
        &mut self,
        entry: Entry,
        pose: &Pose<D>,
        candidates: &[Candidate<D>],
        slots: &mut [Slot<D, L::Memory>],
        mut reaction: Option<&mut Reaction<D>>,
    ) {
        let mut next = candidates.iter().peekable();
        for (place, slot) in slots.iter_mut().enumerate() {
            let candidate = next.next_if(|candidate| candidate.place as usize == place);
            let met = candidate.and_then(|candidate| meet::<D, L>(self.view, entry, pose, candidate));
            if let Some((kinematics, arm)) = met {
                slot.normal = kinematics.normal;
                self.push_wall(
                    entry.grain as usize,
                    entry.wall as usize,
                    (&kinematics, arm),
                    &mut slot.memory,
                    reaction.as_deref_mut(),
                );
            } else {
                self.end(entry, slot);
            }
        }
    }

    fn push_facets(
        &mut self,
        entry: Entry,
        pose: &Pose<D>,
        candidates: &[Candidate<D>],
        Memories { slots, old }: Memories<'_, D, L::Memory>,
        mut reaction: Option<&mut Reaction<D>>,
    ) {
        let fresh = L::Memory::default();
        old.clear();
        old.extend(slots.iter().filter(|slot| slot.memory != fresh));
        slots.fill(FacetList::fresh());
        let mut used = 0;
        for candidate in candidates {
            let Some((kinematics, arm)) = meet::<D, L>(self.view, entry, pose, candidate) else { continue };
            let mut memory = inherit(old, kinematics.normal);
            self.push_wall(
                entry.grain as usize,
                entry.wall as usize,
                (&kinematics, arm),
                &mut memory,
                reaction.as_deref_mut(),
            );
            slots[used] = Slot { normal: kinematics.normal, memory };
            used += 1;
        }
        old.iter_mut().for_each(|slot| self.end(entry, slot));
    }

    /// Ends a contact that remembers something.
    fn end(&mut self, entry: Entry, slot: &mut Slot<D, L::Memory>) {
        if slot.memory != L::Memory::default() {
            let grain = self.view.material_of(entry.grain as usize);
            let law = self.laws.between(grain, self.view.walls[entry.wall as usize].material.0);
            law.release(&slot.memory, &mut self.tally);
            *slot = FacetList::fresh();
        }
    }
}

/// Visits the contacts of a list that overlap, with the memory that the next step would give them.
pub(crate) fn visit<D: Dim, L: ContactLaw<D>>(
    list: &FacetList<D, L::Memory>,
    view: &View<'_, D>,
    laws: crate::view::Laws<'_, L>,
    visit: &mut dyn FnMut(Contact<D>),
) {
    let mut candidates = Vec::new();
    for &entry in &list.entries {
        let range = entry.from as usize..entry.to as usize;
        let pose = view.poses.get(entry.wall as usize).copied().unwrap_or_default();
        find(view, entry, &list.parts[range.clone()], &pose, &mut candidates);
        let balls = facets_of(view.walls, entry.wall).are_balls();
        let slots = &list.slots[range];
        let mut old: Vec<_> =
            slots.iter().filter(|slot| slot.memory != L::Memory::default()).copied().collect();
        let least = if L::REACHES { -view.law_reach } else { 0.0 };
        for candidate in candidates.iter().filter(|candidate| candidate.overlap > least) {
            let Some((kinematics, _)) = meet::<D, L>(view, entry, &pose, candidate) else { continue };
            let memory = if balls {
                slots[candidate.place as usize].memory
            } else {
                inherit(&mut old, kinematics.normal)
            };
            let (first, wall) = (entry.grain as usize, entry.wall as usize);
            let law = laws.between(view.material_of(first), view.walls[wall].material.0);
            if !ongoing::<D, L>(law, &kinematics, &memory) {
                continue;
            }
            let branch = kinematics.normal * (view.radius[first] - overlap_of::<D, L>(&kinematics));
            visit(contact_of::<D, L>(law, &kinematics, memory, (first, Partner::Wall(wall)), branch));
        }
    }
}

/// Whether any wall is a surface of many parts.
pub(crate) fn needed<D: Dim>(walls: &[Wall<D>]) -> bool {
    walls.iter().any(|wall| matches!(wall.shape, Shape::Facets(_)))
}

/// Moves memories to the blocks that own them, see [`crate::lists::regroup`].
pub(crate) fn regroup<D: Dim, M: Copy + Default + PartialEq>(
    lists: &mut Vec<FacetList<D, M>>,
    walls: &[Wall<D>],
    now: Blocks,
    place: &[u32],
) {
    let mut all = Vec::new();
    for list in lists.iter_mut() {
        list.harvest(walls);
        all.append(&mut list.live);
    }
    lists.resize_with(now.count(), FacetList::default);
    for (grain, wall, part, slot) in all {
        let grain = place[grain as usize];
        if grain != u32::MAX {
            lists[grain as usize / now.size()].live.push((grain, wall, part, slot));
        }
    }
}

/// Saves memories that are not fresh, by the stable identifiers of the grains.
pub(crate) fn save<D: Dim, M: Copy + Default + PartialEq + Stored>(
    lists: &[FacetList<D, M>],
    walls: &[Wall<D>],
    ids: &[u32],
    to: &mut Section,
) {
    if !needed(walls) {
        return;
    }
    let (mut contacts, mut normals, mut memories) = (Vec::new(), Vec::new(), Vec::new());
    for list in lists {
        for entry in &list.entries {
            let balls = facets_of(walls, entry.wall).are_balls();
            for place in entry.from as usize..entry.to as usize {
                if list.slots[place].memory != M::default() {
                    let part = if balls { list.parts[place] } else { u32::MAX };
                    contacts.push([ids[entry.grain as usize], entry.wall, part]);
                    normals.push(list.slots[place].normal);
                    memories.push(list.slots[place].memory);
                }
            }
        }
    }
    to.put("contacts with surfaces", &contacts);
    to.put("directions of contacts with surfaces", &normals);
    to.put("memories of contacts with surfaces", &memories);
}

/// Restores memories; they enter the lists at the next build.
pub(crate) fn restore<D: Dim, M: Copy + Default + PartialEq + Stored>(
    lists: &mut [FacetList<D, M>],
    walls: &[Wall<D>],
    blocks: Blocks,
    places: &Places,
    from: &Section,
) -> Result<(), SnapshotError> {
    lists.iter_mut().for_each(|list| *list = FacetList::default());
    if !needed(walls) {
        return Ok(());
    }
    let contacts: Vec<[u32; 3]> = from.array("contacts with surfaces")?;
    let normals: Vec<D::Vec> = from.array_of("directions of contacts with surfaces", contacts.len())?;
    let memories: Vec<M> = from.array_of("memories of contacts with surfaces", contacts.len())?;
    let finite = normals.iter().all(|normal| normal.is_finite());
    check_entry("directions of contacts with surfaces", finite)?;
    for ((&[grain, wall, part], &normal), &memory) in contacts.iter().zip(&normals).zip(&memories) {
        let known = walls.get(wall as usize).is_some_and(|wall| matches!(wall.shape, Shape::Facets(_)));
        check_entry("contacts with surfaces", known)?;
        let grain = places.find(grain)?;
        let slot = Slot { normal, memory };
        lists[grain as usize / blocks.size()].live.push((grain, wall, part, slot));
    }
    Ok(())
}
