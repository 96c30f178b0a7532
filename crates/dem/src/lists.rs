//! Lists of near pairs and what their contacts remember, block by block.
//!
//! A list holds all pairs with surfaces nearer than the skin, so that it serves for many steps
//! \[DEM-13\]. Pairs that do not touch add nothing to any sum: a list may be rebuilt at any time
//! without a change of bits.

use crate::view::View;
use granular_core::Shape;
use granular_core::search::Neighbours;
use granular_core::{Blocks, Dim, Linear, Section, SnapshotError, Stored};
use std::ops::Range;

/// A grain near a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NearWall {
    pub(crate) grain: u32,
    pub(crate) wall: u32,
}

/// Where to collect: grain within the block, owing block, and place there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receipt {
    pub(crate) grain: u32,
    pub(crate) block: u32,
    pub(crate) place: u32,
}

impl Receipt {
    /// Grains first keeps writes in order of memory. The key is unique, so that an unstable sort,
    /// which does not allocate, has one outcome.
    pub(crate) fn order(&self) -> (u32, u32, u32) {
        (self.grain, self.block, self.place)
    }
}

/// The pairs of the grains of one block with all earlier grains.
#[derive(Clone, Debug)]
pub(crate) struct BlockList<M> {
    /// Where the partners of each grain of the block start; one more at the end.
    pub(crate) starts: Vec<u32>,
    /// Earlier grains near each grain, in rising order.
    pub(crate) partners: Vec<u32>,
    pub(crate) memory: Vec<M>,
    /// Whether each pair touched in the last step, so that its memory is not fresh.
    pub(crate) touching: Vec<bool>,
    pub(crate) near_walls: Vec<NearWall>,
    pub(crate) wall_memory: Vec<M>,
    /// Memories that are not fresh, between two builds: pairs of grains, then walls.
    live: Vec<(u32, u32, M)>,
    live_walls: Vec<(NearWall, M)>,
}

impl<M> Default for BlockList<M> {
    fn default() -> Self {
        Self {
            starts: Vec::new(),
            partners: Vec::new(),
            memory: Vec::new(),
            touching: Vec::new(),
            near_walls: Vec::new(),
            wall_memory: Vec::new(),
            live: Vec::new(),
            live_walls: Vec::new(),
        }
    }
}

impl<M: Copy + Default + PartialEq> BlockList<M> {
    /// Lists the pairs of the grains in `range`; memories that are not fresh move along.
    pub(crate) fn build<D: Dim>(
        &mut self,
        view: &View<'_, D>,
        near: &impl Neighbours<D>,
        range: Range<usize>,
        skin: f64,
    ) {
        self.harvest(range.start);
        self.starts.clear();
        self.partners.clear();
        self.near_walls.clear();
        self.starts.push(0);
        for first in range.clone() {
            let (position, radius) = (view.position[first], view.radius[first]);
            let from = self.partners.len();
            near.visit_near(position, radius, |second| {
                if (second as usize) < first {
                    let reach = radius + view.radius[second as usize] + skin;
                    if (position - view.position[second as usize]).length_squared() < reach * reach {
                        self.partners.push(second);
                    }
                }
            });
            self.partners[from..].sort_unstable();
            self.starts.push(self.partners.len() as u32);
            for (wall, description) in view.walls.iter().enumerate() {
                // Surfaces of many parts have lists of their own.
                if description.open || matches!(description.shape, Shape::Facets(_)) {
                    continue;
                }
                let point = view.poses.get(wall).map_or(position, |pose| pose.within_wall(position));
                if description.shape.distance(point).0 < radius + skin {
                    self.near_walls.push(NearWall { grain: first as u32, wall: wall as u32 });
                }
            }
        }
        self.sow(range.start);
    }

    /// Takes the memories that are not fresh out of the list.
    fn harvest(&mut self, start: usize) {
        let fresh = M::default();
        for local in 0..self.starts.len().saturating_sub(1) {
            for k in self.starts[local] as usize..self.starts[local + 1] as usize {
                if self.memory[k] != fresh {
                    self.live.push(((start + local) as u32, self.partners[k], self.memory[k]));
                }
            }
        }
        let walls = self.near_walls.iter().zip(&self.wall_memory);
        self.live_walls.extend(walls.filter(|(_, m)| **m != fresh).map(|(near, m)| (*near, *m)));
        self.starts.clear();
        self.near_walls.clear();
    }

    /// Takes the memories of pairs of grains that are not fresh out of the list; those of walls stay.
    pub(crate) fn harvest_pairs(&mut self, start: usize, mut take: impl FnMut(u32, u32, M)) {
        self.harvest(start);
        self.live.drain(..).for_each(|(first, second, memory)| take(first, second, memory));
    }

    /// Makes room for lists that change as a cell deforms, so that steps do not allocate.
    pub(crate) fn spare(&mut self) {
        spare(&mut self.partners, 0);
        spare(&mut self.memory, 0);
        spare(&mut self.touching, 0);
        spare(&mut self.near_walls, 0);
        spare(&mut self.wall_memory, 0);
        self.live
            .reserve(self.memory.capacity().saturating_sub(self.live.len()).min(4 * self.partners.len()));
    }

    /// A memory for the next list.
    pub(crate) fn remember(&mut self, first: u32, second: u32, memory: M) {
        self.live.push((first, second, memory));
    }

    /// Puts the memories into the new list. A pair that is not near any more had ended.
    fn sow(&mut self, start: usize) {
        self.memory.clear();
        self.memory.resize(self.partners.len(), M::default());
        self.touching.clear();
        self.touching.resize(self.partners.len(), false);
        for &(first, second, memory) in &self.live {
            let local = first as usize - start;
            let from = self.starts[local] as usize;
            let partners = &self.partners[from..self.starts[local + 1] as usize];
            if let Ok(place) = partners.binary_search(&second) {
                self.memory[from + place] = memory;
                self.touching[from + place] = true;
            }
        }
        self.live.clear();
        self.wall_memory.clear();
        self.wall_memory.resize(self.near_walls.len(), M::default());
        for (near, memory) in &self.live_walls {
            if let Ok(place) = self.near_walls.binary_search(near) {
                self.wall_memory[place] = *memory;
            }
        }
        self.live_walls.clear();
    }

    /// Changes what a listed pair remembers, where `change` gives something. Returns whether it did; `start` is the first
    /// grain of the block.
    pub(crate) fn set_memory(
        &mut self,
        start: usize,
        (first, second): (usize, usize),
        change: impl FnOnce(M) -> Option<M>,
    ) -> bool {
        let local = first - start;
        let from = self.starts[local] as usize;
        let partners = &self.partners[from..self.starts[local + 1] as usize];
        let Ok(place) = partners.binary_search(&(second as u32)) else { return false };
        let Some(changed) = change(self.memory[from + place]) else { return false };
        self.memory[from + place] = changed;
        self.touching[from + place] = true;
        true
    }

    /// Calls `visit` for every listed pair.
    pub(crate) fn visit_pairs(&self, range: Range<usize>, mut visit: impl FnMut(usize, usize, &M)) {
        for (local, first) in range.enumerate().take(self.starts.len().saturating_sub(1)) {
            for k in self.starts[local] as usize..self.starts[local + 1] as usize {
                visit(first, self.partners[k] as usize, &self.memory[k]);
            }
        }
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        4 * (self.starts.capacity() + self.partners.capacity())
            // One by one: without memory a capacity is the largest number there is.
            + size_of::<M>() * self.memory.capacity()
            + self.touching.capacity()
            + size_of::<M>() * self.wall_memory.capacity()
            + size_of::<NearWall>() * self.near_walls.capacity()
    }
}

/// Doubles the room of a list that has nearly filled it, and gives it `least` in any case.
pub(crate) fn spare<T>(list: &mut Vec<T>, least: usize) {
    if list.capacity() < least.max(list.len() + list.len() / 4 + 4) {
        list.reserve((list.len() + 16).max(least.saturating_sub(list.len())));
    }
}

/// Where each grain is now, when `order` gives the old index of each place.
pub(crate) fn places(order: &[u32]) -> Vec<u32> {
    let mut place = vec![0_u32; order.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old as usize] = new as u32;
    }
    place
}

/// Moves memories to the blocks that own them after grains were re-sorted, put in or taken out: `place` tells
/// where each grain is now, [`u32::MAX`] for one that went.
pub(crate) fn regroup<M: Copy + Default + PartialEq>(
    lists: &mut Vec<BlockList<M>>,
    (before, now): (Blocks, Blocks),
    place: &[u32],
    reversed: impl Fn(M) -> M,
) {
    let mut pairs = Vec::new();
    let mut walls = Vec::new();
    for (block, list) in lists.iter_mut().enumerate() {
        list.harvest(before.range(block).start);
        pairs.append(&mut list.live);
        walls.append(&mut list.live_walls);
    }
    lists.resize_with(now.count(), BlockList::default);
    for (first, second, memory) in pairs {
        let (a, b) = (place[first as usize], place[second as usize]);
        if a != u32::MAX && b != u32::MAX {
            let moved = if a > b { (a, b, memory) } else { (b, a, reversed(memory)) };
            lists[moved.0 as usize / now.size()].live.push(moved);
        }
    }
    for (near, memory) in walls {
        let grain = place[near.grain as usize];
        if grain != u32::MAX {
            lists[grain as usize / now.size()].live_walls.push((NearWall { grain, ..near }, memory));
        }
    }
}

/// Tells every block where it is owed a load: by its grains, then by the owing block and place.
pub(crate) fn fill_inboxes<M>(lists: &[BlockList<M>], blocks: Blocks, inboxes: &mut [Vec<Receipt>]) {
    inboxes.iter_mut().for_each(Vec::clear);
    for (block, list) in lists.iter().enumerate() {
        let start = blocks.range(block).start;
        let abroad = list.partners.iter().filter(|&&partner| (partner as usize) < start);
        for (place, &partner) in abroad.enumerate() {
            let receiver = partner as usize / blocks.size();
            let grain = partner - blocks.range(receiver).start as u32;
            inboxes[receiver].push(Receipt { grain, block: block as u32, place: place as u32 });
        }
    }
    inboxes.iter_mut().for_each(|inbox| inbox.sort_unstable_by_key(Receipt::order));
}

/// Saves the memories that are not fresh, by the stable identifiers of the grains.
pub(crate) fn save<M: Copy + Default + PartialEq + Stored>(
    lists: &[BlockList<M>],
    blocks: Blocks,
    ids: &[u32],
    to: &mut Section,
) {
    let (mut pairs, mut memories) = (Vec::new(), Vec::new());
    let (mut walls, mut wall_memories) = (Vec::new(), Vec::new());
    for (block, list) in lists.iter().enumerate() {
        list.visit_pairs(blocks.range(block), |first, second, memory| {
            if *memory != M::default() {
                pairs.push([ids[first], ids[second]]);
                memories.push(*memory);
            }
        });
        for (near, memory) in list.near_walls.iter().zip(&list.wall_memory) {
            if *memory != M::default() {
                walls.push([ids[near.grain as usize], near.wall]);
                wall_memories.push(*memory);
            }
        }
    }
    to.put("contact pairs", &pairs);
    to.put("contact memories", &memories);
    to.put("wall contacts", &walls);
    to.put("wall contact memories", &wall_memories);
}

/// Where the grain of each identifier is.
pub(crate) struct Places(Vec<(u32, u32)>);

impl Places {
    pub(crate) fn of(ids: &[u32]) -> Result<Self, SnapshotError> {
        let mut places: Vec<(u32, u32)> =
            ids.iter().enumerate().map(|(index, &id)| (id, index as u32)).collect();
        places.sort_unstable();
        match places.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(Self::damaged(format!("grain {} is there twice", pair[0].0))),
            None => Ok(Self(places)),
        }
    }

    pub(crate) fn find(&self, id: u32) -> Result<u32, SnapshotError> {
        let found = self.0.binary_search_by_key(&id, |place| place.0);
        found.map(|place| self.0[place].1).map_err(|_| Self::damaged(format!("grain {id} does not exist")))
    }

    fn damaged(found: String) -> SnapshotError {
        SnapshotError::Damaged { place: "solver/contact pairs".to_owned(), found }
    }
}

/// Restores memories; they enter the lists at the next build.
pub(crate) fn restore<M: Copy + Default + PartialEq + Stored>(
    lists: &mut [BlockList<M>],
    blocks: Blocks,
    places: &Places,
    from: &Section,
) -> Result<(), SnapshotError> {
    lists.iter_mut().for_each(|list| *list = BlockList::default());
    let pairs: Vec<[u32; 2]> = from.array("contact pairs")?;
    let memories: Vec<M> = from.array_of("contact memories", pairs.len())?;
    for (&[first, second], &memory) in pairs.iter().zip(&memories) {
        let (first, second) = (places.find(first)?, places.find(second)?);
        lists[first as usize / blocks.size()].live.push((first, second, memory));
    }
    let walls: Vec<[u32; 2]> = from.array("wall contacts")?;
    let memories: Vec<M> = from.array_of("wall contact memories", walls.len())?;
    for (&[grain, wall], &memory) in walls.iter().zip(&memories) {
        let grain = places.find(grain)?;
        lists[grain as usize / blocks.size()].live_walls.push((NearWall { grain, wall }, memory));
    }
    Ok(())
}

/// Whether all positions are finite: a list cannot be built otherwise.
pub(crate) fn all_finite<D: Dim>(positions: &[D::Vec]) -> Option<usize> {
    positions.iter().position(|position| !position.is_finite())
}
