//! Free grains in a fluid, against closed forms.

use crate::tank::{Balls, Tank, unit_fluid};
use granular_core::glam::DVec2;
use granular_core::{D2, Dim};
use granular_coupling::{HeldLoad, ResolvedOptions};
use granular_lbm::{D2Q9, Face};
use std::f64::consts::PI;

type Plane = Tank<D2Q9, 9>;

/// Drag per length on a disk half-way between walls `k` diameters apart, over viscosity and speed \[Faxen1946\].
fn drag_between_walls(k: f64) -> f64 {
    let series = 1.7244 * k.powi(-2) - 1.7302 * k.powi(-4) + 2.4056 * k.powi(-6) - 4.5913 * k.powi(-8);
    4.0 * PI / (k.ln() - 0.9157 + series)
}

/// In a closed tank, far from its ends.
#[test]
fn a_disk_settles_at_the_speed_of_faxen() {
    let (width, diameter, tau, density) = (60.0, 12.0, 1.0, 1.5);
    let mut setup = unit_fluid::<D2>([60, 240, 1], tau);
    for axis in 0..2 {
        setup.faces[axis] = [Face::REST, Face::REST];
    }
    let (viscosity, volume) = (setup.viscosity, D2::ball_volume(0.5 * diameter));
    let expected = 0.05 * viscosity / diameter;
    let weight = drag_between_walls(width / diameter) * viscosity * expected;
    let gravity = DVec2::new(0.0, -weight / ((density - 1.0) * volume));
    let balls = vec![(DVec2::new(30.0, 122.3), DVec2::ZERO, 0.5 * diameter)];
    let balls = Balls { gravity, ..Balls::<D2>::of(density, balls) };
    let mut tank = Plane::new(
        setup,
        |_| DVec2::ZERO,
        &balls,
        ResolvedOptions { gravity: Some(gravity), ..Default::default() },
    );
    tank.advance(9000);
    let before = tank.velocity(0);
    tank.advance(1000);
    let speed = tank.velocity(0);
    println!(
        "settles at {:.4} of the speed of Faxen, changed by {:.1e}",
        -speed.y / expected,
        speed.y / before.y - 1.0
    );
    assert!((-speed.y / expected - 1.0).abs() < 0.03, "{speed} against {expected}");
    assert!((speed.y / before.y - 1.0).abs() < 2e-3 && speed.x.abs() < 1e-3 * expected);
}

/// A disk in a shear flow turns at half of its rate.
#[test]
fn a_free_disk_turns_with_a_shear_flow() {
    let (height, length, radius, wall) = (60.0, 80.0, 6.0, 0.01);
    let mut setup = unit_fluid::<D2>([80, 60, 1], 0.9);
    setup.faces[1] = [Face::Wall(DVec2::new(-wall, 0.0)), Face::Wall(DVec2::new(wall, 0.0))];
    let rate = 2.0 * wall / height;
    let balls = Balls::<D2>::of(1.01, vec![(DVec2::new(0.5 * length, 0.5 * height), DVec2::ZERO, radius)]);
    let flow = |p: DVec2| DVec2::new(rate * (p.y - 0.5 * height), 0.0);
    let mut tank = Plane::new(setup, flow, &balls, ResolvedOptions::default());
    tank.advance(3000);
    let spin = tank.grains().grain(0).spin;
    println!("turns at {:.4} of half of the rate, drifts at {}", -2.0 * spin / rate, tank.velocity(0));
    assert!((-2.0 * spin / rate - 1.0).abs() < 0.05, "{spin} of {rate}");
    assert!(tank.velocity(0).length() < 1e-6 * wall);
}

/// Grains as light as the fluid, and lighter, that are thrown into it come to rest.
#[test]
fn grains_as_light_as_the_fluid_are_stable() {
    for (density, radius, tau, held) in [
        (1.01, 5.0, 0.55, HeldLoad::OneStep),
        (1.0, 4.0, 0.6, HeldLoad::OneStep),
        (0.6, 5.0, 0.8, HeldLoad::OneStep),
        (1.01, 3.0, 1.0, HeldLoad::TwoSteps),
    ] {
        let mut setup = unit_fluid::<D2>([48, 40, 1], tau);
        setup.faces[1] = [Face::REST, Face::REST];
        let balls = Balls::<D2>::of(density, vec![(DVec2::new(24.2, 20.3), DVec2::new(0.05, 0.01), radius)]);
        let options = ResolvedOptions { held, ..ResolvedOptions::default() };
        let mut tank = Plane::new(setup, |_| DVec2::ZERO, &balls, options);
        let mut speeds = Vec::new();
        for _ in 0..30 {
            tank.advance(100);
            speeds.push(tank.velocity(0).length());
        }
        println!("{density} {radius} {tau} {held:?}: {:.2e} {:.2e}", speeds[0], speeds[29]);
        assert!(speeds.iter().all(|speed| *speed < 0.05) && speeds[29] < 0.01, "{speeds:?}");
    }
}
