//! Contacts in batches: gathered one by one, loaded side by side, handed out one by one.
//!
//! The loop of [`load`] skips nothing and follows no index, so that the compiler computes several
//! contacts at once in wide registers, while laws stay scalar. Each contact is computed by itself, and
//! they are handed out in the order of the list: neither the width of registers nor where a batch
//! begins changes a bit.

use crate::kinematics::{Pair, push_of};
use crate::law::ContactLaw;
use crate::ledger::{Losses, Tally};
use crate::view::{Body, DEEPEST, View};
use granular_core::{Dim, Linear};
use multiversion::multiversion;

/// Places of a batch: enough that the loop is entered rarely, few enough for the nearest cache.
const BATCH: usize = 32;
/// The loop runs over whole registers; what the last one holds too much is not read.
const WIDTH: usize = 4;
const REGISTERS: usize = BATCH / WIDTH;

/// Contacts of one law share a register.
#[derive(Clone, Copy, Debug, Default)]
struct Register {
    law: usize,
    /// The next free place in the batch, and the first one behind the register.
    next: usize,
    end: usize,
}

/// Where the outcome of a contact goes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Address {
    /// The first grain, in memory.
    pub(crate) first: u32,
    /// The second grain.
    pub(crate) second: u32,
    /// The memory of the contact in the list of the block.
    pub(crate) memory: u32,
    /// What the second one gets, among all that the block owes; without meaning at home.
    pub(crate) owed: u32,
    /// The place in the batch.
    pub(crate) place: u32,
}

/// Near pairs.
pub(crate) struct Batch<D: Dim, L: ContactLaw<D>, const LEDGER: bool> {
    len: usize,
    /// In the order of the list.
    addresses: [Address; BATCH],
    registers: [Register; REGISTERS],
    used: usize,
    /// The register that was filled last.
    open: usize,
    /// Whether a register was left for another law before it was full.
    mixed: bool,
    gathered: Gathered<D>,
    pub(crate) memories: [L::Memory; BATCH],
    /// Share of the step during which the surfaces overlap; zero when they do not meet.
    pub(crate) presence: [f64; BATCH],
    /// Force on the first.
    pub(crate) force: [D::Vec; BATCH],
    /// Torques on the first and the second.
    pub(crate) torques: [[D::Spin; BATCH]; 2],
    /// Kept up when there is a ledger.
    losses: [[f64; BATCH]; 5],
}

/// What is read of pairs.
struct Gathered<D: Dim> {
    arm: [D::Vec; BATCH],
    distance_squared: [f64; BATCH],
    /// Of the first past the second.
    velocity: [D::Vec; BATCH],
    start_velocity: [D::Vec; BATCH],
    own_spin: [D::Spin; BATCH],
    other_spin: [D::Spin; BATCH],
    own_start_spin: [D::Spin; BATCH],
    other_start_spin: [D::Spin; BATCH],
    own_radius: [f64; BATCH],
    other_radius: [f64; BATCH],
    own_mass: [f64; BATCH],
    other_mass: [f64; BATCH],
}

impl<D: Dim, L: ContactLaw<D>, const LEDGER: bool> Batch<D, L, LEDGER> {
    pub(crate) fn new() -> Self {
        let (vectors, spins, numbers) = ([D::Vec::ZERO; BATCH], [D::Spin::ZERO; BATCH], [0.0; BATCH]);
        Self {
            len: 0,
            addresses: [Address::default(); BATCH],
            registers: [Register::default(); REGISTERS],
            used: 0,
            open: 0,
            mixed: false,
            gathered: Gathered {
                arm: vectors,
                distance_squared: numbers,
                velocity: vectors,
                start_velocity: vectors,
                own_spin: spins,
                other_spin: spins,
                own_start_spin: spins,
                other_start_spin: spins,
                own_radius: numbers,
                other_radius: numbers,
                own_mass: numbers,
                other_mass: numbers,
            },
            memories: [L::Memory::default(); BATCH],
            presence: numbers,
            force: vectors,
            torques: [spins; 2],
            losses: [[0.0; BATCH]; 5],
        }
    }

    /// The next place for a contact of this law; none when the batch is full.
    #[inline(always)]
    pub(crate) fn place(&mut self, law: usize) -> Option<usize> {
        let open = &self.registers[self.open % REGISTERS];
        if open.law != law || open.next == open.end {
            self.open(law)?;
        }
        let open = &mut self.registers[self.open % REGISTERS];
        open.next += 1;
        Some(open.next - 1)
    }

    /// Opens a register that was left for another law, or a new one; none when all are in use.
    fn open(&mut self, law: usize) -> Option<()> {
        self.mixed |= self.used > 0 && self.registers[self.open].law != law;
        let used = &self.registers[..if self.mixed { self.used } else { 0 }];
        let known = used.iter().position(|register| register.law == law && register.next < register.end);
        self.open = match known {
            Some(known) => known,
            None if self.used == REGISTERS => return None,
            None => {
                let next = self.used * WIDTH;
                self.registers[self.used] = Register { law, next, end: next + WIDTH };
                self.used += 1;
                self.used - 1
            }
        };
        Some(())
    }

    /// Notes a pair at this distance.
    #[inline(always)]
    pub(crate) fn note(&mut self, address: Address, (arm, distance_squared): (D::Vec, f64)) {
        let (k, place) = (self.len % BATCH, address.place as usize % BATCH);
        self.addresses[k] = address;
        self.gathered.arm[place] = arm;
        self.gathered.distance_squared[place] = distance_squared;
        self.len = k + 1;
    }

    /// Contacts in the order of the list.
    pub(crate) fn addresses(&self) -> impl Iterator<Item = Address> + '_ {
        self.addresses.iter().take(self.len).copied()
    }

    pub(crate) fn clear(&mut self) {
        (self.len, self.used, self.open, self.mixed) = (0, 0, 0, false);
        self.registers[0] = Register::default();
    }

    /// Gathers what is read of the pairs.
    #[inline(always)]
    pub(crate) fn gather(&mut self, view: &View<'_, D>, memory: &[L::Memory]) {
        let view = &view.cut::<L>();
        let to = &mut self.gathered;
        for address in self.addresses.iter().take(self.len) {
            let k = address.place as usize % BATCH;
            let (first, second) = (address.first as usize, address.second as usize);
            self.memories[k] = memory[address.memory as usize];
            to.velocity[k] = view.velocity[first] - view.velocity[second];
            (to.own_radius[k], to.other_radius[k]) = (view.radius[first], view.radius[second]);
            (to.own_mass[k], to.other_mass[k]) = (view.mass[first], view.mass[second]);
            if L::TANGENTIAL || LEDGER {
                to.start_velocity[k] = view.start_velocity[first] - view.start_velocity[second];
            }
            if L::TANGENTIAL {
                to.own_start_spin[k] = view.start_spin[first];
                to.other_start_spin[k] = view.start_spin[second];
                if view.predicts || L::TWISTING {
                    (to.own_spin[k], to.other_spin[k]) = (view.spin[first], view.spin[second]);
                }
            }
        }
    }

    /// Loads all contacts. Returns whether one is too deep.
    #[inline(always)]
    pub(crate) fn load(&mut self, view: &View<'_, D>, laws: &[L]) -> bool {
        let Self { registers, used, gathered, memories, presence, force, torques, losses, .. } = self;
        let mut deep = false;
        let mut from = 0;
        for run in registers[..*used].chunk_by(|a, b| a.law == b.law) {
            let places = (from, from + run.len() * WIDTH);
            let law = (view, &laws[run[0].law]);
            deep |= load::<D, L, LEDGER>(law, (gathered, places), memories, presence, force, torques, losses);
            from = places.1;
        }
        deep
    }

    /// Losses of a contact.
    #[inline(always)]
    pub(crate) fn losses(&self, k: usize) -> Losses {
        Losses::from_array([0, 1, 2, 3, 4].map(|kind: usize| self.losses[kind][k]))
    }

    /// The pair of a contact.
    #[inline(always)]
    pub(crate) fn pair(&self, k: usize) -> Pair<D> {
        self.gathered.pair(k)
    }
}

impl<D: Dim> Gathered<D> {
    #[inline(always)]
    fn pair(&self, k: usize) -> Pair<D> {
        let own = Body {
            velocity: self.velocity[k],
            start_velocity: self.start_velocity[k],
            spin: self.own_spin[k],
            start_spin: self.own_start_spin[k],
            radius: self.own_radius[k],
            mass: self.own_mass[k],
        };
        let other = Body {
            velocity: D::Vec::ZERO,
            start_velocity: D::Vec::ZERO,
            spin: self.other_spin[k],
            start_spin: self.other_start_spin[k],
            radius: self.other_radius[k],
            mass: self.other_mass[k],
        };
        Pair { own, other, arm: self.arm[k], distance_squared: self.distance_squared[k] }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn load<D: Dim, L: ContactLaw<D>, const LEDGER: bool>(
    (view, law): (&View<'_, D>, &L),
    (gathered, (from, to)): (&Gathered<D>, (usize, usize)),
    memories: &mut [L::Memory; BATCH],
    presence: &mut [f64; BATCH],
    force: &mut [D::Vec; BATCH],
    torques: &mut [[D::Spin; BATCH]; 2],
    losses: &mut [[f64; BATCH]; 5],
) -> bool {
    let mut deep = 0_u64;
    let to = to.min(BATCH);
    let mut k = from;
    while k < to {
        let pair = gathered.pair(k);
        let (kinematics, arms) = pair.meet::<L>(view);
        let mut tally = Tally::<LEDGER>::default();
        let mut memory = memories[k];
        let load = law.load(&kinematics, &mut memory, &mut tally);
        memories[k] = memory;
        let apart = L::REACHES && kinematics.presence == 0.0;
        let reached = apart && law.acts(kinematics.gap, &memory);
        presence[k] = if reached { 1.0 } else { kinematics.presence };
        force[k] = push_of::<D, L>(&load, kinematics.normal);
        if L::TANGENTIAL {
            torques[0][k] = load.rolling - load.tangential * arms.0;
            torques[1][k] = -load.rolling - load.tangential * arms.1;
        }
        if LEDGER {
            let [a, b, c, d, e] = tally.losses().to_array();
            (losses[0][k], losses[1][k], losses[2][k]) = (a, b, c);
            (losses[3][k], losses[4][k]) = (d, e);
        }
        let smaller = pair.own.radius.min(pair.other.radius);
        deep |= u64::from(pair.overlap() > DEEPEST * smaller);
        k += 1;
    }
    deep != 0
}

#[cfg(test)]
mod tests;
