//! Particle-steps a second of a column of dry sand in plane strain, 16 particles in a cell, double precision.
//!
//! The column of table 4.3 of \[Kumar2014\]: cells of 2 mm, Mohr-Coulomb with E = 1.98 MPa, nu = 0.23 and an angle of friction of
//! 23.2 degrees, 1925 kg/m³, friction 0.466 at the floor and at the left wall, aspect ratio 1, lateral over vertical stress
//! 1 - sin(phi) at the start, steps of 10 µs. With 160 000 particles it is 0.2 m wide; others have the same cells.
//!
//! As for grains, the share of the bandwidth takes every byte that the solver holds as read once and written once a step.

use super::names::said;
use crate::bench::Printed;
use crate::bench::speed::{Request, Sizes, Speed, Throughput, table};
use crate::bench::triad;
use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver, SymmetricTensor};
use granular_driver::failure::Failure;
use granular_driver::parallel::pool;
use granular_driver::statistics::median;
use granular_mpm::Scheme::{ModifiedStressLast, StressFirst, StressLast};
use granular_mpm::ShapeFunctions::{Linear, QuadraticBspline, UniformGimp};
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};
use std::time::{Duration, Instant};

pub(super) const THROUGHPUT: Throughput = Throughput {
    about: "Material point method",
    sizes: &[
        Sizes {
            flag: "points",
            about: "Numbers of material points in a column, with all shape functions and schemes",
            default: "160000",
            bytes: BYTES,
        },
        Sizes {
            flag: "scaled-points",
            about: "Numbers of material points in columns of all sizes, with one scheme each for two shape functions",
            default: "10000,40000,160000,640000,4000000",
            bytes: BYTES,
        },
    ],
    run: |request| {
        let (speeds, ratios) = mpm(request)?;
        Ok(Printed::new(&speeds, table(&speeds) + &ratios))
    },
};

/// Memory that a particle takes while a column is filled and runs \[bytes\].
const BYTES: f64 = 600.0;
/// Cost per particle-step of any size over that of another that is asked for.
const RATIO: f64 = 1.3;
/// Memory of a particle that is asked for \[bytes\].
const ALLOWED_BYTES: usize = 200;

/// Steps before the clock starts, and least time of a window.
const WARM_UP: u64 = 3;
const WINDOW: Duration = Duration::from_secs(1);
/// Particle-steps between looks at the clock.
const GLANCE: usize = 1_000_000;

const CELL: f64 = 2e-3;
const EDGE: f64 = 0.25 * CELL;
const DENSITY: f64 = 1925.0;
const GRAVITY: f64 = 9.81;
const FRICTION_ANGLE: f64 = 23.2;
const STEP: f64 = 1e-5;

/// A variant under its name in the table.
type Variant = (&'static str, ShapeFunctions, Scheme);

const ALL: [Variant; 9] = [
    ("linear, stress last", Linear, StressLast),
    ("linear, stress first", Linear, StressFirst),
    ("linear, modified stress last", Linear, ModifiedStressLast),
    ("uniform GIMP, stress last", UniformGimp, StressLast),
    ("uniform GIMP, stress first", UniformGimp, StressFirst),
    ("uniform GIMP, modified stress last", UniformGimp, ModifiedStressLast),
    ("quadratic B-spline, stress last", QuadraticBspline, StressLast),
    ("quadratic B-spline, stress first", QuadraticBspline, StressFirst),
    ("quadratic B-spline, modified stress last", QuadraticBspline, ModifiedStressLast),
];
const SCALED: [Variant; 2] = [ALL[0], ALL[5]];

/// Measures all columns that are asked for, and compares those of several sizes.
fn mpm(request: &Request) -> Result<(Vec<Speed>, String), Failure> {
    let mut pools = Vec::new();
    for &threads in &request.threads {
        pools.push((threads, pool(threads)?.install(triad::bandwidth)));
    }
    let mut speeds = Vec::new();
    for (sizes, scene, variants) in [
        (request.sizes("points"), "column", &ALL[..]),
        (request.sizes("scaled-points"), "column, scaled", &SCALED),
    ] {
        for variant in variants {
            for &count in sizes {
                for &pool in &pools {
                    speeds.push(measure(scene, variant, side(count), pool, request.repeats)?);
                }
            }
        }
    }
    let said = sizes_in_words(&speeds) + &memory_in_words(&speeds);
    Ok((speeds, said))
}

/// Particles along an edge of a column of about so many: whole cells.
fn side(count: usize) -> usize {
    4 * ((count as f64).sqrt() / 4.0).round().max(1.0) as usize
}

fn measure(
    scene: &str,
    &(scheme, shape, when): &Variant,
    side: usize,
    (threads, bandwidth): (usize, f64),
    repeats: usize,
) -> Result<Speed, Failure> {
    let options = Options { shape, scheme: when, ..Options::default() };
    let mut mpm = column(side, options).map_err(said)?;
    // Windows of a second see a few milliseconds of the column, in which it hardly moves.
    let rates = pool(threads)?.install(|| {
        mpm.advance(STEP, WARM_UP)?;
        (0..repeats.max(1)).map(|_| window(&mut mpm)).collect::<Result<Vec<f64>, Failure>>()
    })?;
    let (rate, bytes_per_item) = (median(rates), mpm.memory().bytes_per_item);
    Ok(Speed {
        scene: scene.to_owned(),
        scheme,
        n: mpm.len(),
        threads,
        rate,
        unit: "particle-steps/s",
        bytes_per_item,
        bandwidth,
        bandwidth_share: 2.0 * bytes_per_item as f64 * rate / bandwidth,
    })
}

/// Particle-steps a second.
fn window(mpm: &mut Mpm2) -> Result<f64, Failure> {
    let glance = (GLANCE / mpm.len()).max(1) as u64;
    let (begun, mut steps) = (Instant::now(), 0);
    while begun.elapsed() < WINDOW {
        mpm.advance(STEP, glance)?;
        steps += glance;
    }
    Ok(steps as f64 * mpm.len() as f64 / begun.elapsed().as_secs_f64())
}

/// A square column with so many particles along an edge.
fn column(side: usize, options: Options) -> Result<Mpm2, SetupError> {
    let rough = Condition::frictional(0.466);
    let walls = vec![
        Wall::plane("floor", DVec2::ZERO, DVec2::Y, rough)?,
        Wall::plane("left", DVec2::ZERO, DVec2::X, rough)?,
    ];
    let gravity = DVec2::new(0.0, -GRAVITY);
    let mut mpm = Mpm2::new(Setup { gravity, walls, options, ..Setup::new(CELL) })?;
    let height = EDGE * side as f64;
    let mut particles = Particle::<D2>::filling(DVec2::ZERO, DVec2::splat(height), EDGE);
    for particle in &mut particles {
        let vertical = -DENSITY * GRAVITY * (height - particle.position.y);
        let across = vertical * (1.0 - FRICTION_ANGLE.to_radians().sin());
        particle.stress = SymmetricTensor { xx: across, yy: vertical, zz: across, ..SymmetricTensor::ZERO };
    }
    let strength = Strength::of_friction(FRICTION_ANGLE.to_radians());
    let law = MohrCoulomb::new(LinearElastic::new(1.98e6, 0.23)?, strength)?;
    mpm.body(law, DENSITY, &particles)?;
    Ok(mpm)
}

/// Dearest over cheapest particle-step of columns of several sizes, for each variant and number of threads.
fn sizes_in_words(speeds: &[Speed]) -> String {
    let mut text = String::new();
    let scaled: Vec<&Speed> = speeds.iter().filter(|speed| speed.scene.ends_with("scaled")).collect();
    let mut told = Vec::new();
    for speed in &scaled {
        let key = (speed.scheme, speed.threads);
        let alike = scaled.iter().filter(|other| (other.scheme, other.threads) == key);
        let rates: Vec<f64> = alike.map(|other| other.rate).collect();
        if rates.len() < 2 || told.contains(&key) {
            continue;
        }
        told.push(key);
        let (least, most) = rates.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
        let (scheme, threads) = key;
        text += &format!(
            "{scheme}, {threads} threads: a particle-step of the dearest size costs {:.2} of one of the cheapest \
             (asked for: {RATIO})\n",
            most / least
        );
    }
    text
}

fn memory_in_words(speeds: &[Speed]) -> String {
    let most = speeds.iter().map(|speed| speed.bytes_per_item).max();
    most.map_or(String::new(), |most| {
        format!("at most {most} bytes a particle, nodes included (asked for: {ALLOWED_BYTES})\n")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_has_whole_cells_of_sixteen_and_little_memory() {
        assert_eq!([1, 10_000, 160_000, 4_000_000].map(side), [4, 100, 400, 2000]);
        for (_, shape, scheme) in ALL {
            let mut mpm = column(400, Options { shape, scheme, ..Options::default() }).unwrap();
            mpm.advance(STEP, 2).unwrap();
            let bytes = mpm.memory().bytes_per_item;
            assert!(mpm.len() == 160_000 && bytes <= ALLOWED_BYTES, "{bytes} bytes");
        }
    }

    #[test]
    fn sizes_are_compared_within_a_variant_and_a_number_of_threads() {
        let speed = |scheme, threads, n, rate| Speed {
            scene: "column, scaled".to_owned(),
            scheme,
            n,
            threads,
            rate,
            unit: "",
            bytes_per_item: 150 + n,
            bandwidth: 1.0,
            bandwidth_share: 1.0,
        };
        let speeds =
            [speed("a", 1, 1, 1.0), speed("a", 1, 2, 1.5), speed("a", 2, 1, 9.0), speed("b", 1, 1, 7.0)];
        let text = sizes_in_words(&speeds);
        assert!(text.starts_with("a, 1 threads") && text.contains("costs 1.50") && text.lines().count() == 1);
        assert!(memory_in_words(&speeds).starts_with("at most 152 bytes"));
    }
}
