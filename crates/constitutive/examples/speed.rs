//! Time per update of some laws, one particle at a time and side by side.
//!
//! ```sh
//! RUSTFLAGS=-Ctarget-cpu=native cargo run --release -p granular-constitutive --example speed
//! ```

use granular_constitutive::granular_core::{SymmetricTensor, random::Chance};
use granular_constitutive::{
    Axes, Bingham, ConeMatch, ConstitutiveLaw, DruckerPrager, Grains, InPlane, InSpace, Increment,
    LinearElastic, Memory, MohrCoulomb, MuI, SaturatingFriction, Strength, Tait,
};
use std::hint::black_box;
use std::time::Instant;

/// Particles side by side.
const WIDTH: usize = 32;
const BATCHES: usize = 64;

#[derive(Clone)]
struct Batch {
    stress: [[f64; WIDTH]; 6],
    strain: [[f64; WIDTH]; 6],
    memory: [[f64; WIDTH]; 4],
    lost: [f64; WIDTH],
}

/// The tensor of one particle; what a plane has not is a constant, as in a solver.
#[inline(always)]
fn tensor<A: Axes>(parts: &[[f64; WIDTH]; 6], lane: usize) -> SymmetricTensor {
    let across = |part: usize| if A::PLANE { 0.0 } else { parts[part][lane] };
    SymmetricTensor {
        xx: parts[0][lane],
        yy: parts[1][lane],
        zz: parts[2][lane],
        xy: parts[3][lane],
        yz: across(4),
        xz: across(5),
    }
}

#[inline(always)]
fn update<A: Axes, L: ConstitutiveLaw>(law: &L, batch: &mut Batch, lane: usize) {
    let mut memory = L::Memory::ZERO;
    for part in 0..L::Memory::LEN {
        memory.as_mut()[part] = batch.memory[part][lane];
    }
    let increment = Increment { strain: tensor::<A>(&batch.strain, lane), dt: 1e-5, volume_ratio: 1.0 };
    let response = law.respond::<A>(tensor::<A>(&batch.stress, lane), &mut memory, &increment);
    let after = response.stress;
    let parts = [after.xx, after.yy, after.zz, after.xy, after.yz, after.xz];
    for (row, part) in batch.stress.iter_mut().zip(parts).take(if A::PLANE { 4 } else { 6 }) {
        row[lane] = part;
    }
    for part in 0..L::Memory::LEN {
        batch.memory[part][lane] = memory.as_ref()[part];
    }
    batch.lost[lane] += response.plastic_work + response.viscous_work;
}

#[inline(never)]
fn one_at_a_time<A: Axes, L: ConstitutiveLaw>(law: &L, batch: &mut Batch, lane: usize) {
    update::<A, L>(law, batch, lane);
}

#[inline(never)]
fn side_by_side<A: Axes, L: ConstitutiveLaw>(law: &L, batch: &mut Batch) {
    for lane in 0..WIDTH {
        update::<A, L>(law, batch, lane);
    }
}

/// Pressed and sheared to and fro: elastic, on planes, edges and separated.
fn batches() -> Vec<Batch> {
    let mut chance = Chance::new(1);
    let mut row = |size: f64| [0.0; WIDTH].map(|_: f64| size * chance.between(-1.0, 1.0));
    let one = || Batch {
        stress: [[-1e3; WIDTH], [-1e3; WIDTH], [-1e3; WIDTH], row(300.0), row(300.0), row(300.0)],
        strain: [0; 6].map(|_| row(1e-3)),
        memory: [[0.0; WIDTH]; 4],
        lost: [0.0; WIDTH],
    };
    std::iter::repeat_with(one).take(BATCHES).collect()
}

/// Nanoseconds per update, the best of several rounds.
fn time(mut round: impl FnMut(&mut [Batch])) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..30 {
        let mut batches = batches();
        let start = Instant::now();
        for step in 0..10 {
            round(&mut batches);
            for batch in batches.iter_mut().filter(|_| step % 2 == 1) {
                for strain in batch.strain.as_flattened_mut() {
                    *strain = -*strain;
                }
            }
        }
        let nanoseconds = start.elapsed().as_secs_f64() * 1e9 / (10 * BATCHES * WIDTH) as f64;
        black_box(&batches);
        best = best.min(nanoseconds);
    }
    best
}

fn measure<A: Axes, L: ConstitutiveLaw>(name: &str, law: &L) {
    let single = time(|batches| {
        for batch in batches {
            for lane in 0..WIDTH {
                one_at_a_time::<A, L>(black_box(law), batch, lane);
            }
        }
    });
    let wide = time(|batches| {
        for batch in batches {
            side_by_side::<A, L>(black_box(law), batch);
        }
    });
    let axes = if A::PLANE { "plane" } else { "space" };
    println!(
        "{name:24} {axes}: {single:6.1} ns alone, {wide:6.1} ns side by side, ratio {:4.1}",
        single / wide
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let elastic = LinearElastic::new(1.98e6, 0.23)?;
    let strength = Strength::of_friction(23.2_f64.to_radians());
    let sand = MohrCoulomb::new(elastic, strength)?;
    let clay =
        MohrCoulomb::new(elastic, Strength { cohesion: 1e3, ..strength })?.with_tensile_strength(100.0)?;
    let cone = DruckerPrager::new(elastic, strength, ConeMatch::PlaneStrain)?;
    measure::<InPlane, _>("linear elastic", &elastic);
    measure::<InPlane, _>("Mohr-Coulomb", &sand);
    measure::<InSpace, _>("Mohr-Coulomb", &sand);
    measure::<InPlane, _>("Mohr-Coulomb, cut", &clay);
    measure::<InSpace, _>("Mohr-Coulomb, cut", &clay);
    measure::<InPlane, _>("Drucker-Prager", &cone);
    measure::<InSpace, _>("Drucker-Prager", &cone);
    let grains = Grains::Dry { diameter: 1e-3, density: 2500.0 };
    let flowing = MuI::new(elastic, SaturatingFriction::glass_beads(), grains)?;
    let mud = Bingham::new(1.0, 50.0, 10.0, Tait::new(1500.0, 30.0)?)?;
    measure::<InPlane, _>("mu(I)", &flowing);
    measure::<InSpace, _>("mu(I)", &flowing);
    measure::<InPlane, _>("Bingham", &mud);
    Ok(())
}
