//! Normal impact of two disks: restitution, contact time, largest overlap, order of the scheme.

use granular_core::glam::DVec2;
use granular_core::{Solver, Vector};
use granular_dem::material::{contact_phase, damping_for_restitution};
use granular_dem::{Dem2, Grain, Material, Materials, Options, Setup, Tension};

const CUTS: [Tension; 2] = [Tension::Cut, Tension::Kept];
/// The table of `material/tests.rs`.
const TABLE: [f64; 6] = [0.99, 0.9, 0.75, 0.5, 0.3, 0.1];
const SPEED: f64 = 0.1;

/// Two disks on their way to meet, with a step of `phase_step` over the undamped frequency, from
/// a gap of `gap` strides; and that frequency.
fn pair(restitution: f64, tension: Tension, phase_step: f64, gap: f64) -> (Dem2, f64) {
    let mut materials = Materials::new();
    let glass = materials.add(Material { restitution, friction: 0.0, ..Material::default() }).unwrap();
    let radius = 0.5e-3;
    let mass = 2650.0 * std::f64::consts::PI * radius * radius;
    let frequency = (1.6e6_f64 / (0.5 * mass)).sqrt();
    let apart = DVec2::new(radius + 0.5 * gap * SPEED * phase_step / frequency, 0.0);
    let grains = vec![
        Grain::at(-apart, radius, glass).moving(DVec2::new(0.5 * SPEED, 0.0)),
        Grain::at(apart, radius, glass).moving(DVec2::new(-0.5 * SPEED, 0.0)),
    ];
    let options = Options { tension, ..Options::default() };
    let setup = Setup { materials, grains, walls: vec![], gravity: DVec2::ZERO, options };
    (Dem2::new(setup).unwrap(), frequency)
}

/// Restitution measured.
fn measured(restitution: f64, tension: Tension, phase_step: f64, gap: f64) -> f64 {
    let (mut dem, frequency) = pair(restitution, tension, phase_step, gap);
    dem.advance(phase_step / frequency, (gap + 5.0 / phase_step) as u64 + 3).unwrap();
    let mut contacts = 0;
    dem.visit_contacts(&mut |_| contacts += 1);
    let parting = (dem.grain(1).velocity - dem.grain(0).velocity).component(0);
    // A cut contact with much damping parts with overlap left, and without any force.
    assert!(tension == Tension::Cut || contacts == 0);
    parting / SPEED
}

fn root_mean_square(restitution: f64, tension: Tension, phase_step: f64) -> f64 {
    let gaps = 64;
    // The place of the contact within a step, spread evenly by the golden ratio.
    let square = |k: u32| {
        let gap = 1.0 + f64::from(k) * 0.618_033_988_749 % 1.0;
        (measured(restitution, tension, phase_step, gap) - restitution).powi(2)
    };
    ((0..gaps).map(square).sum::<f64>() / f64::from(gaps)).sqrt()
}

/// Slope of a straight line through the logarithms.
pub(crate) fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let (x, y): (Vec<f64>, Vec<f64>) = steps.iter().zip(errors).map(|(h, e)| (h.ln(), e.ln())).unzip();
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mx, my) = (mean(&x), mean(&y));
    let slope: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    slope / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}

#[test]
fn restitution_is_of_second_order_for_both_cuts() {
    // No step divides the contact time.
    let steps = [0.31, 0.157, 0.0771, 0.0383, 0.0193, 0.00967];
    for tension in CUTS {
        for e in [0.9, 0.75, 0.5, 0.3] {
            // With little damping the error of the largest step is not yet in its regime.
            let used = if e > 0.8 { &steps[1..] } else { &steps[..] };
            let errors: Vec<f64> = used.iter().map(|&h| root_mean_square(e, tension, h)).collect();
            let found = order(used, &errors);
            println!("{tension:?} e {e}: errors {errors:?} order {found:.3}");
            assert!(found >= 1.9, "{tension:?} e {e}: order {found}, errors {errors:?}");
        }
    }
}

#[test]
fn restitution_is_met_to_1e_4_with_small_steps() {
    for tension in CUTS {
        for e in TABLE {
            for gap in [1.05, 1.3, 1.61, 1.87] {
                let found = measured(e, tension, 0.01, gap);
                assert!((found - e).abs() < 1e-4, "{tension:?} e {e} gap {gap}: {found}");
            }
        }
    }
}

#[test]
fn without_damping_an_impact_keeps_the_speed_for_any_step() {
    for tension in CUTS {
        for (step, tolerance) in [(0.3, 0.02), (0.05, 5e-4), (0.01, 2e-5)] {
            for gap in [1.1, 1.5, 1.9] {
                let found = measured(1.0, tension, step, gap);
                assert!((found - 1.0).abs() < tolerance, "{tension:?} step {step}: {found}");
            }
        }
    }
}

#[test]
fn contact_time_and_largest_overlap_follow_the_closed_forms() {
    let phase_step = 1e-3;
    for tension in CUTS {
        for e in TABLE {
            let zeta = damping_for_restitution(e, tension);
            let (mut dem, frequency) = pair(e, tension, phase_step, 1.5);
            let (mut loaded, mut deepest) = (0_u32, 0.0_f64);
            for _ in 0..5000 {
                dem.step(phase_step / frequency).unwrap();
                let mut force = 0.0;
                dem.visit_contacts(&mut |contact| {
                    force = contact.normal_force;
                    deepest = deepest.max(contact.overlap);
                });
                loaded += u32::from(force != 0.0);
            }
            let phase = f64::from(loaded) * phase_step;
            let expected = contact_phase(zeta, tension);
            assert!((phase - expected).abs() < 2.5 * phase_step, "{tension:?} e {e}: {phase} {expected}");
            let w = (1.0 - zeta * zeta).abs().sqrt();
            let angle = if zeta < 1.0 { zeta.acos() } else { zeta.acosh() };
            let depth = SPEED / frequency * (-zeta / w * angle).exp();
            assert!((deepest / depth - 1.0).abs() < 1e-5, "{tension:?} e {e}: {deepest} {depth}");
        }
    }
}
