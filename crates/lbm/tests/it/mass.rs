//! Walls of obstacles let no mass through, however they are met and move.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{Accepts, D2, D3, Motion, ObstacleMotion, Solver};
use granular_lbm::*;
use std::f64::consts::PI;

const SCHEMES: [WallScheme; 3] = [WallScheme::HalfWay, WallScheme::Bouzidi, WallScheme::Yu];

/// All that lies outside of a circle.
struct Around(Ball<D2>);

impl SolidShape<D2> for Around {
    fn contains(&self, point: DVec2) -> bool {
        (point - self.0.centre).length() >= self.0.radius
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        (self.0.centre - DVec2::splat(1.1 * self.0.radius), self.0.centre + DVec2::splat(1.1 * self.0.radius))
    }

    fn centre(&self) -> DVec2 {
        self.0.centre
    }
}

/// A shaft that turns in a sleeve at rest, in units of cells and steps.
fn annulus(scheme: WallScheme, radius: f64, speed: f64, viscosity: f64) -> Lbm2 {
    let side = (4.0 * radius) as usize + 6;
    let mut setup = Setup::new([side, side, 1], 1.0, viscosity, 0.5 + 3.0 * viscosity);
    setup.time_step = 1.0;
    setup.density = 1.0;
    setup.faces = std::array::from_fn(|axis| {
        if axis < 2 { [Face::REST, Face::REST] } else { [Face::Periodic, Face::Periodic] }
    });
    let centre = DVec2::splat(0.5 * side as f64) + DVec2::new(0.13, 0.27);
    setup.obstacles.push(Obstacle::new("shaft", Ball { centre, radius }));
    setup.obstacles.push(Obstacle::new("sleeve", Around(Ball { centre, radius: 2.0 * radius })));
    setup.obstacles[0].spin = speed / radius;
    setup.obstacles.iter_mut().for_each(|obstacle| obstacle.wall = scheme);
    Lbm2::new(setup).unwrap()
}

/// Gain of mass as a share of all, and the torques on shaft and sleeve over those of a viscous fluid.
fn found(scheme: WallScheme, radius: f64, speed: f64, viscosity: f64, steps: u64) -> [f64; 3] {
    let mut lbm = annulus(scheme, radius, speed, viscosity);
    lbm.advance(1.0, steps).unwrap();
    let cells = 3.0 * PI * radius * radius;
    let (rate, square) = (speed / radius, radius * radius);
    let torque = 4.0 * PI * viscosity * rate * square * 4.0 / 3.0;
    [lbm.excess() / cells, -lbm.torque_on(0) / torque, lbm.torque_on(1) / torque]
}

#[test]
fn a_shaft_that_turns_in_a_sleeve_keeps_the_mass_of_the_fluid_and_has_the_torque_of_second_order() {
    for scheme in SCHEMES {
        let [coarse, fine] = [(8.0, 7_000), (16.0, 28_000)].map(|(radius, steps)| {
            let found = found(scheme, radius, 0.05, 0.1, steps);
            let [mass, shaft, sleeve] = found;
            println!(
                "{scheme:?} {radius}: mass {mass:.2e}, torques off by {:.2e}, {:.2e}",
                shaft - 1.0,
                sleeve - 1.0
            );
            assert!(mass.abs() < 1e-5, "{scheme:?} {radius}: {mass}");
            found
        });
        if scheme != WallScheme::HalfWay {
            // What the shaft gives the sleeve takes.
            assert!((fine[1] - fine[2]).abs() < 1e-5, "{scheme:?}: {fine:?}");
            let order = ((coarse[1] - 1.0) / (fine[1] - 1.0)).log2();
            assert!(order > 2.0 && (fine[1] - 1.0).abs() < 2e-3, "{scheme:?}: order {order}, {fine:?}");
        }
    }
}

/// A closed box under a lid, with a disk.
fn cavity(scheme: WallScheme, centre: DVec2) -> Lbm2 {
    let mut setup = Setup::new([40, 40, 1], 1.0, 0.02, 0.56);
    setup.time_step = 1.0;
    setup.density = 1.0;
    setup.faces[0] = [Face::REST, Face::REST];
    setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(0.1, 0.0))];
    setup.obstacles.push(Obstacle::new("disk", Ball { centre, radius: 7.3 }));
    setup.obstacles[0].wall = scheme;
    Lbm2::new(setup).unwrap()
}

#[test]
fn a_driven_cavity_with_a_disk_keeps_mass_and_reaches_a_force_for_good() {
    for scheme in SCHEMES {
        // In the middle, and resting on the floor.
        for centre in [DVec2::new(19.6, 20.3), DVec2::new(17.2, 7.3)] {
            let mut lbm = cavity(scheme, centre);
            lbm.advance(1.0, 50_000).unwrap();
            let before = lbm.force_on(0);
            lbm.advance(1.0, 50_000).unwrap();
            let (mass, force) = (lbm.excess() / 1433.0, lbm.force_on(0));
            let change = (force - before).length() / force.length();
            println!("{scheme:?} {centre}: mass {mass:.2e}, change of force {change:.2e}");
            assert!(mass.abs() < 1e-5 && change < 1e-6, "{scheme:?} {centre}: {mass} {change}");
        }
    }
}

/// What a body covers and uncovers changes the number of cells by a few, their mean density not at all.
#[test]
fn a_disk_that_goes_to_and_fro_in_a_closed_box_keeps_the_mean_density() {
    for scheme in SCHEMES {
        let mut setup = cavity(scheme, DVec2::new(20.0, 19.7)).setup().clone();
        setup.faces[1] = [Face::REST, Face::REST];
        setup.obstacles[0].shape = std::sync::Arc::new(Ball { centre: DVec2::new(20.0, 19.7), radius: 5.3 });
        let mut lbm = Lbm2::new(setup).unwrap();
        let mut largest = 0.0_f64;
        for step in 0..20_000 {
            let angle = 2.0 * PI * (f64::from(step) + 0.5) / 1000.0;
            let (place, velocity) = (DVec2::new(9.0, 4.0) * angle.sin(), DVec2::new(9.0, 4.0) * angle.cos());
            let position = DVec2::new(20.0, 19.7) + place;
            let motion = Motion::new(position, velocity * (2.0 * PI / 1000.0), 0.003);
            Accepts::<ObstacleMotion<D2>>::view_mut(&mut lbm)[0] = motion;
            lbm.advance(1.0, 1).unwrap();
            largest = largest.max(lbm.excess().abs() / 1512.0);
        }
        let last = lbm.excess().abs() / 1512.0;
        println!("{scheme:?}: largest {largest:.2e}, last {last:.2e}");
        assert!(largest < 3e-4 && last < 2e-5, "{scheme:?}: {largest} {last}");
    }
}

#[test]
fn a_sphere_that_turns_in_a_box_keeps_the_mass_of_the_fluid() {
    for scheme in SCHEMES {
        let mut setup = Setup::<D3>::new([16, 16, 16], 1.0, 0.1, 0.8);
        setup.time_step = 1.0;
        setup.faces = std::array::from_fn(|_| [Face::REST, Face::REST]);
        let ball = Ball { centre: DVec3::new(8.1, 7.8, 5.2), radius: 5.2 };
        setup.obstacles.push(Obstacle::new("sphere", ball));
        (setup.obstacles[0].wall, setup.obstacles[0].spin) = (scheme, DVec3::new(0.01, -0.004, 0.006));
        let mut lbm = Lbm3::new(setup).unwrap();
        lbm.advance(1.0, 4000).unwrap();
        let mass = lbm.excess() / 3500.0;
        println!("{scheme:?}: mass {mass:.2e}");
        assert!(mass.abs() < 1e-5, "{scheme:?}: {mass}");
    }
}

/// Disks that touch and move with the fluid as one disturb nothing, though the surface of neither is closed.
#[test]
fn disks_that_touch_and_move_with_a_stream_disturb_nothing() {
    let velocity = DVec2::new(0.0625, 0.03125);
    for scheme in SCHEMES {
        let mut setup = Setup::<D2>::new([30, 20, 1], 1.0, 0.1, 0.8);
        setup.time_step = 1.0;
        setup.density = 1.0;
        let centres = [DVec2::new(9.3, 9.1), DVec2::new(17.0, 10.4)];
        for (name, centre) in ["one", "two"].into_iter().zip(centres) {
            setup.obstacles.push(Obstacle::new(name, Ball { centre, radius: 4.1 }));
        }
        setup.obstacles.iter_mut().for_each(|disk| (disk.wall, disk.velocity) = (scheme, velocity));
        let mut lbm = Lbm2::new(setup).unwrap();
        lbm.set_flow(|_| Flow { pressure: 0.0, velocity });
        for step in 0..60 {
            for (k, centre) in centres.into_iter().enumerate() {
                let position = centre + velocity * (f64::from(step) + 0.5);
                Accepts::<ObstacleMotion<D2>>::view_mut(&mut lbm)[k] = Motion::new(position, velocity, 0.0);
            }
            lbm.advance(1.0, 1).unwrap();
        }
        for (x, y) in (0..30).flat_map(|x| (0..20).map(move |y| (x, y))) {
            let Some(flow) = lbm.flow([x, y, 0]) else { continue };
            assert!((flow.velocity - velocity).length() < 1e-13, "{scheme:?} {x} {y}: {:?}", flow.velocity);
        }
    }
}

/// A body that enters through a wall drives out what it sweeps.
#[test]
fn a_piston_drives_out_what_it_sweeps() {
    for scheme in SCHEMES {
        let speed = 0.005;
        let mut setup = Setup::<D2>::new([60, 6, 1], 1.0, 0.1, 0.8);
        setup.time_step = 1.0;
        setup.density = 1.0;
        setup.faces[0] = [Face::REST, Face::absorbing(0.0)];
        let (low, high) = (DVec2::new(-40.0, -9.0), DVec2::new(4.3, 15.0));
        setup.obstacles.push(Obstacle::new("piston", Block { low, high }));
        (setup.obstacles[0].wall, setup.obstacles[0].velocity.x) = (scheme, speed);
        let start = setup.obstacles[0].motion();
        let mut lbm = Lbm2::new(setup).unwrap();
        lbm.set_flow(|_| Flow { pressure: 0.0, velocity: start.velocity });
        let mut mean = 0.0;
        for step in 0..4000 {
            let position = start.position + start.velocity * (f64::from(step) + 0.5);
            Accepts::<ObstacleMotion<D2>>::view_mut(&mut lbm)[0] = Motion { position, ..start };
            lbm.advance(1.0, 1).unwrap();
            mean += lbm.flow([50, 3, 0]).unwrap().velocity.x / 4000.0;
        }
        println!("{scheme:?}: {:.4} of the speed of the piston", mean / speed);
        assert!((mean / speed - 1.0).abs() < 0.02, "{scheme:?}: {mean} where {speed} is right");
    }
}
