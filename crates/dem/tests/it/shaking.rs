//! Shaking adds an acceleration, and the ledger counts its work.

use granular_core::glam::DVec2;
use granular_core::{D2, Section, Solver};
use granular_dem::{Dem, Grain, Material, Materials, Options, Setup, Shaking, Wall};

const DT: f64 = 1e-5;

fn heap() -> Dem<D2> {
    let mut materials = Materials::default();
    let material = Material { normal_stiffness: 1e5, restitution: 0.5, friction: 0.3, ..Material::default() };
    let grain = materials.add(material).unwrap();
    let grains = (0..40).map(|k| {
        let place = DVec2::new(1e-3 + 2.1e-3 * f64::from(k % 8), 1e-3 + 2.1e-3 * f64::from(k / 8));
        Grain::at(place, 1e-3, grain)
    });
    let plane = |name: &str, x: f64, y: f64, nx: f64, ny: f64| {
        Wall::plane(name, DVec2::new(x, y), DVec2::new(nx, ny), grain).unwrap()
    };
    let walls = vec![
        plane("floor", 0.0, 0.0, 0.0, 1.0),
        plane("left", 0.0, 0.0, 1.0, 0.0),
        plane("right", 0.0171, 0.0, -1.0, 0.0),
    ];
    Dem::new(Setup {
        materials,
        grains: grains.collect(),
        walls,
        gravity: DVec2::new(0.0, -9.81),
        options: Options { ledger: true, ..Options::default() },
    })
    .unwrap()
}

fn shaking() -> Shaking<D2> {
    Shaking { acceleration: DVec2::new(5.0, 20.0), from: 40.0, to: 200.0, pass: 0.05 }
}

#[test]
fn a_free_grain_follows_the_integral_of_the_acceleration() {
    let mut materials = Materials::default();
    let material = materials.add(Material::default()).unwrap();
    let grains = vec![Grain::at(DVec2::ZERO, 1e-3, material)];
    let (walls, gravity, options) = (vec![], DVec2::ZERO, Options::default());
    let mut dem = Dem::<D2>::new(Setup { materials, grains, walls, gravity, options }).unwrap();
    // A constant frequency: v = A/w (1 - cos wt), the middle of steps integrates to second order.
    let (amplitude, frequency) = (DVec2::new(0.0, 3.0), 50.0);
    dem.set_shaking(Some(Shaking { acceleration: amplitude, from: frequency, to: frequency, pass: 1.0 }))
        .unwrap();
    let (steps, rate) = (700, core::f64::consts::TAU * frequency);
    dem.advance(DT, steps).unwrap();
    let exact = amplitude.y / rate * (1.0 - (rate * steps as f64 * DT).cos());
    assert!((dem.grain(0).velocity.y - exact).abs() < 1e-6 * exact, "{} {exact}", dem.grain(0).velocity.y);
}

#[test]
fn the_work_of_shaking_is_in_the_ledger() {
    let mut dem = heap();
    dem.set_shaking(Some(shaking())).unwrap();
    let start = dem.energies().mechanical();
    dem.advance(DT, 40_000).unwrap();
    let losses = dem.losses().total();
    assert!(losses > 0.5 * start, "it is shaken well: {losses} of {start}");
    let residual = dem.energy_residual().unwrap();
    assert!(residual.abs() < 1e-3 * start, "{residual} of {start}");
    // It ends.
    dem.set_shaking(None).unwrap();
    dem.advance(DT, 30_000).unwrap();
    assert!(dem.energies().translational() < 1e-6 * start);
}

#[test]
fn a_shaken_heap_is_restored_to_the_same_bits() {
    let mut whole = heap();
    whole.set_shaking(Some(shaking())).unwrap();
    whole.advance(DT, 1234).unwrap();
    let mut section = Section::new("dem");
    whole.save(&mut section);
    let mut restored = heap();
    restored.restore(&section).unwrap();
    whole.advance(DT, 777).unwrap();
    (0..777).for_each(|_| restored.advance(DT, 1).unwrap());
    let [one, other] = [&whole, &restored].map(|dem| {
        let mut section = Section::new("dem");
        dem.save(&mut section);
        format!("{section:?}")
    });
    assert!(one == other);
}

#[test]
fn values_out_of_range_are_refused() {
    let mut dem = heap();
    for wrong in [
        Shaking { from: 0.0, ..shaking() },
        Shaking { to: -1.0, ..shaking() },
        Shaking { pass: f64::NAN, ..shaking() },
    ] {
        assert!(dem.set_shaking(Some(wrong)).is_err());
    }
}
