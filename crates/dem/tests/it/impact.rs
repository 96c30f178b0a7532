//! Normal impact of two disks: restitution, and the order of the scheme.

use granular_core::glam::DVec2;
use granular_core::{D2, Solver};
use granular_dem::material::damping_for_restitution;
use granular_dem::{Dem2, Grain, Material, Materials, Options, Setup, Tension};

/// Restitution measured with a step of `dt` times the undamped frequency, from a gap of `gap`
/// strides.
fn measured(restitution: f64, tension: Tension, phase_step: f64, gap: f64) -> f64 {
    let mut materials = Materials::new();
    let glass = materials.add(Material { restitution, friction: 0.0, ..Material::default() }).unwrap();
    let radius = 0.5e-3;
    let mass = 2650.0 * std::f64::consts::PI * radius * radius;
    let frequency = (1.6e6_f64 / (0.5 * mass)).sqrt();
    let dt = phase_step / frequency;
    let speed = 0.1;
    let apart = DVec2::new(radius + 0.5 * gap * speed * dt, 0.0);
    let grains = vec![
        Grain::at(-apart, radius, glass).moving(DVec2::new(0.5 * speed, 0.0)),
        Grain::at(apart, radius, glass).moving(DVec2::new(-0.5 * speed, 0.0)),
    ];
    let options = Options { tension, ..Options::default() };
    let mut dem =
        Dem2::new(Setup { materials, grains, walls: vec![], gravity: DVec2::ZERO, options }).unwrap();
    dem.advance(dt, (gap + 5.0 / phase_step) as u64 + 3).unwrap();
    (dem.grain(1).velocity.x - dem.grain(0).velocity.x) / speed
}

fn root_mean_square(restitution: f64, tension: Tension, phase_step: f64) -> f64 {
    let gaps = 64;
    let square = |k: u32| {
        let gap = 1.0 + f64::from(k) * 0.618_033_988_749 % 1.0;
        (measured(restitution, tension, phase_step, gap) - restitution).powi(2)
    };
    ((0..gaps).map(square).sum::<f64>() / f64::from(gaps)).sqrt()
}

#[test]
fn restitution_is_of_second_order_for_both_cuts() {
    for tension in [Tension::Cut, Tension::Kept] {
        for e in [0.9, 0.75, 0.5, 0.3] {
            let steps = [0.31, 0.157, 0.0771, 0.0383, 0.0193, 0.00967];
            let errors: Vec<f64> = steps.iter().map(|&h| root_mean_square(e, tension, h)).collect();
            let order = (errors[0] / errors[5]).ln() / (steps[0] / steps[5]).ln();
            println!(
                "{tension:?} e = {e}: zeta {:.4} errors {errors:?} order {order:.2}",
                damping_for_restitution(e, tension)
            );
            assert!(order > 1.8);
        }
    }
    let _ = D2;
}
