//! Contacts: who is near whom, what each contact remembers, and the loads.
//!
//! Grains are cut into blocks. A block owns the pairs of its grains with all earlier grains. It
//! adds the load to both grains when both are its own; what it owes to a grain of an earlier
//! block goes to `outgoing`, from where that block collects it in the order of its `inbox`.
//! Every grain thus sums its loads in an order that depends on the state alone.

use crate::grains::Grains;
use crate::law::{ContactLaw, Load, Meeting};
use crate::ledger::{Losses, Tally};
use crate::lists::BlockList;
use crate::material::{Materials, Tension};
use crate::wall::Wall;
use granular_core::search::CellGrid;
use granular_core::{Blocks, Dim, Linear, PerBlock, Section, SnapshotError};

/// What the kernels read: grains at one instant, with walls and step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a, D: Dim> {
    pub(crate) position: &'a [D::Vec],
    pub(crate) velocity: &'a [D::Vec],
    pub(crate) spin: &'a [D::Spin],
    pub(crate) radius: &'a [f64],
    pub(crate) mass: &'a [f64],
    pub(crate) material: &'a [u8],
    pub(crate) first_material: u8,
    pub(crate) walls: &'a [Wall<D>],
    /// The step \[s\]; zero between steps.
    pub(crate) dt: f64,
    /// The last step taken \[s\].
    pub(crate) last_dt: f64,
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
    fn push(&mut self, view: &View<'_, D>, ledger: bool, force: &mut [D::Vec], torque: &mut [D::Spin]);
    /// Adds what other blocks owe to the grains of `block`.
    fn collect(&self, block: usize, force: &mut [D::Vec], torque: &mut [D::Spin]);
    /// Losses of the last push, and a contact that was too deep.
    fn outcome(&self) -> (Losses, Option<Trouble>);
    /// Visits all contacts that overlap, in a fixed order.
    fn visit(&self, view: &View<'_, D>, visit: &mut dyn FnMut(Contact<D>));
    /// Visits all listed pairs of grains.
    fn visit_listed(&self, visit: &mut dyn FnMut(usize, usize));
    /// Takes changed materials.
    fn update(&mut self, materials: &Materials, tension: Tension);
    fn save(&self, grains: &Grains<D>, to: &mut Section);
    fn restore(&mut self, from: &Section, grains: &Grains<D>) -> Result<(), SnapshotError>;
    fn law_name(&self) -> &'static str;
    fn tangential(&self) -> bool;
    /// Bytes in lists, and bytes that one contact remembers.
    fn bytes(&self) -> (usize, usize);
}

/// What a block owes to a grain of an earlier block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Owed<D: Dim> {
    pub(crate) force: D::Vec,
    pub(crate) torque: D::Spin,
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
            PerBlock(&mut self.outgoing),
            PerBlock(&mut self.results),
            force,
            torque,
        );
        blocks.for_each(work, |block, (list, outgoing, result, force, torque)| {
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
            kernel.walls(&mut list.0[0]);
            result.0[0] = (kernel.tally.losses(), kernel.trouble);
        });
    }
}

/// Laws between materials.
#[derive(Clone, Copy)]
struct Laws<'a, L> {
    list: &'a [L],
    materials: usize,
}

impl<L> Laws<'_, L> {
    #[inline(always)]
    fn between(&self, a: u8, b: u8) -> &L {
        &self.list[a as usize * self.materials + b as usize]
    }
}

impl<D: Dim> View<'_, D> {
    #[inline(always)]
    fn material_of(&self, grain: usize) -> u8 {
        if self.material.is_empty() { self.first_material } else { self.material[grain] }
    }

    #[inline(always)]
    fn spin_of(&self, grain: usize) -> D::Spin {
        if self.spin.is_empty() { D::Spin::ZERO } else { self.spin[grain] }
    }
}

/// Two bodies before they are known to meet: what is needed of the second one.
struct Other<D: Dim> {
    velocity: D::Vec,
    spin: D::Spin,
    arm: f64,
    mass: f64,
    radius: f64,
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
struct Kernel<'a, D: Dim, L: ContactLaw<D>, const LEDGER: bool> {
    view: &'a View<'a, D>,
    laws: Laws<'a, L>,
    start: usize,
    force: &'a mut [D::Vec],
    torque: &'a mut [D::Spin],
    tally: Tally<LEDGER>,
    trouble: Option<Trouble>,
}

impl<D: Dim, L: ContactLaw<D>, const LEDGER: bool> Kernel<'_, D, L, LEDGER> {
    #[inline(always)]
    fn pairs(&mut self, list: &mut BlockList<L::Memory>, outgoing: &mut [Owed<D>]) {
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
                let sum = radius + view.radius[second];
                let reach = sum + view.margin;
                let squared = arm.length_squared();
                let met =
                    if squared < reach * reach { self.meet(first, second, arm, squared, sum) } else { None };
                let mut given = Owed::default();
                if let Some((meeting, arms)) = met {
                    let law = self.laws.between(view.material_of(first), view.material_of(second));
                    let load = law.load(&meeting, memory, &mut self.tally);
                    let on_first = push_of::<D, L>(&load, meeting.normal);
                    force += on_first;
                    given.force = -on_first;
                    if L::TANGENTIAL {
                        torque += load.rolling - load.tangential * arms.0;
                        given.torque = -load.rolling - load.tangential * arms.1;
                    }
                } else if *memory != L::Memory::default() {
                    let law = self.laws.between(view.material_of(first), view.material_of(second));
                    law.release(memory, &mut self.tally);
                    *memory = L::Memory::default();
                }
                if abroad {
                    outgoing[owed] = given;
                    owed += 1;
                } else if met.is_some() {
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

    /// The meeting of two grains and their lever arms, if they meet within the step.
    #[inline(always)]
    fn meet(
        &mut self,
        first: usize,
        second: usize,
        arm: D::Vec,
        squared: f64,
        sum: f64,
    ) -> Option<(Meeting<D>, (f64, f64))> {
        let view = self.view;
        let distance = squared.sqrt();
        let overlap = sum - distance;
        let other = Other {
            velocity: view.velocity[second],
            spin: if L::TANGENTIAL { view.spin_of(second) } else { D::Spin::ZERO },
            arm: view.radius[second] - view.arm_share * overlap,
            mass: view.mass[second],
            radius: view.radius[second],
        };
        let own_arm = view.radius[first] - view.arm_share * overlap;
        let normal = arm * (1.0 / distance);
        let mut meeting = meeting::<D, L>(view, first, own_arm, normal, overlap, &other)?;
        let mass = view.mass[first];
        meeting.effective_mass = mass * other.mass / (mass + other.mass);
        if L::TANGENTIAL {
            let radius = view.radius[first];
            meeting.effective_radius = radius * other.radius / (radius + other.radius);
        }
        let smaller = view.radius[first].min(other.radius);
        if overlap > DEEPEST * smaller {
            self.note(first, overlap, smaller);
        }
        Some((meeting, (own_arm, other.arm)))
    }

    #[inline(always)]
    fn walls(&mut self, list: &mut BlockList<L::Memory>) {
        let view = self.view;
        self.tally.at_walls();
        for (near, memory) in list.near_walls.iter().zip(&mut list.wall_memory) {
            let first = near.grain as usize;
            let wall = &view.walls[near.wall as usize];
            let law = self.laws.between(view.material_of(first), wall.material.0);
            let Some((meeting, arm)) = meet_wall::<D, L>(view, first, wall) else {
                law.release(memory, &mut self.tally);
                *memory = L::Memory::default();
                continue;
            };
            let load = law.load(&meeting, memory, &mut self.tally);
            let local = first - self.start;
            self.force[local] += push_of::<D, L>(&load, meeting.normal);
            if L::TANGENTIAL {
                self.torque[local] += load.rolling - load.tangential * arm;
            }
            let radius = view.radius[first];
            if meeting.overlap > DEEPEST * radius {
                self.note(first, meeting.overlap, radius);
            }
        }
    }

    #[cold]
    fn note(&mut self, first: usize, overlap: f64, radius: f64) {
        self.trouble.get_or_insert(Trouble { first: first as u32, overlap, radius });
    }
}

/// Force vector of a load.
#[inline(always)]
fn push_of<D: Dim, L: ContactLaw<D>>(load: &Load<D>, normal: D::Vec) -> D::Vec {
    let along = normal * load.normal;
    if L::TANGENTIAL { along + D::turn(load.tangential, normal) } else { along }
}

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
        twist: 0.0,
        effective_mass: 0.0,
        effective_radius: 0.0,
        dt: view.dt,
    };
    if L::TANGENTIAL {
        let spin = view.spin_of(first);
        let surface = D::tangential(spin * own_arm + other.spin * other.arm, normal);
        meeting.slip = D::cross(normal, relative) - surface;
        meeting.roll = D::tangential(spin - other.spin, normal);
        meeting.twist = 0.5 * D::twist(spin + other.spin, normal);
    }
    Some(meeting)
}

/// The meeting of a grain and a wall, and the lever arm.
#[inline(always)]
fn meet_wall<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    wall: &Wall<D>,
) -> Option<(Meeting<D>, f64)> {
    let radius = view.radius[first];
    let (distance, normal) = wall.shape.distance(view.position[first]);
    let overlap = radius - distance;
    let still =
        Other { velocity: D::Vec::ZERO, spin: D::Spin::ZERO, arm: 0.0, mass: f64::INFINITY, radius: 0.0 };
    // A wall does not give way: the contact lies on its surface.
    let arm = radius - 2.0 * view.arm_share * overlap;
    let mut meeting = meeting::<D, L>(view, first, arm, normal, overlap, &still)?;
    meeting.effective_mass = view.mass[first];
    meeting.effective_radius = radius;
    Some((meeting, arm))
}

impl<D: Dim, L: ContactLaw<D>> Pairs<D> for Contacts<D, L> {
    fn list(&mut self, view: &View<'_, D>, skin: f64, order: Option<&[u32]>) {
        let largest = view.radius.iter().fold(0.0, |a: f64, &b| a.max(b));
        self.grid.fill(view.position, 2.0 * largest + skin);
        if let Some(order) = order {
            crate::lists::reorder(&mut self.lists, self.blocks, order, L::reversed);
        }
        let (grid, blocks) = (&self.grid, self.blocks);
        blocks.for_each(PerBlock(&mut self.lists), |block, list| {
            list.0[0].build(view, grid, blocks.range(block), skin);
        });
        for (block, (list, outgoing)) in self.lists.iter().zip(&mut self.outgoing).enumerate() {
            let owed = list.partners.iter().filter(|&&p| (p as usize) < blocks.range(block).start).count();
            outgoing.clear();
            outgoing.resize(owed, Owed::default());
        }
        crate::lists::fill_inboxes(&self.lists, blocks, &mut self.inbox);
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
                if let Some((meeting, material)) = overlapping::<D, L>(view, first, second) {
                    let law = laws.between(view.material_of(first), material);
                    let place = (first, Partner::Grain(second));
                    visit(contact_of::<D, L>(law, &meeting, memory, place, view.last_dt));
                }
            });
            for (near, &memory) in list.near_walls.iter().zip(&list.wall_memory) {
                let (first, wall) = (near.grain as usize, near.wall as usize);
                let met = meet_wall::<D, L>(view, first, &view.walls[wall]);
                if let Some((meeting, _)) = met.filter(|(meeting, _)| meeting.overlap > 0.0) {
                    let law = laws.between(view.material_of(first), view.walls[wall].material.0);
                    let place = (first, Partner::Wall(wall));
                    visit(contact_of::<D, L>(law, &meeting, memory, place, view.last_dt));
                }
            }
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

    fn save(&self, grains: &Grains<D>, to: &mut Section) {
        crate::lists::save(&self.lists, self.blocks, &grains.id, to);
    }

    fn restore(&mut self, from: &Section, grains: &Grains<D>) -> Result<(), SnapshotError> {
        crate::lists::restore(&mut self.lists, self.blocks, &grains.id, from)
    }

    fn law_name(&self) -> &'static str {
        L::NAME
    }

    fn tangential(&self) -> bool {
        L::TANGENTIAL
    }

    fn bytes(&self) -> (usize, usize) {
        let lists: usize = self.lists.iter().map(BlockList::bytes).sum();
        let outgoing: usize = self.outgoing.iter().map(|o| o.capacity() * size_of::<Owed<D>>()).sum();
        let inbox: usize = self.inbox.iter().map(|i| i.capacity() * size_of::<Receipt>()).sum();
        (lists + outgoing + inbox, size_of::<L::Memory>())
    }
}

/// The meeting of two grains that overlap now, and the material of the second.
fn overlapping<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    first: usize,
    second: usize,
) -> Option<(Meeting<D>, u8)> {
    let arm = view.position[first] - view.position[second];
    let distance = arm.length();
    let overlap = view.radius[first] + view.radius[second] - distance;
    if overlap <= 0.0 || distance == 0.0 {
        return None;
    }
    let other = Other {
        velocity: view.velocity[second],
        spin: view.spin_of(second),
        arm: view.radius[second] - view.arm_share * overlap,
        mass: view.mass[second],
        radius: view.radius[second],
    };
    let own_arm = view.radius[first] - view.arm_share * overlap;
    let mut meeting = meeting::<D, L>(view, first, own_arm, arm * (1.0 / distance), overlap, &other)?;
    meeting.effective_mass = view.mass[first] * other.mass / (view.mass[first] + other.mass);
    meeting.effective_radius = view.radius[first] * other.radius / (view.radius[first] + other.radius);
    Some((meeting, view.material_of(second)))
}

fn contact_of<D: Dim, L: ContactLaw<D>>(
    law: &L,
    meeting: &Meeting<D>,
    memory: L::Memory,
    (first, partner): (usize, Partner),
    last_dt: f64,
) -> Contact<D> {
    let meeting = Meeting { dt: last_dt, ..*meeting };
    let (load, energy) = law.at_rest(&meeting, memory);
    Contact {
        first,
        partner,
        normal: meeting.normal,
        overlap: meeting.overlap,
        normal_force: load.normal,
        force: push_of::<D, L>(&load, meeting.normal),
        energy,
    }
}
