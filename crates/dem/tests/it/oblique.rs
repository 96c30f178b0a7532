//! One ball and a floor: oblique impact, sliding to rolling, bouncing.

use crate::sample::down;
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_dem::{Dem, Grain, Material, Materials, Options, Setup, Wall};

/// A ball above a floor. Velocity along the floor and towards it, and the spin of rolling
/// forwards, in m/s and rad/s.
struct Throw {
    radius: f64,
    /// Frequency of the contact \[1/s\].
    frequency: f64,
    height: f64,
    along: f64,
    towards: f64,
    rolling: f64,
    gravity: f64,
}

impl Throw {
    fn dem<D: Dim>(&self, material: Material) -> Dem<D> {
        let mass = material.density * D::ball_volume(self.radius);
        let mut materials = Materials::new();
        let normal_stiffness = mass * self.frequency.powi(2);
        let glass = materials.add(Material { normal_stiffness, ..material }).unwrap();
        let (forwards, up) = (D::Vec::along(0, 1.0), D::Vec::along(D::UP, 1.0));
        let mut grain = Grain::at(up * (self.radius + self.height), self.radius, glass)
            .moving(forwards * self.along - up * self.towards);
        if material.friction > 0.0 {
            grain = grain.turning(D::cross(up, forwards) * self.rolling);
        }
        let walls = vec![Wall::plane("floor", D::Vec::ZERO, up, glass).unwrap()];
        let (gravity, options) = (down::<D>(self.gravity), Options::default());
        Dem::new(Setup { materials, grains: vec![grain], walls, gravity, options }).unwrap()
    }
}

/// Velocities along the floor and upwards \[m/s\], and the spin of rolling forwards \[rad/s\].
fn motion<D: Dim>(dem: &Dem<D>) -> (f64, f64, f64) {
    let grain = dem.grain(0);
    let rolling = D::turn(grain.spin, D::Vec::along(D::UP, 1.0)).component(0);
    (grain.velocity.component(0), grain.velocity.component(D::UP), rolling)
}

/// An impact without gravity; returns [`motion`] after it.
fn impact<D: Dim>(material: Material, along: f64, rolling: f64) -> (f64, f64, f64) {
    let frequency = 1e5;
    let dt = 0.01 / frequency;
    let throw =
        Throw { radius: 1.0, frequency, height: 2.3 * dt, along, towards: 1.0, rolling, gravity: 0.0 };
    let mut dem = throw.dem::<D>(material);
    dem.advance(dt, 500).unwrap();
    let mut contacts = 0;
    dem.visit_contacts(&mut |_| contacts += 1);
    assert_eq!(contacts, 0, "the ball is still in touch");
    motion(&dem)
}

fn gross_sliding<D: Dim>() {
    let kappa = D::BALL_INERTIA;
    for e in [1.0, 0.8, 0.5] {
        for (mu, along, rolling) in [(0.2, 10.0, 1.5), (0.1, -3.0, 2.0), (0.4, 0.0, 20.0), (0.3, 5.0, -30.0)]
        {
            let material = Material { restitution: e, friction: mu, ..Material::default() };
            let (x, y, w) = impact::<D>(material, along, rolling);
            let slip: f64 = along - rolling;
            assert!(slip.abs() > (1.0 + 1.0 / kappa) * mu * (1.0 + e), "the case slides throughout");
            let push = slip.signum() * mu * (1.0 + e);
            let close = |found: f64, expected: f64| (found - expected).abs() < 3e-4 * (1.0 + expected.abs());
            assert!(close(y, e), "{} {y}", D::BALL);
            assert!(close(x, along - push), "{} e {e} mu {mu}: {x}", D::BALL);
            assert!(close(w, rolling + push / kappa), "{} e {e} mu {mu}: {w}", D::BALL);
        }
    }
}

#[test]
fn an_impact_that_slides_throughout_follows_the_closed_form() {
    gross_sliding::<D2>();
    gross_sliding::<D3>();
}

#[test]
fn an_impact_that_sticks_turns_the_contact_point_around() {
    fn reversal<D: Dim>(stiffness_ratio: f64) {
        let material = Material {
            restitution: 1.0,
            damping_ratio: 0.0,
            friction: 10.0,
            stiffness_ratio,
            ..Material::default()
        };
        for (along, rolling) in [(1.0, 0.0), (0.5, -2.0), (-2.0, 1.0)] {
            let (x, y, w) = impact::<D>(material, along, rolling);
            let (before, after) = (along - rolling, x - w);
            assert!((after / before + 1.0).abs() < 1e-3, "{} {before} {after}", D::BALL);
            let energy = |x: f64, y: f64, w: f64| x * x + y * y + D::BALL_INERTIA * w * w;
            let ratio = energy(x, y, w) / energy(along, 1.0, rolling);
            assert!((ratio - 1.0).abs() < 1e-3, "{} {ratio}", D::BALL);
            // Angular momentum about the contact point does not change.
            let about = |x: f64, w: f64| x + D::BALL_INERTIA * w;
            assert!((about(x, w) - about(along, rolling)).abs() < 1e-4);
        }
    }
    // Tangential and normal half periods agree: (1 + 1/kappa) k_t = k_n.
    reversal::<D2>(1.0 / 3.0);
    reversal::<D3>(2.0 / 7.0);
}

#[test]
fn a_sliding_ball_comes_to_roll() {
    fn slide<D: Dim>() {
        let (speed, mu, gravity) = (1.0, 0.3, 9.81);
        let kappa = D::BALL_INERTIA;
        let frequency = 1e4;
        let overlap = gravity / (frequency * frequency);
        let throw = Throw {
            radius: 0.1,
            frequency,
            height: -overlap,
            along: speed,
            towards: 0.0,
            rolling: 0.0,
            gravity,
        };
        let mut dem = throw.dem::<D>(Material { friction: mu, ..Material::default() });
        let time = speed * kappa / (1.0 + kappa) / (mu * gravity);
        let dt = time / 20_000.0;
        dem.advance(dt, 10_000).unwrap();
        let (x, _, w) = motion(&dem);
        assert!((x - (speed - 0.5 * mu * gravity * time)).abs() < 1e-3, "{} {x}", D::BALL);
        assert!((w * 0.1 * kappa - 0.5 * mu * gravity * time).abs() < 1e-3, "{} {w}", D::BALL);
        dem.advance(dt, 9_800).unwrap();
        let (x, _, w) = motion(&dem);
        assert!(x - 0.1 * w > 0.005, "{} still slides", D::BALL);
        dem.advance(dt, 1_000).unwrap();
        let (x, _, w) = motion(&dem);
        assert!((x - speed / (1.0 + kappa)).abs() < 1e-3 && (x - 0.1 * w).abs() < 2e-3, "{} {x}", D::BALL);
        let way = dem.grain(0).position.component(0);
        let sliding = 0.5 * (speed + speed / (1.0 + kappa)) * time;
        let expected = sliding + 0.04 * time * speed / (1.0 + kappa);
        assert!((way / expected - 1.0).abs() < 1e-3, "{} {way} {expected}", D::BALL);
    }
    slide::<D2>();
    slide::<D3>();
}

#[test]
fn a_bouncing_ball_rises_to_less_each_time() {
    fn bounce<D: Dim>(e: f64) {
        let (height, gravity) = (0.1, 9.81);
        let frequency = 1e5;
        let throw =
            Throw { radius: 1e-3, frequency, height, along: 0.0, towards: 0.0, rolling: 0.0, gravity };
        let mut dem = throw.dem::<D>(Material { restitution: e, friction: 0.0, ..Material::default() });
        let dt = 0.02 / frequency;
        let (mut tops, mut times) = (Vec::new(), Vec::new());
        let mut steps = 0_u64;
        let mut rising = false;
        while tops.len() < 4 {
            // The top of a flight is flat: it need not be looked for at every step.
            dem.advance(dt, 200).unwrap();
            steps += 200;
            let (_, speed, _) = motion(&dem);
            if rising && speed <= 0.0 {
                let above = dem.grain(0).position.component(D::UP) - 1e-3;
                tops.push(above + speed * speed / (2.0 * gravity));
                times.push(steps as f64 * dt + speed / gravity);
            }
            rising = speed > 0.0;
        }
        let fall = (2.0 * height / gravity).sqrt();
        let mut time = fall;
        for (n, (&top, &at)) in tops.iter().zip(&times).enumerate() {
            let up = e.powi(n as i32 + 1);
            time += up * fall;
            // The weight during a contact, against the fall, takes a share that grows with each.
            assert!((top / (height * up * up) - 1.0).abs() < 3e-3, "{} e {e} bounce {n}: {top}", D::BALL);
            assert!((at / time - 1.0).abs() < 2e-3, "{} e {e} bounce {n}: {at} {time}", D::BALL);
            time += up * fall;
        }
    }
    bounce::<D2>(0.8);
    bounce::<D3>(0.6);
}
