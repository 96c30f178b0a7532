//! The order of the scheme in the step, for a pair that sticks while it turns.

use granular_core::{D2, D3, Dim, Linear, Solver, Spin, Vector};
use granular_dem::{Dem, Grain, LeverArm, Material, Materials, Options, Setup};
use std::f64::consts::PI;

const RADIUS: f64 = 1e-3;

/// Two grains that overlap, approach, slide past each other and spin, without dashpots and without slipping; relative place
/// and spins after 0.4 of a contact time of so many steps. Nothing begins or ends on the way.
fn after<D: Dim>(steps_per_contact: u64) -> [f64; 4] {
    let mut materials = Materials::new();
    let material = Material { restitution: 1.0, damping_ratio: 0.0, friction: 1e9, ..Material::default() };
    let glass = materials.add(material).unwrap();
    let frequency = (2.0 * material.normal_stiffness / (material.density * D::ball_volume(RADIUS))).sqrt();
    let overlap = 0.02 * RADIUS;
    let speed = overlap * frequency;
    let velocity = (D::Vec::along(0, -0.3) + D::Vec::along(1, 1.0)) * speed;
    let spin = |share: f64| D::Spin::about_z(share * speed / RADIUS);
    let grains = vec![
        Grain::at(D::Vec::ZERO, RADIUS, glass).turning(spin(0.7)),
        Grain::at(D::Vec::along(0, 2.0 * RADIUS - overlap), RADIUS, glass)
            .moving(velocity)
            .turning(spin(-0.2)),
    ];
    // Exact arms shrink while grains approach, and are those of the middle of the step: of first order by themselves.
    let (gravity, options) = (D::Vec::ZERO, Options { lever_arm: LeverArm::Radius, ..Options::default() });
    let mut dem = Dem::<D>::new(Setup { materials, grains, walls: vec![], gravity, options }).unwrap();
    let dt = PI / frequency / steps_per_contact as f64;
    dem.advance(dt, 2 * steps_per_contact / 5).unwrap();
    let [first, second] = [dem.grain(0), dem.grain(1)];
    let arm = (second.position - first.position) * (1.0 / overlap);
    let turned = |grain: &Grain<D>| grain.spin.z() * RADIUS / speed;
    [arm.component(0), arm.component(1), turned(&first), turned(&second)]
}

/// Order fitted over steps of T/5000 to T/50000.
fn order<D: Dim>() -> f64 {
    let exact = after::<D>(800_000);
    let error = |steps: u64| {
        let squares = after::<D>(steps).iter().zip(&exact).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        squares.sqrt()
    };
    let points: Vec<[f64; 2]> = [5000_u64, 10_000, 20_000, 50_000]
        .iter()
        .map(|&steps| [(steps as f64).ln(), error(steps).ln()])
        .collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let slope = |other: usize| {
        points.iter().map(|point| (point[0] - x) * (point[other] - [x, y][other])).sum::<f64>()
    };
    let order = -slope(1) / slope(0);
    println!(
        "{}s: order {order:.3}, error at T/5000 {:.1e}, at T/50000 {:.1e}",
        D::BALL,
        points[0][1].exp(),
        points[3][1].exp()
    );
    order
}

#[test]
fn sticking_pairs_are_of_second_order_also_at_fine_steps() {
    let (disks, spheres) = (order::<D2>(), order::<D3>());
    assert!(disks >= 1.9 && spheres >= 1.9, "{disks} {spheres}");
}
