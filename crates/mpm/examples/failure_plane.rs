//! The plane along which a sample of soil fails when it is compressed in plane strain between elastic caps: Coulomb's is at 45 degrees and half
//! of the friction angle from the plates.
//!
//! `cargo run --release -p granular-mpm --example failure_plane -- [friction angle] [dilation angle] [cells across]`

use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Solver, SymmetricTensor};
use granular_mpm::{Condition, Mpm2, Options, Particle, Setup, Wall, WallMotion};

const WIDTH: f64 = 1.0;
/// Height with elastic caps at both ends.
const HEIGHT: f64 = 3.2;
const CAP: f64 = 0.3;
const DENSITY: f64 = 2000.0;
const COHESION: f64 = 20e3;
/// Speed of the upper plate \[m/s\].
const SPEED: f64 = 0.05;

/// A sample with a weak spot at its side.
fn sample(friction: f64, dilation: f64, across: usize) -> Mpm2 {
    let cell = WIDTH / across as f64;
    let floor = Wall::plane("floor", DVec2::ZERO, DVec2::Y, Condition::Slip).expect("a plane");
    let plate = Wall::plane("plate", DVec2::new(0.0, HEIGHT), -DVec2::Y, Condition::Slip).expect("a plane");
    let plate = plate.moving(WallMotion::Steady { velocity: DVec2::new(0.0, -SPEED) });
    let options = Options { local_damping: 0.05, ..Options::default() };
    let setup = Setup { walls: vec![floor, plate], options, ..Setup::new(cell) };
    let mut mpm = Mpm2::new(setup).expect("values in range");
    let law = |cohesion: f64| {
        let elastic = LinearElastic::new(10e6, 0.3).expect("moduli in range");
        let strength = Strength { cohesion, dilation_angle: dilation, ..Strength::of_friction(friction) };
        MohrCoulomb::new(elastic, strength).expect("a strength in range")
    };
    let weak = |at: DVec2| (at - DVec2::new(0.0, 0.6)).abs().max_element() < 0.06;
    let edge = 0.5 * cell;
    let in_cap = |at: DVec2| !(CAP..HEIGHT - CAP).contains(&at.y);
    let fill = |inside: &dyn Fn(DVec2) -> bool| {
        Particle::filling_part(DVec2::ZERO, DVec2::new(WIDTH, HEIGHT), edge, inside)
    };
    let soil = fill(&|at| !in_cap(at) && !weak(at));
    mpm.body(law(COHESION), DENSITY, &soil).expect("particles in range");
    mpm.body(law(0.7 * COHESION), DENSITY, &fill(&weak)).expect("particles in range");
    let caps = LinearElastic::new(40e6, 0.3).expect("moduli in range");
    mpm.body(caps, DENSITY, &fill(&in_cap)).expect("particles in range");
    mpm
}

/// Greatest rates of shear of particles, in the order of memory.
#[derive(Default)]
struct Rates(Vec<f64>);

impl FieldSink for Rates {
    fn wants(&self, name: &str) -> bool {
        name == "strain_rate"
    }

    fn number(&mut self, _: &str, _: &str, _: f64) {}

    fn field(&mut self, _: &str, _: &str, field: FieldRef<'_>) {
        let FieldRef::Tensor(rates) = field else { return };
        let shear = |rate: &SymmetricTensor| (0.5 * (rate.xx - rate.yy)).hypot(rate.xy);
        self.0 = rates.iter().map(shear).collect();
    }
}

/// Adds up rates of shear by identifier.
fn add_rates(mpm: &Mpm2, sums: &mut [f64]) {
    let mut rates = Rates::default();
    mpm.show(&mut rates);
    for ((id, _), rate) in mpm.particles().zip(rates.0) {
        sums[id as usize] += rate;
    }
}

/// Angle from the plates of the strip, three cells wide and through the whole sample, in which particles shear most \[degrees\], and how
/// many times the mean of the sample they shear there.
fn band(mpm: &Mpm2, sums: &[f64]) -> (f64, f64) {
    let soil: Vec<(f64, DVec2)> = mpm
        .particles()
        .map(|(id, particle)| (sums[id as usize], particle.position))
        .filter(|(shear, at)| *shear > 0.0 && (CAP..HEIGHT - CAP).contains(&at.y))
        .collect();
    let width = 3.0 * mpm.cell();
    let total: f64 = soil.iter().map(|(shear, _)| shear).sum();
    let mut best = (0.0, 0.0);
    for half_degrees in 60..160 {
        for side in [1.0, -1.0] {
            let angle = 0.5 * f64::from(half_degrees);
            let across = DVec2::from_angle(angle.to_radians()).perp() * DVec2::new(side, 1.0);
            let mut strips = vec![(0.0, 0.0); 400];
            for (shear, at) in &soil {
                let place = (2.0 * (across.dot(*at) + 4.0 * HEIGHT) / width) as usize;
                // Strips overlap by half.
                for strip in [place, place + 1] {
                    if let Some((sum, count)) = strips.get_mut(strip) {
                        (*sum, *count) = (*sum + shear, *count + 1.0);
                    }
                }
            }
            // Of strips that cross from side to side, the one with the highest mean: the longest would have the highest sum.
            let whole = 0.9 * WIDTH / angle.to_radians().cos() * width * soil.len() as f64
                / (WIDTH * (HEIGHT - 2.0 * CAP));
            let mean = |&(sum, count): &(f64, f64)| if count > whole { sum / count } else { 0.0 };
            let most = strips.iter().map(mean).fold(0.0, f64::max) * soil.len() as f64 / total;
            if most > best.1 {
                best = (angle, most);
            }
        }
    }
    best
}

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse::<f64>().ok());
    let friction = numbers.next().unwrap_or(30.0);
    let dilation = numbers.next().unwrap_or(friction);
    let across = numbers.next().unwrap_or(20.0) as usize;
    let mut mpm = sample(friction.to_radians(), dilation.to_radians(), across);
    let mut sums = vec![0.0; mpm.len()];
    println!("axial strain, angle of the band, expected, shear in it over the mean");
    for percent in 1..=6 {
        sums.fill(0.0);
        for _ in 0..50 {
            let dt = mpm.recommended_step();
            mpm.advance(dt, (2e-4 * HEIGHT / SPEED / dt).ceil() as u64).expect("a stable step");
            add_rates(&mpm, &mut sums);
        }
        let (angle, share) = band(&mpm, &sums);
        println!("{percent} %: {angle:.1} degrees, {:.1}, {share:.2}", 45.0 + 0.5 * friction);
    }
}
