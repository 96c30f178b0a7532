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
            twist_share: 0.5,
            law_reach: 0.0,
            arm_share: 0.5,
        }
    }
}

fn material(friction: f64) -> Material {
    let elasticity = Some(Elasticity { young_modulus: 5e7, poisson_ratio: 0.25 });
    Material { elasticity, friction, rolling_friction: 0.1, twisting_friction: 0.1, ..Material::default() }
}

/// Each contact of a batch, however full, has the bits of the contact alone, under its own law.
fn a_batch_is_its_contacts<D: Dim, L: crate::law::MaterialLaw<D>>(law_of: impl Fn(usize) -> usize) {
    let mut materials = Materials::new();
    materials.add(material(0.5)).unwrap();
    materials.add(material(0.001)).unwrap();
    let laws: Vec<L> = (0..4).map(|k| L::between(&materials.pair(k / 2, k % 2), Tension::Cut)).collect();
    let row = Row::<D>::of(BATCH + 1);
    let view = row.view();
    let (mut met, mut all) = (0, 0);
    for count in 1..=BATCH {
        let mut batch = Batch::<D, L, true>::new();
        for k in 0..count {
            let Some(place) = batch.place(law_of(k)) else { break };
            let arm = row.position[k + 1] - row.position[k];
            let (first, second) = (k as u32 + 1, k as u32);
            let address = Address { first, second, memory: second, owed: 0, place: place as u32 };
            batch.note(address, (arm, arm.length_squared()));
        }
        assert!(batch.len == count || batch.used == REGISTERS, "{count} {}", batch.used);
        let memory = vec![L::Memory::default(); count];
        batch.gather(&view, &memory);
        // Twice, so that springs are stretched.
        batch.load(&view, &laws);
        batch.load(&view, &laws);
        for (listed, to) in batch.addresses().enumerate() {
            assert_eq!(to.second as usize, listed, "the order of the list");
            all += 1;
            met += usize::from(has_the_bits_alone(&batch, to, &view, &laws[law_of(listed)]));
        }
    }
    assert!(met > BATCH && met < all, "{met} of {all}");
}

/// Compares a contact with the same one alone; returns whether it meets.
fn has_the_bits_alone<D: Dim, L: ContactLaw<D>>(
    batch: &Batch<D, L, true>,
    to: Address,
    view: &View<'_, D>,
    law: &L,
) -> bool {
    let k = to.place as usize;
    let (kinematics, arms) = batch.pair(k).meet::<L>(view);
    let (mut memory, mut tally) = (L::Memory::default(), Tally::<true>::default());
    law.load(&kinematics, &mut memory, &mut tally);
    let before = tally.losses();
    let load = law.load(&kinematics, &mut memory, &mut tally);
    assert_eq!(batch.presence[k], kinematics.presence);
    if kinematics.presence == 0.0 {
        return false;
    }
    assert_eq!(batch.force[k], push_of::<D, L>(&load, kinematics.normal));
    assert_eq!(batch.torques[1][k], -load.rolling - load.tangential * arms.1);
    assert_eq!(batch.memories[k], memory);
    let (given, both) = (batch.losses(k).total(), tally.losses().total());
    assert!((before.total() + given - both).abs() <= 1e-12 * both.abs(), "{given} {both}");
    true
}

#[test]
fn contacts_in_a_batch_have_the_bits_of_contacts_alone() {
    a_batch_is_its_contacts::<D2, LinearFrictional>(|_| 0);
    a_batch_is_its_contacts::<D2, Rolling<HertzMindlin>>(|k| k % 2);
    a_batch_is_its_contacts::<D3, LinearFrictional>(|k| 7 * k % 4);
    a_batch_is_its_contacts::<D3, Twisting<HertzMindlin>>(|k| k / 5 % 3);
}
