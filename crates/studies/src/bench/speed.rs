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

use super::state::{self, Ball};
use super::{settling, triad};
use granular_core::{D2, D3, Dim, Solver};
use granular_dem::Dem;
use granular_driver::failure::Failure;
use granular_driver::parallel::pool;
use granular_driver::statistics::median;
use serde::Serialize;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Steps before the clock starts.
const WARM_UP: u64 = 200;
/// A timed window lasts at least this long.
const WINDOW: Duration = Duration::from_secs(1);
/// Grain-steps between looks at the clock.
const GLANCE: usize = 1_000_000;

const LINEAR: &str = "leapfrog, linear with friction, tension cut";
const HERTZ: &str = "leapfrog, Hertz-Mindlin, tension cut";

/// What to measure.
#[derive(Clone, Debug)]
pub struct Request {
    /// Numbers of disks of the column; not used with a state.
    pub disks: Vec<usize>,
    /// Numbers of settling spheres; not used with a state.
    pub spheres: Vec<usize>,
    /// Numbers of threads.
    pub threads: Vec<usize>,
    /// Windows that the median is taken of.
    pub repeats: usize,
    /// File with a state to measure on.
    pub state: Option<PathBuf>,
    /// Folder to write the states to.
    pub write_state: Option<PathBuf>,
}

/// A measured speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Speed {
    /// Scene.
    pub scene: String,
    /// Law and scheme.
    pub scheme: &'static str,
    /// Number of disks or cells.
    pub n: usize,
    /// Threads.
    pub threads: usize,
    /// Median speed.
    pub rate: f64,
    /// Unit of the speed.
    pub unit: &'static str,
    /// Bytes that the solver holds for a grain or cell.
    pub bytes_per_item: usize,
    /// What the memory moves with these threads \[bytes/s\]: for grains a triad, for cells an update in place.
    pub bandwidth: f64,
    /// Bytes moved over those that the memory moves in the same time: for grains against a triad, an
    /// estimate from above; for cells, each population read and written once in a pass over memory.
    pub bandwidth_share: f64,
}

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

/// Measures the discrete element method.
///
/// # Errors
/// When a state cannot be made, read or written, or the solver gives up.
pub fn dem(request: &Request) -> Result<Vec<Speed>, Failure> {
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
    for &count in &request.disks {
        measure(&Scene::column("column collapse"), &state::falling(count)?, &pools, request, &mut speeds)?;
    }
    for &count in &request.spheres {
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

/// Speeds as a table.
pub fn table(speeds: &[Speed]) -> String {
    let unit = speeds.first().map_or("", |speed| speed.unit);
    let mut text = format!(
        "{:<16} {:<44} {:>9} {:>8} {:>14} {:>7} {:>10} {:>9}\n",
        "scene", "scheme", "n", "threads", unit, "bytes", "share of", "GB/s"
    );
    for speed in speeds {
        let Speed { scene, scheme, n, threads, rate, bytes_per_item, bandwidth, bandwidth_share, .. } = speed;
        let bandwidth = 1e-9 * bandwidth;
        text += &format!(
            "{scene:<16} {scheme:<44} {n:>9} {threads:>8} {rate:>14.4e} {bytes_per_item:>7} {bandwidth_share:>10.2} {bandwidth:>9.1}\n"
        );
    }
    text + "share of GB/s: bytes that must move, over what the same threads move in a plain loop (grains: a triad; cells: an update\n\
            in place, in huge pages where the system has them); samples that fit into a cache may exceed one\n"
}
