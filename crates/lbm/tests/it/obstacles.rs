//! What obstacles cost when they move, and which make no sense.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{Accepts, D2, Dim, Motion, ObstacleMotion, Section, Solver};
use granular_lbm::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// A disk that counts how often links ask where they cross it.
struct Counting {
    disk: Ball<D2>,
    crossings: Arc<AtomicUsize>,
}

impl SolidShape<D2> for Counting {
    fn contains(&self, point: DVec2) -> bool {
        self.disk.contains(point)
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        self.disk.bounds()
    }

    fn crossing(&self, outside: DVec2, inside: DVec2) -> f64 {
        self.crossings.fetch_add(1, Relaxed);
        self.disk.crossing(outside, inside)
    }
}

/// Two disks over a floor, the first of which touches it.
fn two_disks() -> (Setup<D2>, [Arc<AtomicUsize>; 2]) {
    let mut setup = Setup::new([40, 24, 1], 1e-3, 1e-6, 0.8);
    setup.faces[1] = [Face::REST, Face::REST];
    let crossings = [(); 2].map(|()| Arc::new(AtomicUsize::new(0)));
    for ((name, x, y), crossings) in [("low", 9e-3, 4e-3), ("high", 28e-3, 12e-3)].into_iter().zip(&crossings)
    {
        let disk = Ball { centre: DVec2::new(x, y), radius: 4.3e-3 };
        setup.obstacles.push(Obstacle::new(name, Counting { disk, crossings: crossings.clone() }));
    }
    (setup, crossings)
}

fn lend(lbm: &mut Lbm2, number: usize, motion: Motion<D2>) {
    Accepts::<ObstacleMotion<D2>>::view_mut(lbm)[number] = motion;
}

#[test]
fn another_spin_or_velocity_at_the_same_place_finds_no_link_again() {
    let (mut setup, crossings) = two_disks();
    let speed = setup.lattice_speed();
    let motions: Vec<Motion<D2>> = setup
        .obstacles
        .iter()
        .zip([[0.01, 0.3], [-0.02, -0.5]])
        .map(|(obstacle, [velocity, spin])| Motion {
            velocity: DVec2::new(velocity * speed, 0.0),
            spin,
            ..obstacle.motion()
        })
        .collect();
    let mut lent = Lbm2::new(setup.clone()).unwrap();
    let dt = lent.setup().time_step;
    for (obstacle, motion) in setup.obstacles.iter_mut().zip(&motions) {
        (obstacle.velocity, obstacle.spin) = (motion.velocity, motion.spin);
    }
    let mut given = Lbm2::new(setup).unwrap();
    let before = crossings.each_ref().map(|count| count.load(Relaxed));
    for (number, motion) in motions.iter().enumerate() {
        lend(&mut lent, number, *motion);
    }
    lent.advance(dt, 30).unwrap();
    given.advance(dt, 30).unwrap();
    assert_eq!(crossings.each_ref().map(|count| count.load(Relaxed)), before, "links were found again");
    let saved = [&lent, &given].map(|lbm| {
        let mut section = Section::new("solver");
        lbm.save(&mut section);
        section
    });
    assert!(saved[0] == saved[1], "a motion that is lent is another one than the same motion given");
    assert!(lent.force_on(1).length() > 0.0);
}

#[test]
fn a_body_that_moves_leaves_the_links_of_those_far_away() {
    let (setup, crossings) = two_disks();
    let mut lbm = Lbm2::new(setup).unwrap();
    let (dt, start) = (lbm.setup().time_step, lbm.setup().obstacles[1].motion());
    let before = crossings.each_ref().map(|count| count.load(Relaxed));
    lend(&mut lbm, 1, Motion { position: start.position + DVec2::new(0.4e-3, 0.0), ..start });
    lbm.advance(dt, 1).unwrap();
    let after = crossings.each_ref().map(|count| count.load(Relaxed));
    assert!(after[0] == before[0] && after[1] > before[1], "{before:?} {after:?}");
    // Near each other both have other links.
    lend(&mut lbm, 1, Motion { position: DVec2::new(17.5e-3, 6e-3), ..start });
    lbm.advance(dt, 1).unwrap();
    assert!(crossings[0].load(Relaxed) > before[0]);
}

fn refused<L: Lattice<Q>, const Q: usize>(
    what: &str,
    change: impl FnOnce(&mut Setup<L::Dim>),
    shape: impl SolidShape<L::Dim> + 'static,
) {
    let cells = if L::Dim::N == 3 { [10, 10, 10] } else { [10, 10, 1] };
    let mut setup = Setup::<L::Dim>::new(cells, 1.0, 0.1, 0.8);
    setup.obstacles.push(Obstacle::new("one", shape));
    change(&mut setup);
    let error = Lbm::<L, Q>::new(setup).map(drop).unwrap_err();
    assert_eq!(error.what, what, "{error}");
}

#[test]
fn shapes_that_make_no_sense_are_refused() {
    let ball = |x: f64, radius: f64| Ball::<D2> { centre: DVec2::new(x, 5.0), radius };
    for radius in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        refused::<D2Q9, 9>("radius of obstacle `one`", |_| {}, ball(5.0, radius));
    }
    refused::<D2Q9, 9>("centre of obstacle `one`", |_| {}, ball(f64::NAN, 2.0));
    for count in 0..3 {
        let corners = vec![DVec2::splat(3.0), DVec2::new(6.0, 3.0), DVec2::new(3.0, 6.0)][..count].to_vec();
        refused::<D2Q9, 9>("polygon of obstacle `one`", |_| {}, Polygon { corners });
    }
    let corners = vec![DVec2::splat(3.0), DVec2::new(6.0, f64::NAN), DVec2::new(3.0, 6.0)];
    refused::<D3Q19, 19>("corner of obstacle `one`", |_| {}, Polygon { corners });
    let block = Block::<D2> { low: DVec2::new(3.0, 6.0), high: DVec2::new(5.0, 4.0) };
    refused::<D2Q9, 9>("extent of obstacle `one`", |_| {}, block);
    let block = Block::<D2> { low: DVec2::splat(f64::NAN), high: DVec2::splat(4.0) };
    refused::<D2Q9, 9>("extent of obstacle `one`", |_| {}, block);
    let column = Extruded { shape: ball(5.0, f64::NAN), from: 0.0, to: 5.0 };
    refused::<D3Q19, 19>("radius of obstacle `one`", |_| {}, column);
    let column = Extruded { shape: ball(5.0, 2.0), from: 5.0, to: f64::NAN };
    refused::<D3Q19, 19>("extent of obstacle `one`", |_| {}, column);
}

#[test]
fn motions_names_and_speeds_that_make_no_sense_are_refused() {
    let ball = || Ball { centre: DVec2::splat(5.0), radius: 2.0 };
    let sphere = Ball { centre: DVec3::splat(5.0), radius: 2.0 };
    refused::<D2Q9, 9>("velocity of obstacle `one`", |s| s.obstacles[0].velocity.y = f64::NAN, ball());
    refused::<D2Q9, 9>(
        "displacement of obstacle `one`",
        |s| s.obstacles[0].displacement.x = f64::NAN,
        ball(),
    );
    refused::<D2Q9, 9>("spin of obstacle `one`", |s| s.obstacles[0].spin = f64::INFINITY, ball());
    refused::<D3Q19, 19>("spin of obstacle `one`", |s| s.obstacles[0].spin.z = f64::NAN, sphere);
    let reference = Reference { speed: f64::NAN, length: 1.0 };
    refused::<D2Q9, 9>("reference of obstacle `one`", |s| s.obstacles[0].reference = Some(reference), ball());
    refused::<D2Q9, 9>(
        "name of an obstacle",
        |s| s.obstacles.push(Obstacle::new("one", Ball { centre: DVec2::ZERO, radius: 1.0 })),
        ball(),
    );
    for speed in [f64::NAN, f64::INFINITY, -1.0] {
        refused::<D2Q9, 9>("expected speed", |s| s.expected_speed = speed, ball());
    }
    let gauge = |x: f64| Gauge { name: "a".to_owned(), place: DVec2::new(x, 1.0) };
    refused::<D2Q9, 9>("name of a gauge", |s| s.gauges = vec![gauge(1.0), gauge(2.0)], ball());
    refused::<D2Q9, 9>("place of gauge `a`", |s| s.gauges = vec![gauge(f64::NAN)], ball());
}

#[test]
fn an_acceleration_that_is_not_finite_is_refused_and_the_one_before_stays() {
    let mut setup = Setup::<D2>::new([10, 10, 1], 1.0, 0.1, 0.8);
    setup.acceleration = DVec2::new(1e-6, 0.0);
    let mut lbm = Lbm2::new(setup).unwrap();
    let error = lbm.set_acceleration(DVec2::new(f64::NAN, 0.0)).unwrap_err();
    assert_eq!(error.what, "acceleration");
    assert_eq!(lbm.setup().acceleration, DVec2::new(1e-6, 0.0));
    lbm.advance(lbm.setup().time_step, 4).unwrap();
}

#[test]
#[should_panic(expected = "there is no obstacle 2 among 2, counted from 0")]
fn the_force_on_an_obstacle_that_is_not_there_panics_with_the_number() {
    let _ = Lbm2::new(two_disks().0).unwrap().force_on(2);
}
