//! Shaking adds an acceleration, and the ledger counts its work.

use granular_core::glam::DVec2;
use granular_core::{D2, Section, Solver};
use granular_dem::{
    CellControl, Control, Dem, Dem2, Grain, Material, Materials, Options, PeriodicCell, Setup, Shaking, Wall,
};

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
    // The error of contacts falls with the square of the step; what shaking left out would not.
    let residual = |shorter: u64| {
        let mut dem = heap();
        dem.set_shaking(Some(shaking())).unwrap();
        let start = dem.energies().mechanical();
        dem.advance(DT / shorter as f64, shorter * 40_000).unwrap();
        let losses = dem.losses().total();
        assert!(losses > 0.5 * start, "it is shaken well: {losses} of {start}");
        dem.energy_residual().unwrap().abs() / losses
    };
    let [coarse, fine] = [1, 4].map(residual);
    assert!(coarse < 1e-3 && fine < 0.15 * coarse, "{coarse} {fine}");
    // It ends.
    let mut dem = heap();
    dem.set_shaking(Some(shaking())).unwrap();
    let start = dem.energies().mechanical();
    dem.advance(DT, 8000).unwrap();
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

/// Grains in a periodic cell, at rest or in simple shear, and whether the cell came before the shaking.
fn shaken_cell(rate: f64, cell_first: bool) -> Dem2 {
    let mut materials = Materials::new();
    let glass = materials.add(Material { normal_stiffness: 1e5, ..Material::default() }).unwrap();
    let at = |k: usize| DVec2::new((k % 6) as f64 + 0.5, (k / 6) as f64 + 0.5) * 2.1e-3;
    let grains = (0..36)
        .map(|k| {
            Grain::at(at(k), 1e-3, glass).moving(DVec2::new((k as f64).sin(), (3.0 * k as f64).cos()) * 0.2)
        })
        .collect();
    let options = Options { ledger: true, ..Options::default() };
    let gravity = DVec2::new(0.0, -1.0);
    let mut dem = Dem2::new(Setup { materials, grains, walls: vec![], gravity, options }).unwrap();
    let cell = || PeriodicCell::new(DVec2::ZERO, DVec2::splat(12.6e-3), &[true, true]).unwrap();
    if cell_first {
        dem.set_cell(cell()).unwrap();
    }
    dem.set_shaking(Some(shaking())).unwrap();
    if !cell_first {
        dem.set_cell(cell()).unwrap();
    }
    dem.control_cell(CellControl::default().with(0, 1, Control::Rate(rate))).unwrap();
    dem
}

/// Forces of contacts add up to nothing, so the momentum relative to the flow is that of gravity and shaking, whatever
/// the order in which cell and shaking were given.
#[test]
fn a_periodic_cell_is_shaken_whichever_was_given_first() {
    let (mut first, mut second) = (shaken_cell(0.0, true), shaken_cell(0.0, false));
    let start = first.momentum();
    let steps = 4000;
    let mut impulse = DVec2::ZERO;
    for k in 0..steps {
        impulse += (first.gravity() + shaking().at((k as f64 + 0.5) * DT)) * DT * first.mass();
    }
    first.advance(DT, steps).unwrap();
    second.advance(DT, steps).unwrap();
    let missed = (first.momentum() - start - impulse).length();
    assert!(missed < 1e-11 * impulse.length(), "{missed} of {impulse:?}");
    assert!(impulse.x.abs() > 1e-3 * first.mass() || impulse.y.abs() > 1e-3 * first.mass());
    assert_eq!(first.momentum(), second.momentum());
    assert_eq!(first.grain(7).position, second.grain(7).position);
}

#[test]
fn the_work_of_shaking_a_cell_in_shear_is_in_the_ledger() {
    let residual = |shorter: u64| {
        let mut dem = shaken_cell(5.0, true);
        dem.advance(DT / shorter as f64, shorter * 20_000).unwrap();
        dem.energy_residual().unwrap().abs() / dem.losses().total()
    };
    let [coarse, fine] = [1, 4].map(residual);
    assert!(coarse < 5e-3 && fine < 0.3 * coarse, "{coarse} {fine}");
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
