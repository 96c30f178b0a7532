//! What must not change: momentum of free collisions, and the energy balance of a collapse.

use super::collapse::Collapse;
use super::laws;
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::random::Chance;
use granular_core::{D2, D3, Dim, Linear, Solver, Spin, StepError, Vector};
use granular_dem::{Dem, Grain, Material, Materials, Options, Setup};
use granular_driver::failure::Failure;

/// Drift that round-off may cause, over the sum of magnitudes.
const ROUND_OFF: f64 = 1e-12;

pub(super) fn momentum(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    free_collisions::<D2>(rows)?;
    Ok(free_collisions::<D3>(rows)?)
}

fn free_collisions<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    let mut dem = cloud::<D>();
    let (momentum, angular) = (dem.momentum(), dem.angular_momentum());
    let before = dem.energies();
    let [mut size, mut turning] = [0.0; 2];
    let density = Material::default().density;
    for (_, grain) in dem.grains() {
        let mass = density * D::ball_volume(grain.radius);
        size += mass * grain.velocity.length();
        turning += mass * grain.velocity.length() * grain.position.length()
            + D::BALL_INERTIA * mass * grain.radius.powi(2) * grain.spin.length();
    }
    dem.advance(dem.recommended_step(), 10_000)?;
    let lost = 100.0 * (1.0 - dem.energies().mechanical() / before.mechanical());
    let note = format!("collisions took {lost:.0} % of the energy; scaled by the sum of magnitudes");
    let drift = (dem.momentum() - momentum).length() / size;
    let name = D::BALL;
    let of_momentum =
        Measure::absolute(Tier::Conservation, format!("{name}s: drift of momentum"), drift, 0.0, ROUND_OFF);
    rows.add(of_momentum.note(&note));
    let drift = (dem.angular_momentum() - angular).length() / turning;
    let metric = format!("{name}s: drift of angular momentum");
    rows.add(Measure::absolute(Tier::Conservation, metric, drift, 0.0, ROUND_OFF).note(&note));
    Ok(())
}

/// 64 graded grains that fly towards each other.
fn cloud<D: Dim>() -> Dem<D> {
    let fits = "a cloud of grains is in range";
    let mut materials = Materials::new();
    // A contact lasts as long in space as in the plane, so that as much happens.
    let mass = Material::default().density * D::ball_volume(0.6e-3);
    let normal_stiffness = mass * 3e4_f64.powi(2);
    let material = Material { restitution: 0.7, friction: 0.5, normal_stiffness, ..Material::default() };
    let glass = materials.add(material).expect(fits);
    let mut chance = Chance::new(5);
    let side = if D::N == 2 { 8_usize } else { 4 };
    let mut grain = |index: usize| {
        let place = (0..D::N).fold(D::Vec::ZERO, |place, axis| {
            let row = index / side.pow(axis as u32) % side;
            place + D::Vec::along(axis, 2e-3 * (row as f64 - 0.5 * (side as f64 - 1.0)))
        });
        let random = |chance: &mut Chance| {
            (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, chance.between(-0.2, 0.2)))
        };
        let velocity = random(&mut chance) - place * 60.0;
        let spin = D::Spin::of_components(std::array::from_fn(|_| chance.between(-300.0, 300.0)));
        let radius = chance.between(0.4e-3, 0.8e-3);
        Grain::at(place, radius, glass).moving(velocity).turning(spin)
    };
    let grains = (0..64).map(&mut grain).collect();
    let options = Options::default();
    Dem::new(Setup { materials, grains, walls: vec![], gravity: D::Vec::ZERO, options }).expect(fits)
}

pub(super) fn energy(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let sizes: &[usize] = if effort == Effort::Full { &[400, 3000] } else { &[400] };
    for &grains in sizes {
        let fallen = Collapse::of(grains).with_ledger().run()?;
        let metric = format!("largest energy residual, {grains} disks [% of E_0]");
        let percent = 100.0 * fallen.largest_residual;
        let measure = Measure::absolute(Tier::Conservation, metric, percent, 0.0, 0.1);
        rows.add(measure.note(format!("over {} steps, E_0 the potential energy at the start", fallen.steps)));
    }
    Ok(laws::balance(rows)?)
}
