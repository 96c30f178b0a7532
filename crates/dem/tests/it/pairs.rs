//! Contacts between two materials that are stated instead of mixed.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{Section, Solver};
use granular_dem::{Dem2, Dem3, Grain, Material, Materials, Options, PairOverride, Setup, Wall};

const RADIUS: f64 = 1e-3;

/// A restitution of 0.9 for both materials, and of 0.4 between them.
fn materials(friction: f64, stated: PairOverride) -> (Materials, [granular_dem::MaterialId; 2]) {
    let mut materials = Materials::new();
    let one =
        materials.add(Material { restitution: 0.9, friction, normal_stiffness: 1e5, ..Material::default() });
    let other = materials.add(Material { restitution: 0.9, friction, ..Material::default() });
    let ids = [one.unwrap(), other.unwrap()];
    materials.set_pair(ids[1], ids[0], stated).unwrap();
    (materials, ids)
}

/// Two spheres that meet head-on at 1 m/s: the restitution of their impact.
fn restitution(of: [usize; 2]) -> f64 {
    let stated = PairOverride { restitution: Some(0.4), ..PairOverride::default() };
    let (materials, ids) = materials(0.0, stated);
    let at = |x: f64, k: usize| Grain::at(DVec3::new(x, 0.0, 0.0), RADIUS, ids[of[k]]);
    let grains =
        vec![at(-1.1 * RADIUS, 0).moving(DVec3::X * 0.5), at(1.1 * RADIUS, 1).moving(DVec3::X * -0.5)];
    let mut dem = Dem3::new(Setup {
        materials,
        grains,
        walls: vec![],
        gravity: DVec3::ZERO,
        options: Options::default(),
    })
    .unwrap();
    let dt = 0.1 * dem.recommended_step();
    dem.advance(dt, (1e-3 / dt) as u64).unwrap();
    dem.grain(1).velocity.x - dem.grain(0).velocity.x
}

#[test]
fn a_stated_restitution_is_that_of_the_impact() {
    // The band is that of second order at 250 steps per contact.
    for (pair, expected) in [([0, 1], 0.4), ([1, 0], 0.4), ([0, 0], 0.9), ([1, 1], 0.9)] {
        let found = restitution(pair);
        assert!((found - expected).abs() < 1e-3, "{pair:?}: {found} instead of {expected}");
    }
}

/// A disk that slides on a floor of another material, all without friction but for the pair.
fn sliding(stated: PairOverride) -> Dem2 {
    let (materials, [grain, floor]) = materials(0.0, stated);
    let walls = vec![Wall::plane("floor", DVec2::ZERO, DVec2::Y, floor).unwrap()];
    let grains = vec![Grain::at(DVec2::new(0.0, RADIUS), RADIUS, grain).moving(DVec2::X)];
    let gravity = DVec2::new(0.0, -9.81);
    Dem2::new(Setup { materials, grains, walls, gravity, options: Options::default() }).unwrap()
}

#[test]
fn friction_may_be_stated_of_one_pair_alone() {
    let mut dem = sliding(PairOverride { friction: Some(0.3), ..PairOverride::default() });
    let dt = dem.recommended_step();
    let steps = (0.02 / dt) as u64;
    dem.advance(dt, steps).unwrap();
    // Coulomb: v' = -mu g, and w' = -2 mu g / r for a disk.
    let (time, grain) = (steps as f64 * dt, dem.grain(0));
    let (slowing, turning) = (0.3 * 9.81 * time, 2.0 * 0.3 * 9.81 * time / RADIUS);
    assert!((1.0 - grain.velocity.x - slowing).abs() < 0.02 * slowing, "{:?}", grain.velocity);
    assert!((-grain.spin - turning).abs() < 0.02 * turning, "{}", grain.spin);
    // Without it nothing turns, and no spins are kept.
    let mut smooth = sliding(PairOverride { restitution: Some(0.4), ..PairOverride::default() });
    smooth.advance(dt, steps).unwrap();
    assert_eq!((smooth.grain(0).velocity.x, smooth.grain(0).spin), (1.0, 0.0));
    assert!(smooth.memory().bytes_per_item < dem.memory().bytes_per_item);
}

/// The friction of materials is state, that of pairs belongs to the set-up.
#[test]
fn a_restart_keeps_stated_pairs_and_changed_materials() {
    let fresh = || sliding(PairOverride { friction: Some(0.3), ..PairOverride::default() });
    let mut dem = fresh();
    let dt = dem.recommended_step();
    dem.advance(dt, 100).unwrap();
    let floor = dem.materials().iter().count() - 1;
    let friction = dem.materials().pair(0, floor).friction;
    dem.set_friction(dem.grain(0).material, 0.9);
    assert_eq!((dem.materials().pair(0, floor).friction, friction), (0.3, 0.3));
    dem.advance(dt, 100).unwrap();
    let mut section = Section::new("solver");
    dem.save(&mut section);
    let mut other = fresh();
    other.restore(&section).unwrap();
    for dem in [&mut dem, &mut other] {
        dem.advance(dt, 100).unwrap();
    }
    assert_eq!(dem.grain(0), other.grain(0));
    assert_eq!(dem.materials(), other.materials());
}
