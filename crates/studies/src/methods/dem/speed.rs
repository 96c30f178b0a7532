//! Grain-steps a second of the discrete element method on two scenes: a collapsing column of
//! disks, and spheres that settle in a box.
//!
//! The disks are of 0.92 to 1.38 mm, spread evenly by number, density 2650 kg/m³, normal and tangential
//! stiffness 1.6e6 N/m, friction 0.53 everywhere, restitution 0.75, no tangential damping, a floor
//! and a left wall; the step is 1/50 of the contact time of the mean pair. Up to 20 000 disks are
//! timed in flight, half of `sqrt(H/g)` after the gate of an aspect ratio of 0.8 has opened; more
//! have just been let go.
//!
//! The share of the bandwidth is an estimate from above: it takes every byte that the solver
//! holds for a grain as read once and written once a step, against a triad that the same threads
//! run. Small samples stay in the caches, where the share says nothing.

mod settling;
mod state;

use crate::bench::Printed;
use crate::bench::speed::{Request, Sizes, Speed, Throughput, table};
use crate::bench::triad;
use granular_core::{D2, D3, Dim, Solver};
use granular_dem::Dem;
use granular_driver::failure::Failure;
use granular_driver::parallel::pool;
use granular_driver::statistics::median;
use state::Ball;
use std::time::{Duration, Instant};

pub(super) const THROUGHPUT: Throughput = Throughput {
    about: "Discrete element method",
    sizes: &[
        Sizes {
            flag: "disks",
            about: "Numbers of disks in a collapsing column",
            default: "3000,13000,100000",
            bytes: 700.0,
        },
        Sizes {
            flag: "spheres",
            about: "Numbers of spheres that settle in a box",
            default: "50000",
            bytes: 1100.0,
        },
    ],
    run: |request| {
        let speeds = dem(request)?;
        Ok(Printed::new(&speeds, table(&speeds)))
    },
};

/// Steps before the clock starts.
const WARM_UP: u64 = 200;
/// A timed window lasts at least this long.
const WINDOW: Duration = Duration::from_secs(1);
/// Grain-steps between looks at the clock.
const GLANCE: usize = 1_000_000;

const LINEAR: &str = "leapfrog, linear with friction, tension cut";
const HERTZ: &str = "leapfrog, Hertz-Mindlin, tension cut";

/// Makes a simulation of a state.
type Start<D> = fn(&[Ball<D>]) -> Result<Dem<D>, Failure>;

/// A scene to measure on.
struct Scene<D: Dim> {
    name: String,
    /// Law and scheme.
    scheme: &'static str,
    /// A simulation of a state, ready to be timed.
    simulation: Start<D>,
    /// Step \[s\].
    dt: f64,
}

impl Scene<D2> {
    fn column(name: impl Into<String>) -> Self {
        Self { name: name.into(), scheme: LINEAR, simulation: state::simulation, dt: state::DT }
    }
}

impl Scene<D3> {
    /// One scene for each law.
    fn settling(name: &str) -> [Self; 2] {
        let scene = |scheme, simulation: Start<D3>| Self {
            name: name.into(),
            scheme,
            simulation,
            dt: settling::step(),
        };
        [scene(LINEAR, settling::linear), scene(HERTZ, settling::hertz)]
    }
}

/// Measures all scenes that are asked for.
fn dem(request: &Request) -> Result<Vec<Speed>, Failure> {
    let mut pools = Vec::new();
    for &threads in &request.threads {
        pools.push((threads, pool(threads)?.install(triad::bandwidth)));
    }
    let mut speeds = Vec::new();
    if let Some(path) = &request.state {
        let name = path.display().to_string();
        if state::holds_spheres(path)? {
            let spheres = state::read(path)?;
            for scene in Scene::settling(&name) {
                measure(&scene, &spheres, &pools, request, &mut speeds)?;
            }
        } else {
            measure(&Scene::column(name), &state::read(path)?, &pools, request, &mut speeds)?;
        }
        return Ok(speeds);
    }
    for &count in request.sizes("disks") {
        measure(&Scene::column("column collapse"), &state::falling(count)?, &pools, request, &mut speeds)?;
    }
    for &count in request.sizes("spheres") {
        let spheres = settling::loose(count);
        for scene in Scene::settling("settling") {
            measure(&scene, &spheres, &pools, request, &mut speeds)?;
        }
    }
    Ok(speeds)
}

/// Measures one state in every pool, given with its bandwidth.
fn measure<D: Dim>(
    scene: &Scene<D>,
    balls: &[Ball<D>],
    pools: &[(usize, f64)],
    request: &Request,
    speeds: &mut Vec<Speed>,
) -> Result<(), Failure> {
    if let Some(folder) = &request.write_state {
        std::fs::create_dir_all(folder).map_err(|error| Failure::io(folder.display(), error))?;
        state::write(balls, &folder.join(format!("state{}d_{}.txt", D::N, balls.len())))?;
    }
    for &(threads, bandwidth) in pools {
        let mut bytes_per_item = 0;
        let mut rates = Vec::new();
        for _ in 0..request.repeats.max(1) {
            // The same state every time, so that repeats differ by chance only.
            let mut dem = (scene.simulation)(balls)?;
            rates.push(pool(threads)?.install(|| window(&mut dem, scene.dt))?);
            bytes_per_item = dem.memory().bytes_per_item;
        }
        let rate = median(rates);
        speeds.push(Speed {
            scene: scene.name.clone(),
            scheme: scene.scheme,
            n: balls.len(),
            threads,
            rate,
            unit: "grain-steps/s",
            bytes_per_item,
            bandwidth,
            bandwidth_share: 2.0 * bytes_per_item as f64 * rate / bandwidth,
        });
    }
    Ok(())
}

/// Grain-steps a second of a simulation that has warmed up.
fn window<D: Dim>(dem: &mut Dem<D>, dt: f64) -> Result<f64, Failure> {
    dem.advance(dt, WARM_UP)?;
    let glance = (GLANCE / dem.len().max(1)).max(1) as u64;
    let (begun, mut steps) = (Instant::now(), 0);
    while begun.elapsed() < WINDOW {
        dem.advance(dt, glance)?;
        steps += glance;
    }
    Ok(steps as f64 * dem.len() as f64 / begun.elapsed().as_secs_f64())
}
