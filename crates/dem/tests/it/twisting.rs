//! Twisting resistance of spheres.

use granular_core::Solver;
use granular_core::glam::DVec3;
use granular_dem::{ContactModel, Dem3, Elasticity, Grain, Material, Materials, Options, Setup, Wall};

const RADIUS: f64 = 0.5e-3;
const TWISTING: f64 = 0.2;

/// A sphere that spins about the vertical on a floor, at rest in its overlap.
fn spinning(contact: ContactModel, twisting_friction: f64) -> Dem3 {
    let mut materials = Materials::new();
    let material = Material {
        normal_stiffness: 1e5,
        elasticity: Some(Elasticity { young_modulus: 5e9, poisson_ratio: 0.25 }),
        rolling_friction: 0.1,
        twisting_friction,
        ..Material::default()
    };
    let glass = materials.add(material).unwrap();
    let weight = 9.81 * 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let modulus = materials.pair(0, 0).effective_modulus;
    let overlap = match contact {
        ContactModel::Linear => weight / 1e5,
        ContactModel::Hertz => (0.75 * weight / (modulus * RADIUS.sqrt())).powf(2.0 / 3.0),
    };
    let grain =
        Grain::at(DVec3::new(0.0, 0.0, RADIUS - overlap), RADIUS, glass).turning(DVec3::new(0.0, 0.0, 100.0));
    let walls = vec![Wall::plane("floor", DVec3::ZERO, DVec3::Z, glass).unwrap()];
    let options = Options { contact, ledger: true, ..Options::default() };
    let gravity = DVec3::new(0.0, 0.0, -9.81);
    Dem3::new(Setup { materials, grains: vec![grain], walls, gravity, options }).unwrap()
}

#[test]
fn a_spinning_top_slows_down_as_its_cap_says_and_stops() {
    for contact in [ContactModel::Linear, ContactModel::Hertz] {
        let mut dem = spinning(contact, TWISTING);
        // The spin begins at once, and the spring takes a step to follow: an error of second order.
        let dt = 0.2 * dem.recommended_step();
        let energy = dem.energies().rotational;
        // I w' = -mu m g r with I = 2/5 m r^2.
        let slowing = 2.5 * TWISTING * 9.81 / RADIUS;
        let stop = 100.0 / slowing;
        dem.advance(dt, (0.5 * stop / dt) as u64).unwrap();
        let time = dem.steps() as f64 * dt;
        let spin = dem.grain(0).spin;
        assert!((spin.z - (100.0 - slowing * time)).abs() < 0.1, "{contact:?}: {spin} at {time}");
        assert!(spin.truncate().length() < 1e-9 && dem.grain(0).velocity.truncate().length() < 1e-12);
        dem.advance(dt, (1.0 * stop / dt) as u64).unwrap();
        assert!(dem.grain(0).spin.z.abs() < 0.01, "{contact:?}: {}", dem.grain(0).spin);
        let lost = dem.losses().rolling;
        assert!((lost / energy - 1.0).abs() < 1e-3, "{contact:?}: {lost:e} of {energy:e}");
        let residual = dem.energy_residual().unwrap();
        assert!(residual.abs() < 1e-3 * energy, "{contact:?}: {residual:e} of {energy:e}");
    }
}

#[test]
fn without_twisting_resistance_it_spins_on() {
    let mut dem = spinning(ContactModel::Hertz, 0.0);
    dem.advance(dem.recommended_step(), 1000).unwrap();
    assert_eq!(dem.grain(0).spin.z, 100.0);
}
