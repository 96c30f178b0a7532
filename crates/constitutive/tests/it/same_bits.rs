//! A particle has the bits it has alone, however many are side by side.

use granular_constitutive::granular_core::SymmetricTensor;
use granular_constitutive::granular_core::random::Chance;
use granular_constitutive::{
    ConeMatch, ConstitutiveLaw, DruckerPrager, InPlane, Increment, LinearElastic, MohrCoulomb, Strength,
};

const WIDTH: usize = 64;

type Rows = [[f64; WIDTH]; 4];

fn tensor(rows: &Rows, lane: usize) -> SymmetricTensor {
    let [xx, yy, zz, xy] = [0, 1, 2, 3].map(|row| rows[row][lane]);
    SymmetricTensor { xx, yy, zz, xy, ..SymmetricTensor::ZERO }
}

#[inline(never)]
fn side_by_side<L: ConstitutiveLaw<Memory = [f64; 2]>>(law: &L, stress: &mut Rows, strain: &Rows) {
    for lane in 0..WIDTH {
        let increment = Increment::of_strain(tensor(strain, lane));
        let after = law.respond::<InPlane>(tensor(stress, lane), &mut [0.0; 2], &increment).stress;
        for (row, part) in stress.iter_mut().zip([after.xx, after.yy, after.zz, after.xy]) {
            row[lane] = part;
        }
    }
}

#[inline(never)]
fn alone<L: ConstitutiveLaw<Memory = [f64; 2]>>(
    law: &L,
    stress: SymmetricTensor,
    strain: SymmetricTensor,
) -> SymmetricTensor {
    law.respond::<InPlane>(stress, &mut [0.0; 2], &Increment::of_strain(strain)).stress
}

fn check<L: ConstitutiveLaw<Memory = [f64; 2]>>(law: &L) {
    let mut chance = Chance::new(21);
    for _ in 0..50 {
        let mut rows =
            |low: f64, high: f64| [0; 4].map(|_| [0.0; WIDTH].map(|_: f64| chance.between(low, high)));
        let (mut stress, strain) = (rows(-2e3, 0.5e3), rows(-1e-3, 1e-3));
        let before = stress;
        side_by_side(law, &mut stress, &strain);
        for lane in 0..WIDTH {
            let found = alone(law, tensor(&before, lane), tensor(&strain, lane));
            assert_eq!(found, tensor(&stress, lane));
        }
    }
}

#[test]
fn a_particle_has_its_bits_whoever_is_beside_it() {
    let elastic = LinearElastic::new(1.98e6, 0.23).unwrap();
    let strength = Strength { cohesion: 300.0, ..Strength::of_friction(0.4) };
    let law = MohrCoulomb::new(elastic, strength).unwrap();
    check(&law);
    check(&law.with_tensile_strength(100.0).unwrap());
    check(&DruckerPrager::new(elastic, strength, ConeMatch::PlaneStrain).unwrap());
}
