use super::*;
use crate::axes::InSpace;
use crate::element::{ElementTest, Path, run};
use granular_core::random::Chance;

/// Numbers of the order of those of Erksak sand.
const SAND: NorSandConstants = NorSandConstants {
    critical_ratio: 1.25,
    critical_void_ratio: 0.82,
    critical_slope: 0.015,
    coupling: 0.3,
    dilation_limit: 3.5,
    hardening: 150.0,
};

fn elastic(exponent: f64) -> PressureElastic {
    PressureElastic::new(30e6, 100e3, 0.2, exponent, 10e6).unwrap()
}

fn sand_of(constants: NorSandConstants, void_ratio: f64, exponent: f64) -> NorSand {
    let image_pressure = NorSand::image_pressure(100e3, constants.coupling);
    NorSand::new(elastic(exponent), constants, NorSandState { void_ratio, image_pressure }).unwrap()
}

fn sand(void_ratio: f64) -> NorSand {
    sand_of(SAND, void_ratio, 0.5)
}

fn ratio(test: &ElementTest) -> Vec<f64> {
    test.states.iter().map(|state| state.deviator_stress / state.mean_pressure).collect()
}

#[test]
fn loose_and_dense_sand_meet_at_the_critical_state() {
    for (void_ratio, is_dense) in [(0.60, true), (0.85, false)] {
        let law = sand(void_ratio);
        let test = run(&law, &Path::triaxial_compression(100e3, 0.8).in_increments(400)).unwrap();
        let last = test.last();
        let ratios = ratio(&test);
        assert!((ratios[400] / 1.25 - 1.0).abs() < 5e-3, "{}", ratios[400]);
        let found = law.void_ratio(last.volumetric_strain.exp());
        let critical = law.critical_void_ratio(last.mean_pressure);
        assert!((found - critical).abs() < 5e-3, "{found} {critical}");
        assert!((last.memory[IMAGE] / last.mean_pressure - 1.0).abs() < 0.02);
        let peak = ratios.iter().copied().fold(0.0, f64::max);
        assert_eq!(peak > 1.3, is_dense, "{peak}");
        assert_eq!(last.volumetric_strain > 0.0, is_dense);
    }
}

#[test]
fn extension_has_a_smaller_critical_ratio() {
    let law = sand(0.7);
    let compression = SymmetricTensor { yy: -2.0, ..SymmetricTensor::IDENTITY * -1.0 };
    assert!((law.critical_ratio::<InSpace>(compression) - 1.25).abs() < 1e-7);
    let extension = SymmetricTensor { yy: -0.5, ..SymmetricTensor::IDENTITY * -1.0 };
    assert!((law.critical_ratio::<InSpace>(extension) - 3.0 * 1.25 / (3.0 + 1.25)).abs() < 1e-7);
}

#[test]
fn loose_sand_liquefies_at_constant_volume() {
    let law = sand(0.88);
    let test = run(&law, &Path::simple_shear_of_constant_volume(100e3, 0.2)).unwrap();
    assert!(test.last().mean_pressure < 5e3, "{}", test.last().mean_pressure);
    let dense = run(&sand(0.65), &Path::simple_shear_of_constant_volume(100e3, 0.2)).unwrap();
    assert!(dense.last().mean_pressure > 300e3, "{}", dense.last().mean_pressure);
}

/// Triaxial compression at constant volume: the equations of the law in p, q and the image pressure, in small explicit steps.
fn reference(law: &NorSand, bulk: f64, shear: f64, strain: f64, steps: u32) -> (f64, f64, f64) {
    let NorSandConstants { critical_ratio: m, coupling: n, dilation_limit: chi, hardening: h, .. } =
        law.constants;
    let (mut p, mut q, mut image) = (100e3, 0.0, law.start.image_pressure);
    let step = strain / f64::from(steps);
    let power = n / (1.0 - n);
    for _ in 0..steps {
        let share = (p / image).powf(power);
        let dilation = (m - q / p) / (1.0 - n);
        let state = law.start.void_ratio - law.critical_void_ratio(image);
        let hardest = p * (1.0 + n * chi * state / m).powf((n - 1.0) / n);
        // f = q - p ratio(p, p_i): derivatives with p and with the image pressure.
        let with_p = -(m / n) * (1.0 - (1.0 - n) * share) + m * share;
        let with_image = -m * p * share / image;
        let hardening = h * (hardest - image);
        let excess = q - p * (m / n) * (1.0 - (1.0 - n) * share);
        let plastic =
            (3.0 * shear * step + excess) / (3.0 * shear + with_p * bulk * dilation - with_image * hardening);
        p -= bulk * dilation * plastic;
        q += 3.0 * shear * (step - plastic);
        image += hardening * plastic;
    }
    (p, q, image)
}

#[test]
fn stress_follows_the_equations_of_the_law() {
    let law = sand_of(SAND, 0.75, 0.0);
    let (shear, bulk) = (30e6, 30e6 * 2.0 * 1.2 / (3.0 * 0.6));
    let (p, q, image) = reference(&law, bulk, shear, 0.02, 400_000);
    let error = |increments: u32| {
        let share = 0.02 / f64::from(increments);
        let strain =
            SymmetricTensor { xx: 0.5 * share, yy: -share, zz: 0.5 * share, ..SymmetricTensor::ZERO };
        let mut stress = SymmetricTensor::IDENTITY * -100e3;
        let mut memory = law.start();
        for _ in 0..increments {
            stress = law.respond::<InSpace>(stress, &mut memory, &Increment::of_strain(strain)).stress;
        }
        let off = [
            measures::mean_pressure(stress) / p - 1.0,
            measures::deviator_stress(stress) / q - 1.0,
            memory[IMAGE] / image - 1.0,
        ];
        off.iter().fold(0.0, |largest: f64, part| largest.max(part.abs()))
    };
    let (coarse, fine) = (error(2000), error(4000));
    assert!(fine < 5e-4, "{coarse} {fine}");
    assert!((coarse / fine - 2.0).abs() < 0.2, "of first order: {coarse} {fine}");
}

#[test]
fn elasticity_keeps_energy() {
    let mut chance = Chance::new(3);
    for exponent in [0.0, 0.5, 0.9] {
        let law = elastic(exponent);
        for size in [1e3, 1e5, 1e8] {
            for _ in 0..100 {
                let mut one = || chance.between(-1.0, 1.0) * size;
                let stress =
                    SymmetricTensor { xx: one(), yy: one(), zz: one(), xy: one(), yz: one(), xz: one() };
                let strain = law.strain_of(stress);
                let back = law.stress_of(strain);
                let off = back - stress;
                assert!(off.contract(off).sqrt() < 1e-12 * size, "{exponent} {stress:?} {back:?}");
                // The energy changes by the stress times the strain.
                let change = SymmetricTensor { xx: one(), xy: one(), ..SymmetricTensor::ZERO } * 1e-5;
                let (low, high) = (stress - change, stress + change);
                let work = stress.contract(law.strain_of(high) - law.strain_of(low));
                let gained = law.energy_at(high) - law.energy_at(low);
                let scale = law.energy_at(stress) * 1e-5;
                assert!((work - gained).abs() < 1e-3 * scale, "{exponent}: {work} {gained}");
            }
        }
    }
    // With the exponent zero the law is linear.
    let linear = crate::LinearElastic::new(2.0 * 1.2 * 30e6, 0.2).unwrap();
    let strain = SymmetricTensor { xx: -1e-3, xy: 2e-4, ..SymmetricTensor::ZERO };
    let off = elastic(0.0).stress_of(strain) - linear.stress_of(strain);
    assert!(off.contract(off).sqrt() < 1e-8);
    assert!((elastic(0.0).greatest_wave_speed(2000.0) - linear.compression_speed(2000.0)).abs() < 1e-9);
}

/// Whatever happens: the stress is finite, within the surface, and nothing is gained.
#[test]
fn random_increments_are_survived() {
    let mut chance = Chance::new(4);
    for trial in 0..60 {
        let coupling = [0.0, 0.3, 0.6][trial % 3];
        let constants = NorSandConstants { coupling, ..SAND };
        let law = sand_of(constants, chance.between(0.4, 1.1), [0.0, 0.5][trial % 2]);
        let mut stress = SymmetricTensor::ZERO;
        let mut memory = law.start();
        let mut volume = 0.0;
        for _ in 0..30 {
            let size = 10.0_f64.powf(chance.between(-6.0, -0.5));
            let mut one = || chance.between(-1.0, 1.0) * size;
            let strain = SymmetricTensor { xx: one(), yy: one(), zz: one(), xy: one(), yz: one(), xz: one() };
            let strain = strain - SymmetricTensor::IDENTITY * (0.2 * size);
            volume += strain.trace();
            let increment = Increment { strain, dt: 0.0, volume_ratio: f64::exp(volume) };
            let response = law.respond::<InSpace>(stress, &mut memory, &increment);
            stress = response.stress;
            assert!(stress.contract(stress).is_finite() && memory.iter().all(|part| part.is_finite()));
            assert!(response.plastic_work >= 0.0, "{}", response.plastic_work);
            let (p, q) = (measures::mean_pressure(stress), measures::deviator_stress(stress));
            assert!(p >= -1e-12 && memory[GAP] >= 0.0 && memory[IMAGE] > 0.0, "{p} {q} {memory:?}");
            let void_ratio = law.void_ratio(increment.volume_ratio);
            let surface = Surface { law: &law, m: law.critical_ratio::<InSpace>(stress), void_ratio };
            let excess = surface.excess(p, q, memory[IMAGE]);
            assert!(excess <= 1e-9 * (p + q) + 1e-6, "{excess} of {p} {q}, {memory:?}");
        }
    }
}

#[test]
fn what_is_not_finite_shows() {
    let law = sand(0.7);
    for broken in [f64::NAN, f64::INFINITY] {
        let strain = SymmetricTensor { xx: broken, ..SymmetricTensor::ZERO };
        let stress = SymmetricTensor::IDENTITY * -1e5;
        let after = law.respond::<InSpace>(stress, &mut law.start(), &Increment::of_strain(strain)).stress;
        assert!(!after.trace().is_finite());
    }
}

#[test]
fn constants_out_of_range_are_refused() {
    let state = NorSandState { void_ratio: 0.7, image_pressure: 1e5 };
    let refused = |constants, state| NorSand::new(elastic(0.5), constants, state).unwrap_err().to_string();
    assert!(
        refused(NorSandConstants { coupling: 1.0, ..SAND }, state).starts_with("coupling of work is 1, but")
    );
    assert!(
        refused(NorSandConstants { critical_ratio: 3.0, ..SAND }, state).starts_with("critical stress ratio")
    );
    assert!(refused(NorSandConstants { hardening: f64::NAN, ..SAND }, state).starts_with("hardening is NaN"));
    assert!(refused(SAND, NorSandState { image_pressure: 0.0, ..state }).starts_with("image pressure"));
    assert!(PressureElastic::new(1e6, 1e5, 0.5, 0.5, 1e6).is_err());
    assert!(PressureElastic::new(1e6, 1e5, 0.2, 1.0, 1e6).is_err());
}
