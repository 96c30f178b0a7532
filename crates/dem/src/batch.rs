//! Contacts in batches: gathered one by one, loaded side by side, handed out one by one.
//!
//! The loop of [`load`] skips nothing and follows no index, so that the compiler computes several
//! contacts at once in wide registers, while laws stay scalar. Each contact is computed by itself, and
//! they are handed out in the order of the list: neither the width of registers nor where a batch
//! begins changes a bit.

use crate::kernel::{Body, DEEPEST, Pair, View, push_of};
use crate::law::ContactLaw;
use crate::ledger::{Losses, Tally};
use granular_core::{Dim, Linear};
use multiversion::multiversion;

/// Contacts of a batch: enough that the loop is entered rarely, few enough for the nearest cache.
const BATCH: usize = 16;
/// The loop runs over whole registers; what the last one holds too much is not read.
const WIDTH: usize = 4;

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
}

/// Near pairs under one law.
pub(crate) struct Batch<D: Dim, L: ContactLaw<D>, const LEDGER: bool> {
    pub(crate) len: usize,
    pub(crate) addresses: [Address; BATCH],
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

    pub(crate) fn is_full(&self) -> bool {
        self.len == BATCH
    }

    /// Notes a pair at this distance.
    #[inline(always)]
    pub(crate) fn note(&mut self, address: Address, (arm, distance_squared): (D::Vec, f64)) {
        let k = self.len % BATCH;
        self.addresses[k] = address;
        self.gathered.arm[k] = arm;
        self.gathered.distance_squared[k] = distance_squared;
        self.len = k + 1;
    }

    /// Gathers what is read of the pairs.
    #[inline(always)]
    pub(crate) fn gather(&mut self, view: &View<'_, D>, memory: &[L::Memory]) {
        let view = &view.cut::<L>();
        let to = &mut self.gathered;
        for (k, address) in self.addresses.iter().enumerate().take(self.len) {
            let (first, second) = (address.first as usize, address.second as usize);
            let (own, other) = (view.body::<L>(first), view.body::<L>(second));
            self.memories[k] = memory[address.memory as usize];
            to.velocity[k] = own.velocity - other.velocity;
            (to.own_radius[k], to.other_radius[k]) = (own.radius, other.radius);
            (to.own_mass[k], to.other_mass[k]) = (own.mass, other.mass);
            if L::TANGENTIAL {
                to.start_velocity[k] = own.start_velocity - other.start_velocity;
                (to.own_start_spin[k], to.other_start_spin[k]) = (own.start_spin, other.start_spin);
                if view.predicts || L::TWISTING {
                    (to.own_spin[k], to.other_spin[k]) = (own.spin, other.spin);
                }
            }
        }
    }

    /// Loads all contacts. Returns whether one is too deep.
    #[inline(always)]
    pub(crate) fn load(&mut self, view: &View<'_, D>, law: &L) -> bool {
        let Self { len, gathered, memories, presence, force, torques, losses, .. } = self;
        let count = ((*len + WIDTH - 1) & !(WIDTH - 1)).min(BATCH);
        load::<D, L, LEDGER>((view, law), (gathered, count), memories, presence, force, torques, losses)
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

#[multiversion(targets("x86_64+avx2"))]
fn load<D: Dim, L: ContactLaw<D>, const LEDGER: bool>(
    (view, law): (&View<'_, D>, &L),
    (gathered, count): (&Gathered<D>, usize),
    memories: &mut [L::Memory; BATCH],
    presence: &mut [f64; BATCH],
    force: &mut [D::Vec; BATCH],
    torques: &mut [[D::Spin; BATCH]; 2],
    losses: &mut [[f64; BATCH]; 5],
) -> bool {
    let mut deep = 0_u64;
    let count = count.min(BATCH);
    let mut k = 0;
    while k < count {
        let pair = gathered.pair(k);
        let (meeting, arms) = pair.meet::<L>(view);
        let mut tally = Tally::<LEDGER>::default();
        let mut memory = memories[k];
        let load = law.load(&meeting, &mut memory, &mut tally);
        memories[k] = memory;
        presence[k] = meeting.presence;
        force[k] = push_of::<D, L>(&load, meeting.normal);
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
mod tests {
    use super::*;
    use crate::law::{HertzMindlin, LinearFrictional, Rolling, Twisting};
    use crate::material::{Elasticity, Material, Materials, Tension};
    use granular_core::{D2, D3, Spin, Vector};

    /// Numbers between -1 and 1 without a pattern.
    fn noise(seed: usize) -> f64 {
        let mut state = (seed as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        state = (state ^ (state >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((state >> 11) as f64) / (1_u64 << 52) as f64 - 1.0
    }

    /// Grains in a row, some of which meet the next one within the step, for good, or not at all.
    struct Row<D: Dim> {
        position: Vec<D::Vec>,
        velocity: Vec<D::Vec>,
        spin: Vec<D::Spin>,
        radius: Vec<f64>,
        mass: Vec<f64>,
    }

    impl<D: Dim> Row<D> {
        fn of(count: usize) -> Self {
            let vector = |k: usize, size: f64| {
                let parts: Vec<f64> = (0..D::N).map(|axis| size * noise(7 * k + axis)).collect();
                D::Vec::from_slice(&parts).unwrap()
            };
            let spins =
                (0..count).map(|k| D::Spin::of_components([noise(k), noise(k + 91), noise(k + 17)]) * 50.0);
            Self {
                position: (0..count).map(|k| D::Vec::along(0, 2e-3 * k as f64) + vector(k, 2e-5)).collect(),
                velocity: (0..count).map(|k| vector(k + 1000, 0.5)).collect(),
                spin: spins.collect(),
                radius: (0..count).map(|k| 1e-3 + 1e-5 * noise(k + 5)).collect(),
                mass: (0..count).map(|k| 1e-5 + 1e-6 * noise(k + 6)).collect(),
            }
        }

        fn view(&self) -> View<'_, D> {
            View {
                position: &self.position,
                velocity: &self.velocity,
                spin: &self.spin,
                start_velocity: &self.velocity,
                start_spin: &self.spin,
                radius: &self.radius,
                mass: &self.mass,
                material: &[],
                first_material: 0,
                walls: &[],
                poses: &[],
                cell: None,
                dt: 1e-6,
                last_dt: 1.1e-6,
                predicts: true,
                margin: 0.0,
                arm_share: 0.5,
            }
        }
    }

    /// Each contact of a batch, however full, has the bits of the contact alone.
    fn a_batch_is_its_contacts<D: Dim, L: ContactLaw<D>>() {
        let mut materials = Materials::new();
        let elasticity = Some(Elasticity { young_modulus: 5e7, poisson_ratio: 0.25 });
        let material =
            Material { elasticity, rolling_friction: 0.1, twisting_friction: 0.1, ..Material::default() };
        materials.add(material).unwrap();
        let law = L::between(&materials.pair(0, 0), Tension::Cut);
        let row = Row::<D>::of(BATCH + 1);
        let view = row.view();
        let mut met = 0;
        for count in 1..=BATCH {
            let mut batch = Batch::<D, L, true>::new();
            for k in 0..count {
                let arm = row.position[k + 1] - row.position[k];
                let address = Address { first: k as u32 + 1, second: k as u32, memory: k as u32, owed: 0 };
                batch.note(address, (arm, arm.length_squared()));
            }
            let memory = vec![L::Memory::default(); count];
            batch.gather(&view, &memory);
            // Twice, so that springs are stretched.
            batch.load(&view, &law);
            batch.load(&view, &law);
            for k in 0..count {
                let (meeting, arms) = batch.pair(k).meet::<L>(&view);
                let (mut memory, mut tally) = (L::Memory::default(), Tally::<true>::default());
                law.load(&meeting, &mut memory, &mut tally);
                let before = tally.losses();
                let load = law.load(&meeting, &mut memory, &mut tally);
                assert_eq!(batch.presence[k], meeting.presence);
                if meeting.presence == 0.0 {
                    continue;
                }
                met += 1;
                assert_eq!(batch.force[k], push_of::<D, L>(&load, meeting.normal));
                assert_eq!(batch.torques[1][k], -load.rolling - load.tangential * arms.1);
                assert_eq!(batch.memories[k], memory);
                let (given, both) = (batch.losses(k).total(), tally.losses().total());
                assert!((before.total() + given - both).abs() <= 1e-12 * both.abs(), "{given} {both}");
            }
        }
        assert!(met > BATCH && met < BATCH * (BATCH + 1) / 2, "{met}");
    }

    #[test]
    fn contacts_in_a_batch_have_the_bits_of_contacts_alone() {
        a_batch_is_its_contacts::<D2, LinearFrictional>();
        a_batch_is_its_contacts::<D2, Rolling<HertzMindlin>>();
        a_batch_is_its_contacts::<D3, LinearFrictional>();
        a_batch_is_its_contacts::<D3, Twisting<HertzMindlin>>();
    }
}
