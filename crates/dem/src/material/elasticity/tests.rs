use super::*;
use crate::material::damping_for_restitution;

/// Test, effective modulus, radius, mass, speed; largest overlap, force and duration, from the
/// closed form of Hertz evaluated elsewhere (`validation/hertz_impact/reference.csv`).
const IMPACTS: &[[f64; 7]] = &[
    [2.5e10, 0.005, 0.005_864_31, 20.0, 2.741_13e-4, 10_696.9, 4.033_95e-5],
    [1.066_67e10, 0.005, 0.005_235_99, 20.0, 3.683_04e-4, 7108.24, 5.4201e-5],
    [7.692_31e10, 0.1, 11.3055, 0.2, 4.971_72e-5, 11_369.9, 7.316_57e-4],
    [4.5584e10, 0.1, 7.539_82, 0.2, 5.212_33e-5, 7232.68, 7.670_66e-4],
];

#[test]
fn impacts_follow_the_table() {
    for &[effective_modulus, effective_radius, effective_mass, speed, overlap, force, duration] in IMPACTS {
        let impact = HertzImpact { effective_modulus, effective_radius, effective_mass, speed };
        assert!((impact.largest_overlap() / overlap - 1.0).abs() < 1e-5);
        assert!((impact.largest_force() / force - 1.0).abs() < 1e-5);
        assert!((impact.duration(0.0, Tension::Cut) / duration - 1.0).abs() < 2e-5);
    }
}

/// Restitution and duration of `x'' = -x^(3/2) - alpha x^(1/4) x'`, `x'(0) = 1`, by small steps
/// of the method of Runge and Kutta from the series at the start.
fn integrated(alpha: f64, tension: Tension) -> (f64, f64) {
    let rate = |x: f64, v: f64| -x.max(0.0).powf(1.5) - alpha * x.max(0.0).powf(0.25) * v;
    // x = t - alpha t^(9/4)/(5/4 * 9/4) near the start.
    let t = 1e-4_f64;
    let (mut x, mut v) = (t - alpha * t.powf(2.25) / 2.8125, 1.0 - 0.8 * alpha * t.powf(1.25));
    let (mut time, h) = (t, 2e-5);
    loop {
        let (k1, l1) = (v, rate(x, v));
        let (k2, l2) = (v + 0.5 * h * l1, rate(x + 0.5 * h * k1, v + 0.5 * h * l1));
        let (k3, l3) = (v + 0.5 * h * l2, rate(x + 0.5 * h * k2, v + 0.5 * h * l2));
        let (k4, l4) = (v + h * l3, rate(x + h * k3, v + h * l3));
        x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
        time += h;
        let over = if tension == Tension::Cut { rate(x, v) >= 0.0 && v < 0.0 } else { x <= 0.0 };
        if over {
            return (-v, time);
        }
    }
}

#[test]
fn the_damping_of_the_linear_law_gives_the_restitution_of_the_hertz_law_and_its_duration() {
    let impact =
        HertzImpact { effective_modulus: 0.75, effective_radius: 1.0, effective_mass: 1.0, speed: 1.0 };
    for tension in [Tension::Cut, Tension::Kept] {
        for restitution in [1.0, 0.9, 0.7, 0.5, 0.3, 0.1] {
            let zeta = damping_for_restitution(restitution, tension);
            let (found, time) = integrated(5.0_f64.sqrt() * zeta, tension);
            assert!((found - restitution).abs() < 3e-5, "{tension:?} {restitution}: {found}");
            let expected = impact.duration(zeta, tension);
            assert!((time - expected).abs() < 1e-4, "{tension:?} {restitution}: {time} {expected}");
        }
    }
}

#[test]
fn equal_materials_combine_as_the_textbook_says() {
    let glass = Elasticity { young_modulus: 4.8e10, poisson_ratio: 0.2 };
    let (normal, shear) = glass.effective(&glass);
    assert!((normal / 2.5e10 - 1.0).abs() < 1e-12);
    assert!((shear / (glass.shear_modulus() / (2.0 * 1.8)) - 1.0).abs() < 1e-12);
    assert!((4.0 * shear / normal - glass.stiffness_ratio()).abs() < 1e-12);
}

/// Shortening of a half cylinder from the stresses on its axis: Hertz pressure on one side, the
/// same load on the other, and the uniform tension that frees the rim.
fn shortening(elasticity: &Elasticity, radius: f64, load: f64) -> f64 {
    let Elasticity { young_modulus, poisson_ratio } = *elasticity;
    let a = (2.0 * radius * load * (1.0 - poisson_ratio) / (PI * elasticity.shear_modulus())).sqrt();
    let parts = 400_000;
    let strain = |z: f64| {
        let root = (a * a + z * z).sqrt();
        let across = 1.0 / radius - 2.0 * (a * a + 2.0 * z * z) / (a * a * root) + 4.0 * z / (a * a);
        let along = 1.0 / radius - 2.0 / (2.0 * radius - z) - 2.0 / root;
        let bulk = (1.0 - poisson_ratio * poisson_ratio) / young_modulus;
        -bulk * load / PI * (along - poisson_ratio / (1.0 - poisson_ratio) * across)
    };
    // Fine near the contact: z = R u^3.
    let part = |k: i32| {
        let u = (f64::from(k) + 0.5) / f64::from(parts);
        strain(radius * u.powi(3)) * 3.0 * radius * u * u
    };
    (0..parts).map(part).sum::<f64>() / f64::from(parts)
}

#[test]
fn the_stiffness_of_cylinders_is_the_integral_of_their_strains() {
    let glass = Elasticity { young_modulus: 7e10, poisson_ratio: 0.23 };
    for load in [1e3, 1e5] {
        let expected = load / (2.0 * shortening(&glass, 0.575e-3, load));
        let found = glass.cylinder_stiffness(0.575e-3, load);
        assert!((found / expected - 1.0).abs() < 2e-3, "{load}: {found:e} {expected:e}");
    }
    // 4 x 70 GPa x 0.575 mm is the stiffness of table 4.2.
    assert!((glass.sphere_stiffness(0.575e-3) / 1.61e8 - 1.0).abs() < 1e-9);
}
