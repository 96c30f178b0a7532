//! The energy balance with every contact law: grains that fall into a box and come to rest.

use crate::validate::{Measure, Rows, Tier};
use granular_core::random::Chance;
use granular_core::{D2, D3, Dim, Linear, Solver, StepError, Vector};
use granular_dem::{ContactModel, Dem, Elasticity, Grain, Material, Materials, Options, Setup, Wall};

/// Largest and smallest radius \[m\].
const RADII: (f64, f64) = (0.4e-3, 0.6e-3);
/// Distance of the places from which grains fall \[m\].
const SPACING: f64 = 1.5e-3;
/// Time in which they fall and come to rest \[s\].
const TIME: f64 = 0.08;
/// Looks at the residual.
const LOOKS: u64 = 80;

/// Every law in its dimension.
pub(super) fn balance(rows: &mut Rows) -> Result<(), StepError> {
    for contact in [ContactModel::Linear, ContactModel::Hertz] {
        for (name, friction, rolling, twisting) in [
            ("no friction", 0.0, 0.0, 0.0),
            ("friction", 0.5, 0.0, 0.0),
            ("friction, rolling", 0.5, 0.1, 0.0),
            ("friction, rolling, twisting", 0.5, 0.1, 0.1),
        ] {
            let material = Material {
                friction,
                rolling_friction: rolling,
                twisting_friction: twisting,
                ..Material::default()
            };
            if twisting == 0.0 {
                add::<D2>(rows, contact, material, name)?;
            }
            add::<D3>(rows, contact, material, name)?;
        }
    }
    Ok(())
}

fn add<D: Dim>(
    rows: &mut Rows,
    contact: ContactModel,
    material: Material,
    name: &str,
) -> Result<(), StepError> {
    let mut dem = falling::<D>(contact, material);
    let scale = dem.energies().potential;
    let dt = dem.recommended_step();
    let mut largest = 0.0_f64;
    let before = dem.energies().mechanical();
    for _ in 0..LOOKS {
        dem.advance(dt, (TIME / dt) as u64 / LOOKS)?;
        let residual = dem.energy_residual().unwrap_or(f64::NAN).abs();
        // What is not a number must not get lost.
        largest = if residual.is_nan() { residual } else { largest.max(residual) };
    }
    let lost = 100.0 * (1.0 - dem.energies().mechanical() / before);
    let metric =
        format!("largest energy residual, {} {}s, {contact:?}, {name} [% of E_0]", dem.len(), D::BALL);
    let measure = Measure::absolute(Tier::Conservation, metric, 100.0 * largest / scale, 0.0, 0.1);
    rows.add(measure.note(format!("{lost:.0} % of the energy was lost")));
    Ok(())
}

/// Grains above the floor of a box.
fn falling<D: Dim>(contact: ContactModel, material: Material) -> Dem<D> {
    let fits = "falling grains are in range";
    let mut materials = Materials::new();
    // A contact of spheres lasts about as long as one of disks.
    let mass = material.density * D::ball_volume(0.5e-3);
    let glass = materials
        .add(Material {
            normal_stiffness: mass * 2e4_f64.powi(2),
            elasticity: Some(Elasticity {
                young_modulus: mass * 2e4_f64.powi(2) / 2e-5,
                poisson_ratio: 0.25,
            }),
            ..material
        })
        .expect(fits);
    let across: usize = if D::N == 2 { 10 } else { 4 };
    let mut chance = Chance::new(11);
    let count = across.pow(D::N as u32 - 1) * if D::N == 2 { 10 } else { 6 };
    let grain = |index: usize| {
        let (mut rest, mut place) = (index, D::Vec::ZERO);
        for axis in (0..D::N).filter(|&axis| axis != D::UP) {
            place += D::Vec::along(axis, SPACING * ((rest % across) as f64 + 0.5));
            rest /= across;
        }
        place += D::Vec::along(D::UP, SPACING * (rest as f64 + 0.5));
        let jitter = (0..D::N)
            .fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, chance.between(-0.1e-3, 0.1e-3)));
        Grain::at(place + jitter, chance.between(RADII.0, RADII.1), glass)
    };
    let grains = (0..count).map(grain).collect();
    let mut walls = vec![plane::<D>("floor", D::UP, 0.0, 1.0, glass)];
    for axis in (0..D::N).filter(|&axis| axis != D::UP) {
        walls.push(plane::<D>("low", axis, 0.0, 1.0, glass));
        walls.push(plane::<D>("high", axis, SPACING * across as f64, -1.0, glass));
    }
    let options = Options { contact, ledger: true, ..Options::default() };
    let gravity = D::Vec::along(D::UP, -9.81);
    Dem::new(Setup { materials, grains, walls, gravity, options }).expect(fits)
}

fn plane<D: Dim>(
    name: &str,
    axis: usize,
    at: f64,
    towards: f64,
    material: granular_dem::MaterialId,
) -> Wall<D> {
    let wall = Wall::plane(name, D::Vec::along(axis, at), D::Vec::along(axis, towards), material);
    wall.expect("an axis is a direction")
}
