//! The pass over the contacts of a block: who meets within the step, and the load between them.

use crate::batch::{Address, Batch};
use crate::law::ContactLaw;
use crate::ledger::Tally;
use crate::lists::BlockList;
use crate::view::{DEEPEST, Laws, View};
use granular_core::{Dim, Linear};

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

    /// Notes a contact that is too deep; the step then ends in an error.
    #[inline(always)]
    pub(crate) fn guard(&mut self, first: usize, overlap: f64, radius: f64) {
        if overlap > DEEPEST * radius {
            self.trouble.get_or_insert(Trouble { first: first as u32, overlap, radius });
        }
    }
}
