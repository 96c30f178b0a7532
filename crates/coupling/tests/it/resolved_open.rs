//! Free grains that come into a fluid and leave it.

use crate::tank::{Balls, Tank, unit_fluid};
use granular_core::glam::DVec2;
use granular_core::{D2, Dim};
use granular_coupling::ResolvedOptions;
use granular_dem::{Inlet, MaterialId, Outlet};
use granular_lbm::{D2Q9, Face};

/// Disks come in within a tank and are taken out where they have sunk; three more fall in from above, dry until they reach it.
#[test]
fn grains_come_and_go() {
    let mut setup = unit_fluid::<D2>([60, 80, 1], 0.8);
    setup.faces[1] = [Face::REST, Face::REST];
    let gravity = DVec2::new(0.0, -6e-4);
    let above = [10.0, 30.0, 50.0].map(|x| (DVec2::new(x, 90.0 + 0.2 * x), DVec2::ZERO, 3.0));
    let mut dem = Balls { gravity, ..Balls::<D2>::of(2.0, above.to_vec()) }.solver();
    let inlet = Inlet {
        name: "top".to_owned(),
        low: DVec2::new(5.0, 55.0),
        high: DVec2::new(55.0, 65.0),
        rate: 0.004,
        number: u64::MAX,
        radii: vec![2.5, 3.0],
        velocity: DVec2::new(0.0, -0.01),
        material: MaterialId::of_index(0),
        seed: 5,
        runs: true,
    };
    dem.add_inlet(inlet).unwrap();
    dem.add_outlet(Outlet::Beyond { point: DVec2::new(0.0, 15.0), normal: -DVec2::Y }).unwrap();
    let options = ResolvedOptions { gravity: Some(gravity), ..Default::default() };
    let mut tank = Tank::<D2Q9, 9>::of(setup, |_| DVec2::ZERO, dem, options);
    let (mut dry, mut wet) = (0, 0);
    for _ in 0..80 {
        tank.advance(100);
        let dem = tank.grains();
        for ((_, grain), load) in dem.grains().zip(dem.loads()) {
            let weight = -gravity.y * 2.0 * D2::ball_volume(grain.radius);
            let is_outside = grain.position.y + grain.radius < -1.0 || grain.position.y - grain.radius > 81.0;
            if is_outside {
                assert!(load.force == DVec2::ZERO, "{grain:?}: {load:?}");
                dry += 1;
            } else {
                wet += usize::from(load.force.y > 0.4 * weight);
            }
            // Grains reach the fluid with a speed of 0.1 at most: no step turns what is in their place around more than once.
            let turned = 2.0 * 0.1 * D2::ball_volume(grain.radius);
            assert!(load.force.length() < turned, "{grain:?}: {load:?}");
        }
    }
    let exchanged = tank.grains().exchanged();
    println!("{exchanged:?}, {dry} times dry and {wet} times carried");
    assert!(exchanged.inserted > 20 && exchanged.removed > 5 && dry > 3 && wet > 200);
}
