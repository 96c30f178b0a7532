//! A disk and a sphere on a slope of 45 degrees: rolling, slipping, and the change between them.

use crate::sample::down;
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_dem::{Dem, Grain, Material, Materials, Options, Setup, Wall};

const GRAVITY: f64 = 9.81;
const SLOPE: f64 = std::f64::consts::FRAC_PI_4;
const TIME: f64 = 0.2;
const STEPS: u32 = 25_000;

/// What became of a ball of radius 1 m that was let go.
struct Outcome {
    /// Angle turned \[rad\].
    angle: f64,
    /// Way along the slope \[m\].
    way: f64,
    /// Speed of the contact point along the slope \[m/s\].
    slip: f64,
}

/// Lets a ball go on a slope with this angle of friction \[degrees\].
fn let_go<D: Dim>(friction_angle: f64) -> Outcome {
    let mass = 2650.0 * D::ball_volume(1.0);
    let stiffness = mass * GRAVITY * 1e7;
    let friction = friction_angle.to_radians().tan();
    let mut materials = Materials::new();
    let ball = Material { normal_stiffness: stiffness, friction, ..Material::default() };
    let glass = materials.add(ball).unwrap();
    let up = D::Vec::along(D::UP, 1.0);
    // The slope is level and gravity is turned.
    let gravity = down::<D>(GRAVITY * SLOPE.cos()) + D::Vec::along(0, GRAVITY * SLOPE.sin());
    let overlap = mass * GRAVITY * SLOPE.cos() / stiffness;
    let grain = Grain::at(up * (1.0 - overlap), 1.0, glass);
    let walls = vec![Wall::plane("slope", D::Vec::ZERO, up, glass).unwrap()];
    let options = Options::default();
    let mut dem = Dem::<D>::new(Setup { materials, grains: vec![grain], walls, gravity, options }).unwrap();
    // The spring winds up before the ball slips: the stiffer, the less that delays it.
    let dt = TIME / f64::from(STEPS);
    let (mut angle, mut before) = (0.0, 0.0);
    for _ in 0..STEPS {
        dem.step(dt).unwrap();
        let spin = dem.grain(0).spin.length();
        angle += 0.5 * (before + spin) * dt;
        before = spin;
    }
    let grain = dem.grain(0);
    let slip = (grain.velocity - D::turn(grain.spin, up)).component(0);
    Outcome { angle, way: grain.position.component(0), slip }
}

/// Angle and way by the closed forms, with `kappa` the moment of inertia over `m r^2`.
fn expected<D: Dim>(friction_angle: f64) -> (f64, f64) {
    let kappa = D::BALL_INERTIA;
    let mu = friction_angle.to_radians().tan();
    let (sin, cos) = SLOPE.sin_cos();
    let rolls = mu >= SLOPE.tan() * kappa / (1.0 + kappa);
    let turning = if rolls { GRAVITY * sin / (1.0 + kappa) } else { mu * GRAVITY * cos / kappa };
    let moving = if rolls { turning } else { GRAVITY * (sin - mu * cos) };
    (0.5 * turning * TIME * TIME, 0.5 * moving * TIME * TIME)
}

fn follows_the_closed_form<D: Dim>(threshold: f64) {
    for degrees in (0..=80).step_by(5) {
        let friction_angle = f64::from(degrees);
        let found = let_go::<D>(friction_angle);
        let (angle, way) = expected::<D>(friction_angle);
        if degrees == 0 {
            assert_eq!(found.angle, 0.0);
        } else {
            assert!((found.angle / angle - 1.0).abs() < 1e-3, "{} {degrees}: {}", D::BALL, found.angle);
        }
        assert!((found.way / way - 1.0).abs() < 1e-3, "{} {degrees}: {}", D::BALL, found.way);
        assert_eq!(found.slip > 0.01, friction_angle < threshold, "{} {degrees}: {}", D::BALL, found.slip);
    }
}

/// The friction angle at which slipping ends \[degrees\].
fn kink<D: Dim>() -> f64 {
    let (mut slips, mut rolls) = (10.0, 30.0);
    while rolls - slips > 0.01 {
        let middle = 0.5 * (slips + rolls);
        // 0.5 % of the largest slip there can be.
        let slipping = let_go::<D>(middle).slip > 0.005 * GRAVITY * SLOPE.sin() * TIME;
        *(if slipping { &mut slips } else { &mut rolls }) = middle;
    }
    0.5 * (slips + rolls)
}

#[test]
fn the_reference_numbers_are_those_of_the_closed_form() {
    assert!((expected::<D2>(45.0).0 - 0.092_489_6).abs() < 1e-7);
    for (degrees, angle) in [(5.0, 0.024_275_4), (10.0, 0.048_925_2), (15.0, 0.074_347_5)] {
        assert!((expected::<D2>(degrees).0 - angle).abs() < 1e-7);
    }
}

#[test]
fn a_disk_rolls_or_slips_as_its_friction_says() {
    follows_the_closed_form::<D2>(18.4349);
    let found = kink::<D2>();
    println!("disk: kink at {found:.3} degrees");
    assert!(found > 18.3 && found < 18.6, "{found}");
}

#[test]
fn a_sphere_rolls_or_slips_as_its_friction_says() {
    follows_the_closed_form::<D3>(15.9454);
    let found = kink::<D3>();
    println!("sphere: kink at {found:.3} degrees");
    assert!(found > 15.8 && found < 16.1, "{found}");
}
