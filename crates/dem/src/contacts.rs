//! Contacts: who is near whom, what each contact remembers, and the loads.
//!
//! Grains are cut into blocks. A block owns the pairs of its grains with all earlier grains. It
//! adds the load to both grains when both are its own; what it owes to a grain of an earlier
//! block goes to `outgoing`, from where that block collects it in the order of its `inbox`.
//! Every grain thus sums its loads in an order that depends on the state alone.

use crate::facet_lists::{self, FacetList};
use crate::grains::Grains;
use crate::kernel::{Kernel, Laws, Owed, Trouble, View, contact_of, meet_wall, overlapping};
use crate::law::ContactLaw;
use crate::ledger::{Losses, Tally};
use crate::lists::{BlockList, Places};
use crate::material::{Materials, Tension};
use crate::moving::Reaction;
use crate::wall::Wall;
use granular_core::search::CellGrid;
use granular_core::{Blocks, Dim, PerBlock, Section, SnapshotError};

/// A contact between steps, for output.
#[derive(Clone, Copy, Debug)]
pub struct Contact<D: Dim> {
    /// Index of the first grain in memory.
    pub first: usize,
    /// The second body.
    pub partner: Partner,
    /// Unit vector from the second body to the first.
    pub normal: D::Vec,
    /// Overlap \[m\].
    pub overlap: f64,
    /// Force along the normal \[N\].
    pub normal_force: f64,
    /// Force on the first body \[N\].
    pub force: D::Vec,
    /// Energy stored in the springs \[J\].
    pub energy: f64,
}

/// The second body of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// A grain, by its index in memory.
    Grain(usize),
    /// A wall, by its index.
    Wall(usize),
}

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
    /// Visits all listed pairs of grains.
    fn visit_listed(&self, visit: &mut dyn FnMut(usize, usize));
    /// Takes changed materials.
    fn update(&mut self, materials: &Materials, tension: Tension);
    fn save(&self, grains: &Grains<D>, walls: &[Wall<D>], to: &mut Section);
    fn restore(&mut self, from: &Section, grains: &Grains<D>, walls: &[Wall<D>])
    -> Result<(), SnapshotError>;
    fn law_name(&self) -> &'static str;
    fn tangential(&self) -> bool;
    /// Bytes in lists, and bytes that one contact remembers.
    fn bytes(&self) -> (usize, usize);
}

/// Where to collect: grain within the block, owing block, and place there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receipt {
    pub(crate) grain: u32,
    pub(crate) block: u32,
    pub(crate) place: u32,
}

pub(crate) struct Contacts<D: Dim, L: ContactLaw<D>> {
    /// By material of the first times `materials` plus material of the second.
    laws: Vec<L>,
    materials: usize,
    blocks: Blocks,
    lists: Vec<BlockList<L::Memory>>,
    facets: Vec<FacetList<D, L::Memory>>,
    /// Push on each wall by the grains of each block; empty when no wall moves.
    reactions: Vec<Vec<Reaction<D>>>,
    outgoing: Vec<Vec<Owed<D>>>,
    inbox: Vec<Vec<Receipt>>,
    grid: CellGrid<D>,
    results: Vec<(Losses, Option<Trouble>)>,
}

impl<D: Dim, L: ContactLaw<D>> Contacts<D, L> {
    pub(crate) fn new(materials: &Materials, tension: Tension, blocks: Blocks) -> Self {
        let count = blocks.count();
        let mut contacts = Self {
            laws: Vec::new(),
            materials: materials.len(),
            blocks,
            lists: (0..count).map(|_| BlockList::default()).collect(),
            facets: (0..count).map(|_| FacetList::default()).collect(),
            reactions: vec![Vec::new(); count],
            outgoing: vec![Vec::new(); count],
            inbox: vec![Vec::new(); count],
            grid: CellGrid::default(),
            results: vec![(Losses::default(), None); count],
        };
        Pairs::<D>::update(&mut contacts, materials, tension);
        contacts
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
            force,
            torque,
        );
        let moving = !view.poses.is_empty();
        blocks.for_each(work, |block, (list, (facets, reactions), outgoing, result, force, torque)| {
            let mut kernel = Kernel::<D, L, LEDGER> {
                view,
                laws,
                start: blocks.range(block).start,
                force,
                torque,
                tally: Tally::default(),
                trouble: None,
            };
            kernel.pairs(&mut list.0[0], &mut outgoing.0[0]);
            let reactions = &mut reactions.0[0];
            if moving {
                reactions.fill(Reaction::default());
                kernel.walls::<true>(&mut list.0[0], reactions);
            } else {
                kernel.walls::<false>(&mut list.0[0], reactions);
            }
            kernel.facets(&mut facets.0[0], reactions);
            result.0[0] = (kernel.tally.losses(), kernel.trouble);
        });
    }
}

impl<D: Dim, L: ContactLaw<D>> Pairs<D> for Contacts<D, L> {
    fn list(&mut self, view: &View<'_, D>, skin: f64, order: Option<&[u32]>) {
        let largest = view.radius.iter().fold(0.0, |a: f64, &b| a.max(b));
        self.grid.fill(view.position, 2.0 * largest + skin);
        if let Some(order) = order {
            self.regroup(view.walls, self.blocks, &crate::lists::places(order));
        }
        let (grid, blocks) = (&self.grid, self.blocks);
        blocks.for_each(PerBlock(&mut self.lists), |block, list| {
            list.0[0].build(view, grid, blocks.range(block), skin);
        });
        self.reactions.iter_mut().for_each(|of_block| of_block.resize(view.poses.len(), Reaction::default()));
        if facet_lists::needed(view.walls) {
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
    }

    fn regroup(&mut self, walls: &[Wall<D>], blocks: Blocks, place: &[u32]) {
        crate::lists::regroup(&mut self.lists, (self.blocks, blocks), place, L::reversed);
        facet_lists::regroup(&mut self.facets, walls, blocks, place);
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
                if let Some(meeting) = overlapping::<D, L>(view, first, second) {
                    let law = laws.between(view.material_of(first), view.material_of(second));
                    visit(contact_of::<D, L>(law, &meeting, memory, first, Partner::Grain(second)));
                }
            });
            for (near, &memory) in list.near_walls.iter().zip(&list.wall_memory) {
                let (first, wall) = (near.grain as usize, near.wall as usize);
                let met = if view.poses.is_empty() {
                    meet_wall::<D, L, false>(view, first, wall)
                } else {
                    meet_wall::<D, L, true>(view, first, wall)
                };
                if let Some((meeting, _)) = met.filter(|(meeting, _)| meeting.overlap > 0.0) {
                    let law = laws.between(view.material_of(first), view.walls[wall].material.0);
                    visit(contact_of::<D, L>(law, &meeting, memory, first, Partner::Wall(wall)));
                }
            }
            facet_lists::visit(&self.facets[block], view, laws, visit);
        }
    }

    fn visit_listed(&self, visit: &mut dyn FnMut(usize, usize)) {
        for (block, list) in self.lists.iter().enumerate() {
            list.visit_pairs(self.blocks.range(block), |first, second, _| visit(first, second));
        }
    }

    fn update(&mut self, materials: &Materials, tension: Tension) {
        let n = materials.len();
        self.laws = (0..n * n).map(|k| L::between(&materials.pair(k / n, k % n), tension)).collect();
    }

    fn save(&self, grains: &Grains<D>, walls: &[Wall<D>], to: &mut Section) {
        crate::lists::save(&self.lists, self.blocks, &grains.id, to);
        facet_lists::save(&self.facets, walls, &grains.id, to);
    }

    fn restore(
        &mut self,
        from: &Section,
        grains: &Grains<D>,
        walls: &[Wall<D>],
    ) -> Result<(), SnapshotError> {
        let places = Places::of(&grains.id)?;
        crate::lists::restore(&mut self.lists, self.blocks, &places, from)?;
        facet_lists::restore(&mut self.facets, walls, self.blocks, &places, from)
    }

    fn law_name(&self) -> &'static str {
        L::NAME
    }

    fn tangential(&self) -> bool {
        L::TANGENTIAL
    }

    fn bytes(&self) -> (usize, usize) {
        let lists: usize = self.lists.iter().map(BlockList::bytes).sum();
        let facets: usize = self.facets.iter().map(FacetList::bytes).sum();
        let outgoing: usize = self.outgoing.iter().map(|o| o.capacity() * size_of::<Owed<D>>()).sum();
        let inbox: usize = self.inbox.iter().map(|i| i.capacity() * size_of::<Receipt>()).sum();
        (lists + facets + outgoing + inbox, size_of::<L::Memory>())
    }
}
