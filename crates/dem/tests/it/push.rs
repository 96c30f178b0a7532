//! A push gives the energy or the speed asked for, and the ledger counts it.

use crate::sample::{Lattice, down};
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Section, Solver, Vector};
use granular_dem::{Dem, Grain, Material, Materials, Options, Push, PushProfile, Setup, Strength};

const DT: f64 = 1e-6;

/// A box of grains in touch; they move unless the speed is zero.
fn boxed<D: Dim>(speed: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let side = if D::N == 2 { 40 } else { 12 };
    let lattice = Lattice { side, speed, ..Lattice::default() };
    let (grains, walls) = (lattice.grains::<D>(&[glass]), lattice.walls::<D>(glass));
    let options = Options { ledger: true, skin: 0.02, ..Options::default() };
    Dem::new(Setup { materials, grains, walls, gravity: down::<D>(9.81), options }).unwrap()
}

fn along_x<D: Dim>(strength: Strength, profile: PushProfile) -> Push<D> {
    let mut axis = [0.0; 3];
    // Of any length.
    axis[0] = 2.5;
    Push { direction: D::Vec::from_slice(&axis[..D::N]).unwrap(), strength, profile }
}

fn energy_is_given<D: Dim>(dt: f64) {
    for (speed, profile) in
        [(0.0, PushProfile::Uniform), (0.0, PushProfile::Gradient), (1.5, PushProfile::Gradient)]
    {
        let mut dem = boxed::<D>(speed);
        dem.advance(dt, 50).unwrap();
        let (before, momentum) = (dem.energies(), dem.momentum());
        let (residual, asked) = (dem.energy_residual().unwrap(), 0.11 * dem.mass());
        let pushed = dem.apply_push(&along_x::<D>(Strength::Energy(asked), profile)).unwrap();
        let given = dem.energies().translational() - before.translational();
        let scale = asked + before.translational();
        assert!((given - asked).abs() < 1e-13 * scale, "{given} {asked}");
        assert!((pushed.energy - asked).abs() < 1e-13 * scale, "{pushed:?}");
        let gained = dem.momentum() - momentum;
        assert!((gained.component(0) - pushed.momentum).abs() < 1e-12 * pushed.momentum, "{gained:?}");
        assert!((1..D::N).all(|axis| gained.component(axis).abs() < 1e-12 * pushed.momentum));
        // The ledger counts it, at once and while it is lost.
        assert!((dem.energy_residual().unwrap() - residual).abs() < 1e-12 * scale);
        dem.advance(dt, 400).unwrap();
        assert!(dem.losses().total() > 1e-3 * asked);
        let missing = dem.energy_residual().unwrap() - residual;
        assert!(missing.abs() < 1e-3 * scale, "{missing} {scale} {:?}", dem.losses());
    }
}

#[test]
fn the_energy_asked_for_is_given_to_disks_and_spheres_at_rest_or_not() {
    energy_is_given::<D2>(DT);
    // Spheres are a thousandth as heavy as disks.
    energy_is_given::<D3>(DT / 20.0);
}

#[test]
fn a_speed_is_given_to_all_or_by_depth() {
    let velocities = |push: &Push<D2>| {
        let mut dem = boxed::<D2>(0.0);
        let (mass, pushed) = (dem.mass(), dem.apply_push(push).unwrap());
        let grains: Vec<Grain<D2>> = dem.grains().map(|(_, grain)| grain).collect();
        (grains, mass, pushed)
    };
    let (grains, mass, pushed) = velocities(&along_x(Strength::Speed(-0.8), PushProfile::Uniform));
    assert!(grains.iter().all(|grain| grain.velocity == DVec2::new(-0.8, 0.0)));
    assert!((pushed.momentum + 0.8 * mass).abs() < 1e-13 * mass);
    assert!((pushed.energy - 0.32 * mass).abs() < 1e-13 * mass);
    let (grains, _, pushed) = velocities(&along_x(Strength::Speed(2.0), PushProfile::Gradient));
    let heights = grains.iter().map(|grain| grain.position.y);
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
    for grain in &grains {
        let expected = 2.0 * (high - grain.position.y) / (high - low);
        assert!((grain.velocity.x - expected).abs() < 1e-14 && grain.velocity.y == 0.0, "{grain:?}");
    }
    assert_eq!(pushed.speed, 2.0);
}

#[test]
fn energy_per_grain_is_in_units_of_weight_times_diameter() {
    let mut dem = boxed::<D3>(0.0);
    let pushed = dem.apply_push(&along_x(Strength::EnergyPerGrain(7.0), PushProfile::Gradient)).unwrap();
    let count = dem.len() as f64;
    let diameter = dem.grains().map(|(_, grain)| 2.0 * grain.radius).sum::<f64>() / count;
    let volume: f64 = dem.grains().map(|(_, grain)| D3::ball_volume(grain.radius)).sum();
    let expected = 7.0 * volume * Material::default().density * 9.81 * diameter;
    assert!((pushed.energy - expected).abs() < 1e-12 * expected, "{} {expected}", pushed.energy);
}

#[test]
fn a_pushed_heap_has_the_same_bits_for_any_threads_and_after_a_restart() {
    let state = |dem: &Dem<D2>| {
        let mut section = Section::new("dem");
        dem.save(&mut section);
        section
    };
    let pushed = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut dem = boxed::<D2>(1.0);
            dem.advance(DT, 30).unwrap();
            dem.apply_push(&along_x(Strength::EnergyPerGrain(3.0), PushProfile::Gradient)).unwrap();
            let section = state(&dem);
            dem.advance(DT, 70).unwrap();
            (section, state(&dem))
        })
    };
    let (start, end) = pushed(1);
    for threads in [2, 3, 8] {
        assert!(pushed(threads) == (start.clone(), end.clone()), "{threads} threads");
    }
    let mut restored = boxed::<D2>(1.0);
    restored.restore(&start).unwrap();
    (0..70).for_each(|_| restored.advance(DT, 1).unwrap());
    assert!(state(&restored) == end);
}

#[test]
fn a_row_of_grains_is_lowest_and_no_grains_get_nothing() {
    let with = |grains: Vec<Grain<D2>>, materials: Materials| {
        let (walls, gravity, options) = (vec![], DVec2::ZERO, Options::default());
        Dem::<D2>::new(Setup { materials, grains, walls, gravity, options }).unwrap()
    };
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let mut one = with(vec![Grain::at(DVec2::new(1.0, 2.0), 1e-3, glass)], materials.clone());
    one.apply_push(&along_x(Strength::Speed(3.0), PushProfile::Gradient)).unwrap();
    assert_eq!(one.grain(0).velocity, DVec2::new(3.0, 0.0));
    // Against motion: 3 m/s to -3 m/s takes no energy, a little more takes that.
    let back = |energy| Push {
        direction: -DVec2::X,
        strength: Strength::Energy(energy),
        profile: PushProfile::Uniform,
    };
    let energy = 1e-6 * one.energies().translational();
    one.apply_push(&back(energy)).unwrap();
    assert!((one.grain(0).velocity.x + 3.0 * (1.0_f64 + 1e-6).sqrt()).abs() < 1e-12);
    let pushed = with(Vec::new(), materials).apply_push(&back(1.0)).unwrap();
    assert_eq!((pushed.energy, pushed.momentum), (0.0, 0.0));
}

#[test]
fn values_out_of_range_are_refused() {
    let mut dem = boxed::<D3>(0.0);
    let push = along_x(Strength::Energy(1.0), PushProfile::Uniform);
    for (wrong, what) in [
        (Push { direction: DVec3::ZERO, ..push }, "length of the direction of a push"),
        (Push { direction: DVec3::NAN, ..push }, "length of the direction of a push"),
        (Push { strength: Strength::Speed(f64::INFINITY), ..push }, "speed of a push"),
        (Push { strength: Strength::Energy(-1.0), ..push }, "energy of a push"),
        (Push { strength: Strength::EnergyPerGrain(f64::NAN), ..push }, "energy of a push"),
    ] {
        assert_eq!(dem.apply_push(&wrong).unwrap_err().what, what);
    }
    assert_eq!(dem.momentum(), DVec3::ZERO);
}
