//! Contacts across the faces of a periodic cell: lists, memories and loads, apart from those of
//! ordinary pairs, so that a scene without a cell has none of it.

use super::{PeriodicCell, Shift};
use crate::kinematics::{Pair, push_of};
use crate::law::ContactLaw;
use crate::lists::{BlockList, Receipt, spare};
use crate::pass::{Kernel, Owed};
use crate::view::View;
use granular_core::search::Neighbours;
use granular_core::{Blocks, Dim, Linear, Section, SnapshotError, Stored, Vector};
use std::ops::Range;

/// A grain and an image of an earlier one, which is `shift` edges away from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ImagePair {
    pub(crate) first: u32,
    pub(crate) second: u32,
    pub(crate) shift: Shift,
}

/// The pairs of the grains of one block with images of earlier grains.
#[derive(Clone, Debug)]
pub(crate) struct ImageList<D: Dim, M> {
    /// In rising order.
    pub(crate) pairs: Vec<ImagePair>,
    pub(crate) memory: Vec<M>,
    /// For each axis, the sum of forces on first grains times the shift along it \[N\].
    pub(crate) pull: [D::Vec; 3],
    /// Loads owed to grains of earlier blocks; they come after those of ordinary pairs.
    pub(crate) owed: usize,
    live: Vec<(ImagePair, M)>,
}

impl<D: Dim, M> Default for ImageList<D, M> {
    fn default() -> Self {
        Self { pairs: Vec::new(), memory: Vec::new(), pull: [D::Vec::ZERO; 3], owed: 0, live: Vec::new() }
    }
}

/// Where grains are within a cell, as shares of its edges.
pub(crate) struct Bounds<D: Dim> {
    shares: super::Matrix<D>,
    low: [f64; 3],
    high: [f64; 3],
    widths: [f64; 3],
}

impl<D: Dim> Bounds<D> {
    pub(crate) fn of(cell: &PeriodicCell<D>, positions: &[D::Vec]) -> Self {
        let shares = cell.edges.inverse();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &position in positions {
            let share = shares.apply(position);
            for axis in 0..D::N {
                low[axis] = low[axis].min(share.component(axis));
                high[axis] = high[axis].max(share.component(axis));
            }
        }
        Self { shares, low, high, widths: cell.widths() }
    }

    /// Whether anything can be within `reach` \[m\] of the image of `position` under the opposite of `shift`.
    fn near(&self, cell: &PeriodicCell<D>, position: D::Vec, shift: Shift, reach: f64) -> bool {
        let share = self.shares.apply(position);
        (0..D::N).filter(|&axis| cell.periodic[axis]).all(|axis| {
            let place = share.component(axis) - f64::from(shift[axis]);
            let margin = reach / self.widths[axis];
            place > self.low[axis] - margin && place < self.high[axis] + margin
        })
    }
}

/// What a search for images needs.
#[derive(Clone, Copy)]
pub(crate) struct Near<'a, D: Dim, S> {
    pub(crate) view: &'a View<'a, D>,
    pub(crate) cell: &'a PeriodicCell<D>,
    pub(crate) search: &'a S,
    pub(crate) bounds: &'a Bounds<D>,
    pub(crate) skin: f64,
    /// Largest radius \[m\].
    pub(crate) largest: f64,
}

impl<D: Dim, M: Copy + Default + PartialEq> ImageList<D, M> {
    /// Lists the pairs of the grains in `range`; memories that are not fresh move along.
    pub(crate) fn build(&mut self, near: &Near<'_, D, impl Neighbours<D>>, range: Range<usize>) {
        let Near { view, cell, search, bounds, skin, largest } = *near;
        self.harvest();
        // Room for what a compact block can have across faces, so that steps do not allocate.
        self.pairs.reserve(range.len());
        self.memory.clear();
        self.memory.reserve(range.len());
        self.live.reserve(range.len().saturating_sub(self.live.len()));
        for first in range {
            let (position, radius) = (view.position[first], view.radius[first]);
            for shift in cell.shifts() {
                if !bounds.near(cell, position, shift, radius + largest + skin) {
                    continue;
                }
                let seen_from = position - cell.offset(shift);
                search.visit_near(seen_from, radius, |second| {
                    let reach = radius + view.radius[second as usize] + skin;
                    let arm = seen_from - view.position[second as usize];
                    if (second as usize) < first && arm.length_squared() < reach * reach {
                        self.pairs.push(ImagePair { first: first as u32, second, shift });
                    }
                });
            }
        }
        self.pairs.sort_unstable();
        self.memory.resize(self.pairs.len(), M::default());
        for (pair, memory) in self.live.drain(..) {
            if let Ok(place) = self.pairs.binary_search(&pair) {
                self.memory[place] = memory;
            }
        }
    }

    /// Takes the memories that are not fresh out of the list.
    fn harvest(&mut self) {
        let remembered = self.pairs.iter().zip(&self.memory).filter(|(_, memory)| **memory != M::default());
        self.live.extend(remembered.map(|(pair, memory)| (*pair, *memory)));
        self.pairs.clear();
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<ImagePair>() * self.pairs.capacity() + size_of::<M>() * self.memory.capacity()
    }
}

/// What becomes of pairs when grains are put elsewhere.
pub(crate) enum Moved<'a> {
    /// Edges were recombined so that a shift `n` became `recombined` applied to `n`; then each grain
    /// was put back by so many edges.
    Inside { recombined: [[i8; 3]; 3], wraps: &'a [Shift] },
    /// Each grain has a new place in memory.
    Sorted { places: &'a [u32] },
}

impl Moved<'_> {
    /// The pair after the move, and whether its grains changed roles.
    fn pair(&self, pair: ImagePair) -> (ImagePair, bool) {
        let ImagePair { first, second, shift } = pair;
        match self {
            Self::Inside { recombined, wraps } => {
                let (own, other) = (wraps[first as usize], wraps[second as usize]);
                let shift = std::array::from_fn(|axis| {
                    let mixed: i8 = (0..3).map(|k| recombined[axis][k] * shift[k]).sum();
                    mixed - own[axis] + other[axis]
                });
                (ImagePair { shift, ..pair }, false)
            }
            Self::Sorted { places } => {
                let (a, b) = (places[first as usize], places[second as usize]);
                if a > b {
                    (ImagePair { first: a, second: b, shift }, false)
                } else {
                    (ImagePair { first: b, second: a, shift: shift.map(|n| -n) }, true)
                }
            }
        }
    }
}

/// Moves memories to where pairs belong after grains were put elsewhere; lists are to be built next.
/// Ordinary pairs take part in [`Moved::Inside`] only: for the other there is [`crate::lists::reorder`].
pub(crate) fn relocate<D: Dim, M: Copy + Default + PartialEq>(
    lists: &mut [BlockList<M>],
    images: &mut [ImageList<D, M>],
    blocks: Blocks,
    moved: &Moved<'_>,
    scratch: &mut Vec<(ImagePair, M)>,
    reversed: impl Fn(M) -> M,
) {
    scratch.clear();
    for list in images.iter_mut() {
        list.harvest();
        scratch.append(&mut list.live);
    }
    if matches!(moved, Moved::Inside { .. }) {
        for (block, list) in lists.iter_mut().enumerate() {
            list.harvest_pairs(blocks.range(block).start, |first, second, memory| {
                scratch.push((ImagePair { first, second, shift: [0; 3] }, memory));
            });
        }
    }
    spare(scratch, 0);
    for &(pair, memory) in scratch.iter() {
        let (pair, swapped) = moved.pair(pair);
        let memory = if swapped { reversed(memory) } else { memory };
        let block = pair.first as usize / blocks.size();
        if pair.shift == [0; 3] {
            lists[block].remember(pair.first, pair.second, memory);
        } else {
            images[block].live.push((pair, memory));
        }
    }
}

/// Tells every block where it is owed loads of images, besides those of ordinary pairs.
pub(crate) fn fill_inboxes<D: Dim, M>(
    images: &[ImageList<D, M>],
    outgoing: &[Vec<Owed<D>>],
    blocks: Blocks,
    inboxes: &mut [Vec<Receipt>],
) {
    for (block, (list, outgoing)) in images.iter().zip(outgoing).enumerate() {
        let start = blocks.range(block).start as u32;
        let from = outgoing.len() - list.owed;
        for (place, pair) in list.pairs.iter().filter(|pair| pair.second < start).enumerate() {
            let receiver = pair.second as usize / blocks.size();
            let grain = pair.second - blocks.range(receiver).start as u32;
            inboxes[receiver].push(Receipt { grain, block: block as u32, place: (from + place) as u32 });
        }
    }
    for inbox in inboxes {
        spare(inbox, blocks.size());
        inbox.sort_unstable_by_key(Receipt::order);
    }
}

/// Saves the memories that are not fresh, by the stable identifiers of the grains.
pub(crate) fn save<D: Dim, M: Copy + Default + PartialEq + Stored>(
    images: &[ImageList<D, M>],
    ids: &[u32],
    to: &mut Section,
) {
    let (mut pairs, mut shifts, mut memories) = (Vec::new(), Vec::new(), Vec::new());
    for list in images {
        for (pair, memory) in list.pairs.iter().zip(&list.memory) {
            if *memory != M::default() {
                pairs.push([ids[pair.first as usize], ids[pair.second as usize]]);
                shifts.push(pair.shift.map(|n| (n + 1) as u8));
                memories.push(*memory);
            }
        }
    }
    to.put("image contacts", &pairs);
    to.put("image contact shifts", &shifts);
    to.put("image contact memories", &memories);
}

/// Restores memories; they enter the lists at the next build.
pub(crate) fn restore<D: Dim, M: Copy + Default + PartialEq + Stored>(
    images: &mut [ImageList<D, M>],
    blocks: Blocks,
    ids: &[u32],
    from: &Section,
) -> Result<(), SnapshotError> {
    let mut place = vec![u32::MAX; ids.len()];
    for (index, &id) in ids.iter().enumerate() {
        if let Some(slot) = place.get_mut(id as usize) {
            *slot = index as u32;
        }
    }
    let damaged = |found: String| SnapshotError::Damaged { place: "solver/image contacts".to_owned(), found };
    let find = |id: u32| {
        let found = place.get(id as usize).copied().filter(|&index| index != u32::MAX);
        found.ok_or_else(|| damaged(format!("grain {id} does not exist")))
    };
    images.iter_mut().for_each(|list| *list = ImageList::default());
    let pairs: Vec<[u32; 2]> = from.array("image contacts")?;
    let shifts: Vec<[u8; 3]> = from.array_of("image contact shifts", pairs.len())?;
    let memories: Vec<M> = from.array_of("image contact memories", pairs.len())?;
    for ((&[first, second], &shift), &memory) in pairs.iter().zip(&shifts).zip(&memories) {
        let (first, second) = (find(first)?, find(second)?);
        if second >= first || shift.iter().any(|&n| n > 2) {
            return Err(damaged(format!("grains {first} and {second} shifted by {shift:?}")));
        }
        let pair = ImagePair { first, second, shift: shift.map(|n| n as i8 - 1) };
        images[first as usize / blocks.size()].live.push((pair, memory));
    }
    Ok(())
}

impl<D: Dim, L: ContactLaw<D>, const LEDGER: bool> Kernel<'_, D, L, LEDGER> {
    /// The contacts of a block across faces of the cell; `owed` counts what its ordinary pairs owe.
    pub(crate) fn images(
        &mut self,
        cell: &PeriodicCell<D>,
        list: &mut ImageList<D, L::Memory>,
        outgoing: &mut [Owed<D>],
    ) {
        let view = self.view;
        let mut owed = 0;
        list.pull = [D::Vec::ZERO; 3];
        for (pair, memory) in list.pairs.iter().zip(&mut list.memory) {
            let (first, second) = (pair.first as usize, pair.second as usize);
            let met = meet_image::<D, L>(view, cell, pair, view.margin);
            let laws = self.laws;
            let law = laws.between(view.material_of(first), view.material_of(second));
            let mut given = Owed::default();
            let met = met.and_then(|(kinematics, arms, overlap)| {
                let load = law.load(&kinematics, memory, &mut self.tally);
                let apart = L::REACHES && kinematics.presence == 0.0;
                let ended = apart && !law.acts(kinematics.gap, memory);
                (!ended).then_some((kinematics, arms, overlap, load))
            });
            if let Some((kinematics, arms, overlap, load)) = met {
                self.guard(first, overlap, view.radius[first].min(view.radius[second]));
                let on_first = push_of::<D, L>(&load, kinematics.normal);
                for axis in 0..D::N {
                    list.pull[axis] += on_first * f64::from(pair.shift[axis]);
                }
                let local = first - self.start;
                self.force[local] += on_first;
                given.force = -on_first;
                if L::TANGENTIAL {
                    self.torque[local] += load.rolling - load.tangential * arms.0;
                    given.torque = -load.rolling - load.tangential * arms.1;
                }
            } else if *memory != L::Memory::default() {
                law.release(memory, &mut self.tally);
                *memory = L::Memory::default();
            }
            if second < self.start {
                outgoing[owed] = given;
                owed += 1;
            } else if met.is_some() {
                self.force[second - self.start] += given.force;
                if L::TANGENTIAL {
                    self.torque[second - self.start] += given.torque;
                }
            }
        }
    }
}

type MetImage<D> = (crate::law::Kinematics<D>, (f64, f64), f64);

/// The kinematics of a grain and an image with surfaces nearer than `margin`, their lever arms and the overlap.
#[inline(always)]
pub(crate) fn meet_image<D: Dim, L: ContactLaw<D>>(
    view: &View<'_, D>,
    cell: &PeriodicCell<D>,
    pair: &ImagePair,
    margin: f64,
) -> Option<MetImage<D>> {
    let (first, second) = (pair.first as usize, pair.second as usize);
    let arm = view.position[first] - view.position[second] - cell.offset(pair.shift);
    let sum = view.radius[first] + view.radius[second];
    let (squared, reach) = (arm.length_squared(), sum + margin);
    // At a distance of zero there is no normal; as for ordinary pairs the guard stops the run before.
    if squared >= reach * reach {
        return None;
    }
    let (mut rate, mut start_rate) = (D::Vec::ZERO, D::Vec::ZERO);
    for axis in 0..D::N {
        rate += cell.edge_rate.columns[axis] * f64::from(pair.shift[axis]);
        start_rate += cell.start_rate.columns[axis] * f64::from(pair.shift[axis]);
    }
    let mut other = view.body::<L>(second);
    other.velocity += rate;
    other.start_velocity += start_rate;
    let pair = Pair { own: view.body::<L>(first), other, arm, distance_squared: squared };
    let (kinematics, arms) = pair.meet::<L>(view);
    let reached = L::REACHES && kinematics.gap < view.law_reach;
    (kinematics.presence != 0.0 || reached).then(|| (kinematics, arms, pair.overlap()))
}
