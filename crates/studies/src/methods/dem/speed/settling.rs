//! Spheres that settle in an open box from a loose random packing.
//!
//! Diameters of 0.92 to 1.38 mm, spread evenly by number, density 2650 kg/m³, friction 0.53
//! everywhere, a floor and four walls around a cube with a solid fraction of 0.58.

use super::state::{Ball, DIAMETERS, GRAVITY};
use granular_core::D3;
use granular_core::glam::DVec3;
use granular_core::random::Chance;
use granular_core::search::CellGrid;
use granular_dem::{ContactModel, Dem3, Elasticity, Material, Materials, Options, Setup, Wall};
use granular_driver::failure::Failure;
use std::f64::consts::PI;

/// Solid fraction of the cube.
const SOLID: f64 = 0.58;
/// Normal stiffness \[N/m\].
const STIFFNESS: f64 = 1.0e4;
/// Overlap over the mean diameter up to which spheres are moved apart.
const OVERLAP: f64 = 1e-3;
/// Rounds after which they are left as they are.
const ROUNDS: usize = 1500;
/// Rounds between two searches for neighbours.
const SEARCH_EVERY: usize = 5;

/// Elastic constants of the Hertz contacts.
const ELASTICITY: Elasticity = Elasticity { young_modulus: 5.0e7, poisson_ratio: 0.25 };

/// Step \[s\]: a fiftieth of the contact time of two mean spheres under the linear law.
pub(super) fn step() -> f64 {
    let mean = 0.5 * (DIAMETERS[0] + DIAMETERS[1]);
    let mass = Material::default().density * PI / 6.0 * mean.powi(3);
    let damping = -RESTITUTION.ln() / PI.hypot(RESTITUTION.ln());
    PI / (STIFFNESS / (0.5 * mass) * (1.0 - damping * damping)).sqrt() / 50.0
}

const RESTITUTION: f64 = 0.75;

/// Edge of the cube that holds these spheres \[m\].
pub(super) fn edge(radii: impl Iterator<Item = f64>) -> f64 {
    (radii.map(|radius| 4.0 / 3.0 * PI * radius.powi(3)).sum::<f64>() / SOLID).cbrt()
}

/// So many spheres at random places that hardly overlap: spread over a lattice with jitter, then
/// pushed apart.
pub(super) fn loose(count: usize) -> Vec<Ball<D3>> {
    let mut chance = Chance::new(1);
    let radii: Vec<f64> = (0..count).map(|_| 0.5 * chance.between(DIAMETERS[0], DIAMETERS[1])).collect();
    let edge = edge(radii.iter().copied());
    let mut positions = jittered_lattice(count, edge, &mut chance);
    push_apart(&mut positions, &radii, edge);
    positions.into_iter().zip(radii).map(|(position, radius)| Ball::at_rest(position, radius)).collect()
}

fn jittered_lattice(count: usize, edge: f64, chance: &mut Chance) -> Vec<DVec3> {
    let across = (count as f64).cbrt().floor().max(1.0) as usize;
    let layers = count.div_ceil(across * across);
    let cells = DVec3::new(across as f64, across as f64, layers as f64);
    let jitter = 0.1 * (DIAMETERS[0] + DIAMETERS[1]);
    let place = |k: usize| {
        let [x, y, z] =
            [k % across, k / across % across, k / (across * across)].map(|index| index as f64 + 0.5);
        let shift = DVec3::from([(); 3].map(|()| chance.between(-jitter, jitter)));
        DVec3::new(x, y, z) * edge / cells + shift
    };
    (0..count).map(place).collect()
}

/// Moves spheres down the gradient of their overlaps, with some inertia, until they hardly overlap.
fn push_apart(positions: &mut [DVec3], radii: &[f64], edge: f64) {
    let mean = 0.5 * (DIAMETERS[0] + DIAMETERS[1]);
    let mut grid = CellGrid::<D3>::default();
    let mut pairs = Vec::new();
    let mut velocity = vec![DVec3::ZERO; positions.len()];
    for round in 0..ROUNDS {
        if round % SEARCH_EVERY == 0 {
            grid.fill(positions, DIAMETERS[1]);
            pairs.clear();
            for (first, &position) in positions.iter().enumerate() {
                grid.visit_around(position, |second| {
                    let near =
                        (position - positions[second as usize]).length_squared() < DIAMETERS[1].powi(2);
                    if (second as usize) < first && near {
                        pairs.push((first, second as usize));
                    }
                });
            }
        }
        let mut push = vec![DVec3::ZERO; positions.len()];
        let mut deepest = 0.0_f64;
        for &(first, second) in &pairs {
            let arm = positions[first] - positions[second];
            let distance = arm.length();
            let overlap = radii[first] + radii[second] - distance;
            if overlap > 0.0 {
                deepest = deepest.max(overlap);
                let move_by = arm * (overlap / distance.max(f64::MIN_POSITIVE));
                push[first] += move_by;
                push[second] -= move_by;
            }
        }
        for (k, position) in positions.iter().enumerate() {
            let (low, high) = (DVec3::splat(radii[k]), DVec3::splat(edge - radii[k]));
            let outside = (low - *position).max(DVec3::ZERO) - (*position - high).max(DVec3::ZERO);
            deepest = deepest.max(outside.abs().max_element());
            push[k] += outside;
        }
        if deepest < OVERLAP * mean {
            break;
        }
        for (k, position) in positions.iter_mut().enumerate() {
            velocity[k] = velocity[k] * 0.8 + push[k] * 0.2;
            *position += velocity[k];
        }
    }
}

/// A state in an open box, ready to be timed.
fn simulation(spheres: &[Ball<D3>], contact: ContactModel) -> Result<Dem3, Failure> {
    let wrong = |error: granular_dem::SetupError| Failure::Io(format!("state: {error}"));
    let mut materials = Materials::new();
    let elasticity = (contact == ContactModel::Hertz).then_some(ELASTICITY);
    let material = Material {
        elasticity,
        normal_stiffness: STIFFNESS,
        stiffness_ratio: 2.0 / 7.0,
        restitution: RESTITUTION,
        damping_ratio: 0.0,
        friction: 0.53,
        ..Material::default()
    };
    let glass = materials.add(material).map_err(wrong)?;
    let edge = edge(spheres.iter().map(|sphere| sphere.radius));
    let plane = |name, point, normal| Wall::plane(name, point, normal, glass).map_err(wrong);
    let far = DVec3::splat(edge);
    let walls = vec![
        plane("floor", DVec3::ZERO, DVec3::Z)?,
        plane("left", DVec3::ZERO, DVec3::X)?,
        plane("right", far, DVec3::NEG_X)?,
        plane("front", DVec3::ZERO, DVec3::Y)?,
        plane("back", far, DVec3::NEG_Y)?,
    ];
    let grains = spheres.iter().map(|sphere| sphere.grain(glass)).collect();
    let gravity = DVec3::new(0.0, 0.0, -GRAVITY);
    let options = Options { contact, ..Options::default() };
    Dem3::new(Setup { materials, grains, walls, gravity, options }).map_err(wrong)
}

/// [`simulation`] with linear contacts.
///
/// # Errors
/// When a sphere is out of range.
pub(super) fn linear(spheres: &[Ball<D3>]) -> Result<Dem3, Failure> {
    simulation(spheres, ContactModel::Linear)
}

/// [`simulation`] with Hertz-Mindlin contacts.
///
/// # Errors
/// When a sphere is out of range.
pub(super) fn hertz(spheres: &[Ball<D3>]) -> Result<Dem3, Failure> {
    simulation(spheres, ContactModel::Hertz)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_packing_fills_the_box_and_hardly_overlaps() {
        let spheres = loose(4000);
        let edge = edge(spheres.iter().map(|sphere| sphere.radius));
        let deepest = OVERLAP * 0.5 * (DIAMETERS[0] + DIAMETERS[1]);
        for (k, a) in spheres.iter().enumerate() {
            let to_wall = a.position.min(DVec3::splat(edge) - a.position).min_element();
            assert!(to_wall > a.radius - deepest, "{} deep of {deepest}", a.radius - to_wall);
            for b in &spheres[..k] {
                let overlap = a.radius + b.radius - (a.position - b.position).length();
                assert!(overlap < deepest, "{overlap} deep of {deepest}");
            }
        }
        assert!((step() - 0.65e-6).abs() < 0.01e-6, "{}", step());
    }
}
