//! Loads that others put on grains.

use granular_core::glam::{DVec2, DVec3};
use granular_core::quantity::{HydroLoad, Load};
use granular_core::testing::loads_follow_their_grains;
use granular_core::{Accepts, D2, D3, Section, Solver};
use granular_dem::{
    CellControl, Control, Dem, Dem2, Dem3, Grain, Inlet, Material, Materials, Options, Outlet, PeriodicCell,
    Setup, Wall,
};

const DT: f64 = 1e-5;

fn bytes<D: granular_core::Dim>(dem: &Dem<D>) -> String {
    let mut section = Section::new("dem");
    dem.save(&mut section);
    format!("{section:?}")
}

/// `friction` of 120 disks in a box whose lid is open.
fn heap(friction: f64, count: u32) -> Dem2 {
    let mut materials = Materials::new();
    let material = Material { normal_stiffness: 1e5, friction, ..Material::default() };
    let glass = materials.add(material).unwrap();
    let at =
        |k: u32| DVec2::new(f64::from(k % 12) + 0.5 + 0.1 * f64::from(k / 12 % 2), f64::from(k / 12) + 0.5);
    let grains = (0..count).map(|k| Grain::at(at(k) * 2.1e-3, 1e-3, glass)).collect();
    let walls = vec![
        Wall::plane("floor", DVec2::ZERO, DVec2::Y, glass).unwrap(),
        Wall::plane("left", DVec2::ZERO, DVec2::X, glass).unwrap(),
        Wall::plane("right", DVec2::new(26e-3, 0.0), -DVec2::X, glass).unwrap(),
    ];
    let options = Options { ledger: true, ..Options::default() };
    Dem2::new(Setup { materials, grains, walls, gravity: DVec2::new(0.0, -9.81), options }).unwrap()
}

/// The leapfrog is exact for a constant force: place, velocity, spin and work are those of the closed form.
#[test]
fn a_grain_under_a_constant_load_follows_the_closed_form() {
    let mut materials = Materials::new();
    let glass = materials.add(Material { friction: 0.0, ..Material::default() }).unwrap();
    let grain = Grain::at(DVec3::ZERO, 1e-3, glass).moving(DVec3::new(0.1, 0.0, 0.0));
    let gravity = DVec3::new(0.0, 0.0, -9.81);
    let options = Options { ledger: true, ..Options::default() };
    let mut dem =
        Dem3::new(Setup { materials, grains: vec![grain], walls: vec![], gravity, options }).unwrap();
    assert!(!dem.turns());
    let load = Load { force: DVec3::new(2e-5, -1e-5, 3e-5), torque: DVec3::new(1e-9, 2e-9, -3e-9) };
    dem.set_load(0, load).unwrap();
    let steps = 1000;
    dem.advance(DT, steps).unwrap();
    let (time, mass) = (steps as f64 * DT, dem.mass());
    let acceleration = load.force / mass + gravity;
    let exact = grain.velocity * time + 0.5 * acceleration * time * time;
    let now = dem.grain(0);
    // The first step predicts nothing: the scheme starts at rest with what acts in its middle.
    assert!((now.position - exact).length() < 1e-12 * exact.length(), "{:?} {exact:?}", now.position);
    assert!((now.velocity - grain.velocity - acceleration * time).length() < 1e-12 * now.velocity.length());
    let spin = load.torque / (0.4 * mass * 1e-6) * time;
    assert!((now.spin - spin).length() < 1e-12 * spin.length(), "{:?} {spin:?}", now.spin);
    let work = load.force.dot(exact) + 0.5 * load.torque.dot(spin) * time;
    assert!((dem.load_work() - work).abs() < 1e-12 * work.abs(), "{} {work}", dem.load_work());
    assert!(dem.energy_residual().unwrap().abs() < 1e-12 * work.abs());
}

#[test]
fn loads_stay_with_their_grains_when_grains_are_sorted() {
    let load = |id: u32| Load {
        force: DVec2::new(0.05 * f64::from(id).sin(), 0.0),
        torque: 1e-5 * f64::from(id).cos(),
    };
    loads_follow_their_grains::<D2, Dem2>(|| heap(0.3, 528), load, DT, 5010).unwrap();
    let flat = |k: u32| DVec3::new(f64::from(k % 24), f64::from(k / 24), 0.0) * 2.5e-3;
    let spheres = || {
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        let grains = (0..528).map(|k| Grain::at(flat(k), 1e-3, glass)).collect();
        let (gravity, options) = (DVec3::ZERO, Options::default());
        Dem3::new(Setup { materials, grains, walls: vec![], gravity, options }).unwrap()
    };
    let load =
        |id: u32| Load { force: DVec3::splat(1e-6 * f64::from(id)), torque: DVec3::X * 1e-9 * f64::from(id) };
    loads_follow_their_grains::<D3, Dem3>(spheres, load, 1e-6, 5003).unwrap();
}

#[test]
fn loads_of_nothing_change_no_bit_of_the_motion_and_no_loads_take_no_memory() {
    let (mut plain, mut enabled) = (heap(0.3, 120), heap(0.3, 120));
    Accepts::<HydroLoad<D2>>::enable(&mut enabled);
    assert!(plain.memory().bytes_per_item < enabled.memory().bytes_per_item);
    for dem in [&mut plain, &mut enabled] {
        dem.advance(DT, 3000).unwrap();
    }
    assert!(plain.loads().is_empty());
    for id in 0..120 {
        assert_eq!(plain.grain(id), enabled.grain(id));
    }
    assert!(!bytes(&plain).contains("of loads") && bytes(&enabled).contains("of loads"));
}

#[test]
fn a_run_with_loads_is_restored_to_the_same_bits_and_its_ledger_is_whole() {
    for friction in [0.0, 0.3] {
        let loaded = || {
            let mut dem = heap(friction, 120);
            for id in 0..120 {
                let force = DVec2::new(0.02 * f64::from(id).sin(), 0.01);
                dem.set_load(id, Load { force, torque: 1e-6 * f64::from(id % 7) }).unwrap();
            }
            dem
        };
        let mut whole = loaded();
        whole.advance(DT, 1500).unwrap();
        let mut section = Section::new("dem");
        whole.save(&mut section);
        let mut restored = heap(friction, 120);
        restored.restore(&section).unwrap();
        whole.advance(DT, 700).unwrap();
        (0..700).for_each(|_| restored.advance(DT, 1).unwrap());
        assert!(bytes(&whole) == bytes(&restored));
        let residual = whole.energy_residual().unwrap().abs();
        assert!(residual < 0.02 * whole.load_work().abs().min(whole.losses().total()), "{residual}");
        whole.clear_inputs();
        assert!(whole.loads().iter().all(|load| *load == Load::ZERO));
    }
}

#[test]
fn grains_that_come_have_no_load_and_others_keep_theirs_when_some_go() {
    let mut dem = heap(0.3, 24);
    let outlet = Outlet::Beyond { point: DVec2::new(0.0, 2.1e-3), normal: DVec2::Y };
    for id in 0..24 {
        dem.set_load(id, Load { force: DVec2::new(1e-3 * f64::from(id + 1), 0.0), torque: 0.0 }).unwrap();
    }
    dem.add_outlet(outlet).unwrap();
    let (low, high) = (DVec2::new(1e-3, 10e-3), DVec2::new(25e-3, 14e-3));
    let material = granular_dem::MaterialId::of_index(0);
    let inlet = Inlet {
        name: "in".to_owned(),
        low,
        high,
        rate: 2000.0,
        number: 2,
        radii: vec![1e-3],
        velocity: DVec2::ZERO,
        material,
        seed: 1,
        runs: true,
    };
    dem.add_inlet(inlet).unwrap();
    dem.advance(DT, 101).unwrap();
    assert!(dem.exchanged().removed >= 12 && dem.exchanged().inserted == 2);
    for ((id, _), load) in dem.grains().zip(dem.loads()) {
        let force = if id < 24 { 1e-3 * f64::from(id + 1) } else { 0.0 };
        assert_eq!(load.force.x, force, "grain {id}");
    }
}

/// A load does work on the motion relative to the flow of a cell, and is no part of its stress.
#[test]
fn in_a_cell_in_shear_the_ledger_counts_loads() {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let grains = vec![Grain::at(DVec2::new(4e-3, 7e-3), 1e-3, glass).moving(DVec2::new(0.3, 0.2))];
    let options = Options { ledger: true, ..Options::default() };
    let mut dem =
        Dem2::new(Setup { materials, grains, walls: vec![], gravity: DVec2::ZERO, options }).unwrap();
    dem.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::splat(10e-3), &[true, true]).unwrap()).unwrap();
    dem.control_cell(CellControl::default().with(0, 1, Control::Rate(20.0))).unwrap();
    dem.set_load(0, Load { force: DVec2::new(0.01, 0.02), torque: 0.0 }).unwrap();
    dem.advance(DT, 2000).unwrap();
    let residual = dem.energy_residual().unwrap().abs();
    assert!(dem.load_work() > 1e-6 && residual < 1e-11 * dem.load_work(), "{} {residual}", dem.load_work());
}

#[test]
fn loads_that_make_no_sense_are_refused() {
    let mut dem = heap(0.3, 12);
    assert!(dem.set_load(12, Load::ZERO).is_err());
    assert!(dem.set_load(0, Load { force: DVec2::NAN, torque: 0.0 }).is_err());
    assert!(dem.loads().is_empty());
}
