//! Contacts: who is near whom, what each contact remembers, and the loads.
//!
//! Grains are cut into blocks. A block owns the pairs of its grains with all earlier grains. It
//! adds the load to both grains when both are its own; what it owes to a grain of an earlier
//! block goes to `outgoing`, from where that block collects it in the order of its `inbox`.
//! Every grain thus sums its loads in an order that depends on the state alone.

use crate::contact::{Contact, Partner, contact_of, ongoing, overlap_of};
use crate::grains::Grains;
use crate::kinematics::overlapping;
use crate::law::{ContactLaw, LawLimits, MaterialLaw};
use crate::ledger::{Losses, Tally};
use crate::lists::{BlockList, NearWall, Places, Receipt, places, spare};
use crate::material::{Materials, PairProperties, Tension};
use crate::pass::{Kernel, Owed, Trouble};
use crate::periodic::PeriodicCell;
use crate::periodic::images::{self, Bounds, ImageList, ImagePair, Moved, meet_image};
use crate::view::{Laws, View};
use crate::walls::Wall;
use crate::walls::contact::meet_wall;
use crate::walls::surfaces::{self, FacetList};
use granular_core::search::{CellGrid, Neighbours, SizeLevels};
use granular_core::walls::Reaction;
use granular_core::{Blocks, Dim, Linear, PerBlock, Section, SnapshotError};
use multiversion::multiversion;

/// Contacts of a solver, whatever their law.
pub(crate) trait Pairs<D: Dim>: Send + Sync {
    /// Lists all pairs with surfaces nearer than `skin`; memories move along. `order` gives the
    /// old index of each grain when grains were re-sorted.
    fn list(&mut self, view: &View<'_, D>, skin: f64, order: Option<&[u32]>);
    /// Writes the loads of all contacts to `force` and `torque`, except what [`Pairs::collect`] adds.
    /// Memories move with grains that were put in or taken out: `place` tells where each is now.
    fn regroup(&mut self, walls: &[Wall<D>], blocks: Blocks, place: &[u32]);
    /// Another number of grains, whose memories will be restored.
    fn resize(&mut self, blocks: Blocks);
    fn push(&mut self, view: &View<'_, D>, ledger: bool, force: &mut [D::Vec], torque: &mut [D::Spin]);
    /// Adds what other blocks owe to the grains of `block`.
    fn collect(&self, block: usize, force: &mut [D::Vec], torque: &mut [D::Spin]);
    /// Adds up the push on each wall in the last push, when walls move.
    fn add_reactions(&self, to: &mut [Reaction<D>]);
    /// Losses of the last push, and a contact that was too deep.
    fn outcome(&self) -> (Losses, Option<Trouble>);
    /// Visits all contacts that overlap, in a fixed order.
    fn visit(&self, view: &View<'_, D>, visit: &mut dyn FnMut(Contact<D>));
    /// Visits all listed pairs of grains, with the distance of their centres.
    fn visit_listed(&self, view: &View<'_, D>, visit: &mut dyn FnMut(usize, usize, f64));
    /// Sets the tangential spring of a contact that overlaps. Returns whether there is one whose law remembers a spring.
    fn set_spring(&mut self, view: &View<'_, D>, first: usize, partner: Partner, spring: D::Spin) -> bool;
    /// For each axis, the sum over contacts across faces of the cell of the force on the first grain
    /// times the edges between the grains \[N\].
    fn pull(&self) -> [D::Vec; 3];
    /// Moves memories of contacts in a cell; lists are to be built next.
    fn relocate(&mut self, moved: &Moved<'_>);
    /// Takes changed materials.
    fn update(&mut self, materials: &Materials, tension: Tension);
    fn save(&self, grains: &Grains<D>, walls: &[Wall<D>], to: &mut Section);
    fn restore(&mut self, from: &Section, grains: &Grains<D>, walls: &[Wall<D>])
    -> Result<(), SnapshotError>;
    fn law_name(&self) -> &'static str;
    fn tangential(&self) -> bool;
    /// Whether any law asks for the predicted motion across contacts.
    fn predicts(&self) -> bool;
    /// Distance of surfaces \[m\] up to which some law acts.
    fn reach(&self) -> f64;
    /// What a law says of its limits between two materials at an effective mass \[kg\].
    fn limits(&self, a: usize, b: usize, effective_mass: f64) -> Option<LawLimits>;
    /// Bytes in lists, and bytes that one contact remembers.
    fn bytes(&self) -> (usize, usize);
}

/// Makes the law between two materials.
pub(crate) type Between<L> = Box<dyn Fn(&PairProperties, Tension) -> L + Send + Sync>;

pub(crate) struct Contacts<D: Dim, L: ContactLaw<D>> {
    /// By material of the first times `materials` plus material of the second.
    laws: Vec<L>,
    /// The law between two materials.
    between: Between<L>,
    materials: usize,
    blocks: Blocks,
    lists: Vec<BlockList<L::Memory>>,
    facets: Vec<FacetList<D, L::Memory>>,
    /// Push on each wall by the grains of each block; empty when no wall moves.
    reactions: Vec<Vec<Reaction<D>>>,
    /// One per block in a periodic cell; none elsewhere.
    images: Vec<ImageList<D, L::Memory>>,
    relocated: Vec<(ImagePair, L::Memory)>,
    outgoing: Vec<Vec<Owed<D>>>,
    inbox: Vec<Vec<Receipt>>,
    grid: CellGrid<D>,
    /// In place of the grid where sizes differ much.
    levels: Option<Box<SizeLevels<D>>>,
    results: Vec<(Losses, Option<Trouble>)>,
}

impl<D: Dim, L: MaterialLaw<D>> Contacts<D, L> {
    pub(crate) fn of_materials(materials: &Materials, tension: Tension, blocks: Blocks) -> Self {
        Self::new(materials, tension, blocks, Box::new(L::between))
    }
}

impl<D: Dim, L: ContactLaw<D>> Contacts<D, L> {
    pub(crate) fn new(materials: &Materials, tension: Tension, blocks: Blocks, between: Between<L>) -> Self {
        let count = blocks.count();
        let mut contacts = Self {
            laws: Vec::new(),
            between,
            materials: materials.len(),
            blocks,
            lists: (0..count).map(|_| BlockList::default()).collect(),
            facets: (0..count).map(|_| FacetList::default()).collect(),
            reactions: vec![Vec::new(); count],
            images: Vec::new(),
            relocated: Vec::new(),
            outgoing: vec![Vec::new(); count],
            inbox: vec![Vec::new(); count],
            grid: CellGrid::default(),
            levels: None,
            results: vec![(Losses::default(), None); count],
        };
        Pairs::<D>::update(&mut contacts, materials, tension);
        contacts
    }

    /// Lists pairs across the faces of a cell, after ordinary ones.
    fn list_images(
        &mut self,
        view: &View<'_, D>,
        cell: &PeriodicCell<D>,
        order: Option<&[u32]>,
        skin: f64,
        largest: f64,
    ) {
        self.images.resize_with(self.blocks.count(), ImageList::default);
        if let Some(order) = order {
            self.relocate(&Moved::Sorted { places: &places(order) });
        }
        let bounds = Bounds::of(cell, view.position);
        let blocks = self.blocks;
        if let Some(levels) = self.levels.as_deref() {
            let near = images::Near { view, cell, search: levels, bounds: &bounds, skin, largest };
            build_images(&mut self.images, blocks, &near);
        } else {
            let near = images::Near { view, cell, search: &self.grid, bounds: &bounds, skin, largest };
            build_images(&mut self.images, blocks, &near);
        }
        for (block, (list, outgoing)) in self.images.iter_mut().zip(&mut self.outgoing).enumerate() {
            let start = blocks.range(block).start as u32;
            list.owed = list.pairs.iter().filter(|pair| pair.second < start).count();
            outgoing.resize(outgoing.len() + list.owed, Owed::default());
            // What a compact block can owe, and be owed, across its border changes as the cell deforms.
            spare(outgoing, blocks.size());
        }
        self.lists.iter_mut().for_each(BlockList::spare);
        images::fill_inboxes(&self.images, &self.outgoing, blocks, &mut self.inbox);
    }

    fn visit_images(&self, view: &View<'_, D>, visit: &mut dyn FnMut(Contact<D>)) {
        let laws = Laws { list: &self.laws, materials: self.materials };
        let Some(cell) = view.cell else { return };
        for list in &self.images {
            for (pair, &memory) in list.pairs.iter().zip(&list.memory) {
                let met = meet_image::<D, L>(view, cell, pair, view.law_reach);
                let Some((kinematics, _, _)) = met else { continue };
                let (first, second) = (pair.first as usize, pair.second as usize);
                let law = laws.between(view.material_of(first), view.material_of(second));
                let branch = view.position[first] - view.position[second] - cell.offset(pair.shift);
                let bodies = (first, Partner::Grain(second));
                if !ongoing::<D, L>(law, &kinematics, &memory) {
                    continue;
                }
                let contact = contact_of::<D, L>(law, &kinematics, memory, bodies, branch);
                visit(Contact { shift: pair.shift, ..contact });
            }
        }
    }

    fn set_spring_of_pair(
        &mut self,
        view: &View<'_, D>,
        first: usize,
        second: usize,
        spring: D::Spin,
    ) -> bool {
        let laws = Laws { list: &self.laws, materials: self.materials };
        let law = laws.between(view.material_of(first), view.material_of(second));
        let block = first / self.blocks.size();
        if let Some(kinematics) = overlapping::<D, L>(view, first, second) {
            let spring = D::tangential(spring, kinematics.normal);
            return self.lists[block].set_memory(self.blocks.range(block).start, (first, second), |memory| {
                law.with_spring(&kinematics, memory, spring)
            });
        }
        let (Some(cell), Some(images)) = (view.cell, self.images.get_mut(block)) else { return false };
        for (pair, memory) in images.pairs.iter().zip(&mut images.memory) {
            if (pair.first as usize, pair.second as usize) != (first, second) {
                continue;
            }
            let Some((kinematics, ..)) = meet_image::<D, L>(view, cell, pair, 0.0) else { continue };
            let spring = D::tangential(spring, kinematics.normal);
            let changed = law.with_spring(&kinematics, *memory, spring);
            *memory = changed.unwrap_or(*memory);
            return changed.is_some();
        }
        false
    }

    fn set_spring_at_wall(&mut self, view: &View<'_, D>, first: usize, wall: usize, spring: D::Spin) -> bool {
        let laws = Laws { list: &self.laws, materials: self.materials };
        let law = laws.between(view.material_of(first), view.walls[wall].material.0);
        let met = if view.poses.is_empty() {
            meet_wall::<D, L, false>(view, first, wall)
        } else {
            meet_wall::<D, L, true>(view, first, wall)
        };
        let Some((kinematics, _)) = met.filter(|(kinematics, _)| kinematics.overlap > 0.0) else {
            return false;
        };
        let list = &mut self.lists[first / self.blocks.size()];
        let near = NearWall { grain: first as u32, wall: wall as u32 };
        let Ok(place) = list.near_walls.binary_search(&near) else { return false };
        let spring = D::tangential(spring, kinematics.normal);
        let changed = law.with_spring(&kinematics, list.wall_memory[place], spring);
        list.wall_memory[place] = changed.unwrap_or(list.wall_memory[place]);
        changed.is_some()
    }

    fn push_ledger<const LEDGER: bool>(
        &mut self,
        view: &View<'_, D>,
        force: &mut [D::Vec],
        torque: &mut [D::Spin],
    ) {
        let (laws, blocks) = (Laws { list: &self.laws, materials: self.materials }, self.blocks);
        let work = (
            PerBlock(&mut self.lists),
            (PerBlock(&mut self.facets), PerBlock(&mut self.reactions)),
            PerBlock(&mut self.outgoing),
            PerBlock(&mut self.results),
            PerBlock(&mut self.images),
            force,
            torque,
        );
        let moving = !view.poses.is_empty();
        blocks.for_each(
            work,
            |block, (list, (facets, reactions), outgoing, result, images, force, torque)| {
                let mut kernel = Kernel::<D, L, LEDGER> {
                    view,
                    laws,
                    start: blocks.range(block).start,
                    force,
                    torque,
                    tally: Tally::default(),
                    trouble: None,
                };
                pass(&mut kernel, &mut list.0[0], &mut outgoing.0[0]);
                if let (Some(cell), Some(images)) = (view.cell, images.0.first_mut()) {
                    let of_images = outgoing.0[0].len() - images.owed;
                    kernel.images(cell, images, &mut outgoing.0[0][of_images..]);
                }
                let reactions = &mut reactions.0[0];
                if moving {
                    reactions.fill(Reaction::default());
                    kernel.walls::<true>(&mut list.0[0], reactions);
                } else {
                    kernel.walls::<false>(&mut list.0[0], reactions);
                }
                kernel.facets(&mut facets.0[0], reactions);
                result.0[0] = (kernel.tally.losses(), kernel.trouble);
            },
        );
    }
}

fn build_pairs<D: Dim, M: Copy + Default + PartialEq + Send>(
    lists: &mut [BlockList<M>],
    blocks: Blocks,
    view: &View<'_, D>,
    near: &(impl Neighbours<D> + Sync),
    skin: f64,
) {
    blocks.for_each(PerBlock(lists), |block, list| {
        list.0[0].build(view, near, blocks.range(block), skin);
    });
}

fn build_images<D: Dim, M: Copy + Default + PartialEq + Send>(
    images: &mut [ImageList<D, M>],
    blocks: Blocks,
    near: &images::Near<'_, D, impl Neighbours<D> + Sync>,
) {
    blocks.for_each(PerBlock(images), |block, list| list.0[0].build(near, blocks.range(block)));
}

impl<D: Dim, L: ContactLaw<D>> Pairs<D> for Contacts<D, L> {
    fn list(&mut self, view: &View<'_, D>, skin: f64, order: Option<&[u32]>) {
        let (smallest, largest) =
            view.radius.iter().fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), &r| (a.min(r), b.max(r)));
        if SizeLevels::<D>::suits(smallest, largest) {
            self.levels.get_or_insert_default().fill(view.position, view.radius, skin);
        } else {
            self.levels = None;
            self.grid.fill(view.position, 2.0 * largest + skin);
        }
        if let Some(order) = order {
            self.regroup(view.walls, self.blocks, &crate::lists::places(order));
        }
        let blocks = self.blocks;
        match self.levels.as_deref() {
            Some(levels) => build_pairs(&mut self.lists, blocks, view, levels, skin),
            None => build_pairs(&mut self.lists, blocks, view, &self.grid, skin),
        }
        self.reactions.iter_mut().for_each(|of_block| of_block.resize(view.poses.len(), Reaction::default()));
        if surfaces::needed(view.walls) {
            blocks.for_each(PerBlock(&mut self.facets), |block, list| {
                list.0[0].build(view, blocks.range(block), skin);
            });
        }
        for (block, (list, outgoing)) in self.lists.iter().zip(&mut self.outgoing).enumerate() {
            let owed = list.partners.iter().filter(|&&p| (p as usize) < blocks.range(block).start).count();
            outgoing.clear();
            outgoing.resize(owed, Owed::default());
        }
        crate::lists::fill_inboxes(&self.lists, blocks, &mut self.inbox);
        if let Some(cell) = view.cell {
            self.list_images(view, cell, order, skin, largest);
        }
    }

    fn regroup(&mut self, walls: &[Wall<D>], blocks: Blocks, place: &[u32]) {
        crate::lists::regroup(&mut self.lists, (self.blocks, blocks), place, L::reversed);
        surfaces::regroup(&mut self.facets, walls, blocks, place);
        self.resize(blocks);
    }

    fn resize(&mut self, blocks: Blocks) {
        let count = blocks.count();
        self.blocks = blocks;
        self.lists.resize_with(count, BlockList::default);
        self.facets.resize_with(count, FacetList::default);
        self.reactions.resize_with(count, Vec::new);
        self.outgoing.resize_with(count, Vec::new);
        self.inbox.resize_with(count, Vec::new);
        self.results.resize(count, (Losses::default(), None));
    }

    fn push(&mut self, view: &View<'_, D>, ledger: bool, force: &mut [D::Vec], torque: &mut [D::Spin]) {
        if ledger {
            self.push_ledger::<true>(view, force, torque);
        } else {
            self.push_ledger::<false>(view, force, torque);
        }
    }

    fn collect(&self, block: usize, force: &mut [D::Vec], torque: &mut [D::Spin]) {
        for receipt in &self.inbox[block] {
            let owed = &self.outgoing[receipt.block as usize][receipt.place as usize];
            force[receipt.grain as usize] += owed.force;
            if L::TANGENTIAL {
                torque[receipt.grain as usize] += owed.torque;
            }
        }
    }

    fn add_reactions(&self, to: &mut [Reaction<D>]) {
        for (wall, sum) in to.iter_mut().enumerate() {
            for of_block in &self.reactions {
                sum.force += of_block[wall].force;
                sum.power += of_block[wall].power;
            }
        }
    }

    fn outcome(&self) -> (Losses, Option<Trouble>) {
        let mut losses = Losses::default();
        let mut trouble = None;
        for &(block_losses, block_trouble) in &self.results {
            losses += block_losses;
            trouble = trouble.or(block_trouble);
        }
        (losses, trouble)
    }

    fn visit(&self, view: &View<'_, D>, visit: &mut dyn FnMut(Contact<D>)) {
        let laws = Laws { list: &self.laws, materials: self.materials };
        for (block, list) in self.lists.iter().enumerate() {
            list.visit_pairs(self.blocks.range(block), |first, second, &memory| {
                if let Some(kinematics) = overlapping::<D, L>(view, first, second) {
                    let law = laws.between(view.material_of(first), view.material_of(second));
                    if !ongoing::<D, L>(law, &kinematics, &memory) {
                        return;
                    }
                    let branch = view.position[first] - view.position[second];
                    visit(contact_of::<D, L>(
                        law,
                        &kinematics,
                        memory,
                        (first, Partner::Grain(second)),
                        branch,
                    ));
                }
            });
            for (near, &memory) in list.near_walls.iter().zip(&list.wall_memory) {
                let (first, wall) = (near.grain as usize, near.wall as usize);
                let met = if view.poses.is_empty() {
                    meet_wall::<D, L, false>(view, first, wall)
                } else {
                    meet_wall::<D, L, true>(view, first, wall)
                };
                let law = laws.between(view.material_of(first), view.walls[wall].material.0);
                if let Some((kinematics, _)) = met.filter(|(met, _)| ongoing::<D, L>(law, met, &memory)) {
                    let branch = kinematics.normal * (view.radius[first] - overlap_of::<D, L>(&kinematics));
                    visit(contact_of::<D, L>(law, &kinematics, memory, (first, Partner::Wall(wall)), branch));
                }
            }
            surfaces::visit(&self.facets[block], view, laws, visit);
        }
        self.visit_images(view, visit);
    }

    fn visit_listed(&self, view: &View<'_, D>, visit: &mut dyn FnMut(usize, usize, f64)) {
        for (block, list) in self.lists.iter().enumerate() {
            list.visit_pairs(self.blocks.range(block), |first, second, _| {
                visit(first, second, (view.position[first] - view.position[second]).length());
            });
        }
        let Some(cell) = view.cell else { return };
        for pair in self.images.iter().flat_map(|list| &list.pairs) {
            let (first, second) = (pair.first as usize, pair.second as usize);
            let branch = view.position[first] - view.position[second] - cell.offset(pair.shift);
            visit(first, second, branch.length());
        }
    }

    fn set_spring(&mut self, view: &View<'_, D>, first: usize, partner: Partner, spring: D::Spin) -> bool {
        match partner {
            Partner::Grain(second) => {
                self.set_spring_of_pair(view, first.max(second), first.min(second), spring)
            }
            Partner::Wall(wall) => self.set_spring_at_wall(view, first, wall, spring),
        }
    }

    fn pull(&self) -> [D::Vec; 3] {
        let mut pull = [D::Vec::ZERO; 3];
        for list in &self.images {
            pull.iter_mut().zip(&list.pull).for_each(|(sum, &of_block)| *sum += of_block);
        }
        pull
    }

    fn relocate(&mut self, moved: &Moved<'_>) {
        self.images.resize_with(self.blocks.count(), ImageList::default);
        let Self { lists, images, relocated, blocks, .. } = self;
        images::relocate(lists, images, *blocks, moved, relocated, L::reversed);
    }

    fn update(&mut self, materials: &Materials, tension: Tension) {
        let n = materials.len();
        self.laws = (0..n * n).map(|k| (self.between)(&materials.pair(k / n, k % n), tension)).collect();
    }

    fn save(&self, grains: &Grains<D>, walls: &[Wall<D>], to: &mut Section) {
        crate::lists::save(&self.lists, self.blocks, &grains.id, to);
        surfaces::save(&self.facets, walls, &grains.id, to);
        if !self.images.is_empty() {
            images::save(&self.images, &grains.id, to);
        }
    }

    fn restore(
        &mut self,
        from: &Section,
        grains: &Grains<D>,
        walls: &[Wall<D>],
    ) -> Result<(), SnapshotError> {
        let places = Places::of(&grains.id)?;
        crate::lists::restore(&mut self.lists, self.blocks, &places, from)?;
        surfaces::restore(&mut self.facets, walls, self.blocks, &places, from)?;
        if !self.images.is_empty() {
            images::restore(&mut self.images, self.blocks, &grains.id, from)?;
        }
        Ok(())
    }

    fn law_name(&self) -> &'static str {
        L::NAME
    }

    fn tangential(&self) -> bool {
        L::TANGENTIAL
    }

    fn predicts(&self) -> bool {
        self.laws.iter().any(L::predicts)
    }

    fn reach(&self) -> f64 {
        if L::REACHES { self.laws.iter().map(L::reach).fold(0.0, f64::max) } else { 0.0 }
    }

    fn limits(&self, a: usize, b: usize, effective_mass: f64) -> Option<LawLimits> {
        self.laws[a * self.materials + b].limits(effective_mass)
    }

    fn bytes(&self) -> (usize, usize) {
        let lists: usize = self.lists.iter().map(BlockList::bytes).sum();
        let facets: usize = self.facets.iter().map(FacetList::bytes).sum();
        let outgoing: usize = self.outgoing.iter().map(|o| o.capacity() * size_of::<Owed<D>>()).sum();
        let inbox: usize = self.inbox.iter().map(|i| i.capacity() * size_of::<Receipt>()).sum();
        let images: usize = self.images.iter().map(ImageList::bytes).sum();
        (lists + facets + outgoing + inbox + images, size_of::<L::Memory>())
    }
}

/// The contacts of a block between grains, compiled for wide registers too. Nothing is contracted:
/// the bits are the same.
#[multiversion(targets("x86_64+avx2"))]
fn pass<D: Dim, L: ContactLaw<D>, const LEDGER: bool>(
    kernel: &mut Kernel<'_, D, L, LEDGER>,
    list: &mut BlockList<L::Memory>,
    outgoing: &mut [Owed<D>],
) {
    kernel.pairs(list, outgoing);
}
