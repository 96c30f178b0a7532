//! The order of the scheme in the step, for contacts that stick while they turn.

use granular_core::{D2, D3, Dim, Linear, Solver, Spin, Vector};
use granular_dem::{Dem, Grain, LeverArm, Material, Materials, Options, Setup, Wall};
use std::f64::consts::PI;

const RADIUS: f64 = 1e-3;

/// What a grain sticks to.
#[derive(Clone, Copy, Debug)]
enum Partner {
    Grain,
    Plane,
}

/// A grain that overlaps its partner, approaches it, slides past it and spins, without dashpots and without slipping; relative
/// place and spins after 0.4 of a contact time of so many steps. Nothing begins or ends on the way.
fn after<D: Dim>(steps_per_contact: u64, partner: Partner, lever_arm: LeverArm) -> [f64; 4] {
    let mut materials = Materials::new();
    let material = Material { restitution: 1.0, damping_ratio: 0.0, friction: 1e9, ..Material::default() };
    let glass = materials.add(material).unwrap();
    let frequency = (2.0 * material.normal_stiffness / (material.density * D::ball_volume(RADIUS))).sqrt();
    let overlap = 0.02 * RADIUS;
    let speed = overlap * frequency;
    let velocity = (D::Vec::along(0, -0.3) + D::Vec::along(1, 1.0)) * speed;
    let spin = |share: f64| D::Spin::about_z(share * speed / RADIUS);
    let apart = |radii: f64| D::Vec::along(0, radii * RADIUS - overlap);
    let mover = |place: D::Vec| Grain::at(place, RADIUS, glass).moving(velocity).turning(spin(-0.2));
    let (grains, walls) = match partner {
        Partner::Grain => {
            (vec![mover(apart(2.0)), Grain::at(D::Vec::ZERO, RADIUS, glass).turning(spin(0.7))], vec![])
        }
        Partner::Plane => (
            vec![mover(apart(1.0))],
            vec![Wall::plane("wall", D::Vec::ZERO, D::Vec::along(0, 1.0), glass).unwrap()],
        ),
    };
    let (gravity, options) = (D::Vec::ZERO, Options { lever_arm, ..Options::default() });
    let mut dem = Dem::<D>::new(Setup { materials, grains, walls, gravity, options }).unwrap();
    let dt = PI / frequency / steps_per_contact as f64;
    dem.advance(dt, 2 * steps_per_contact / 5).unwrap();
    let (first, other) = (dem.grain(0), (dem.len() > 1).then(|| dem.grain(1)));
    let place = other.map_or(first.position, |other| first.position - other.position) * (1.0 / overlap);
    let turned = |grain: Grain<D>| grain.spin.z() * RADIUS / speed;
    [place.component(0), place.component(1), turned(first), other.map_or(0.0, turned)]
}

/// Order fitted over steps of T/5000 to T/50000.
fn order<D: Dim>(partner: Partner, lever_arm: LeverArm) -> f64 {
    let exact = after::<D>(800_000, partner, lever_arm);
    let error = |steps: u64| {
        let squares = after::<D>(steps, partner, lever_arm)
            .iter()
            .zip(&exact)
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>();
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
        "{}s at a {partner:?}, {lever_arm:?}: order {order:.3}, error at T/5000 {:.1e}, at T/50000 {:.1e}",
        D::BALL,
        points[0][1].exp(),
        points[3][1].exp()
    );
    order
}

#[test]
fn sticking_contacts_are_of_second_order_also_at_fine_steps() {
    for partner in [Partner::Grain, Partner::Plane] {
        for lever_arm in [LeverArm::Exact, LeverArm::Radius] {
            let (disks, spheres) = (order::<D2>(partner, lever_arm), order::<D3>(partner, lever_arm));
            assert!(disks >= 1.9 && spheres >= 1.9, "{partner:?} {lever_arm:?}: {disks} {spheres}");
        }
    }
}
