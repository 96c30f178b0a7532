//! Throughput of methods over sizes and threads.

use super::Printed;
use crate::METHODS;
use granular_driver::failure::Failure;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// How fast a method is, over sizes and threads.
#[derive(Clone, Copy, Debug)]
pub struct Throughput {
    /// What is timed, and what it costs where that is much.
    pub about: &'static str,
    /// Lists of sizes that may be asked for.
    pub sizes: &'static [Sizes],
    pub(crate) run: fn(&Request) -> Result<Printed, Failure>,
}

/// A list of sizes of one scene.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// Name of its flag.
    pub flag: &'static str,
    /// What is counted.
    pub about: &'static str,
    /// Sizes where none are asked for, with commas between.
    pub default: &'static str,
    /// Memory that one item takes \[bytes\].
    pub bytes: f64,
}

/// What to measure.
#[derive(Clone, Debug)]
pub struct Request {
    /// Sizes by the flag of their [`Sizes`].
    pub sizes: BTreeMap<String, Vec<usize>>,
    /// Numbers of threads; each has its own pool.
    pub threads: Vec<usize>,
    /// Windows that the median is taken of.
    pub repeats: usize,
    /// File with a state to measure on in place of sizes, where the method reads one.
    pub state: Option<PathBuf>,
    /// Folder to write the states to, where the method writes any.
    pub write_state: Option<PathBuf>,
}

impl Request {
    /// Sizes that are asked for under a flag.
    pub(crate) fn sizes(&self, flag: &str) -> &[usize] {
        self.sizes.get(flag).map_or(&[], Vec::as_slice)
    }
}

/// All lists of sizes that some method knows.
pub fn sizes() -> impl Iterator<Item = &'static Sizes> {
    METHODS.iter().filter_map(|method| method.speed.as_ref()).flat_map(|speed| speed.sizes)
}

/// Measures a method.
///
/// # Errors
/// When no method of this name is timed, a state cannot be made, read or written, or the solver gives up.
pub fn measure(method: &str, request: &Request) -> Result<Printed, Failure> {
    let speed = METHODS.iter().find(|known| known.name == method).and_then(|known| known.speed);
    let speed = speed.ok_or_else(|| Failure::Io(format!("the speed of `{method}` is not measured")))?;
    (speed.run)(request)
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
