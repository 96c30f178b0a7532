//! Sites a second of weighted Voronoi diagrams: sweep, cells in a square and their areas, on one thread.

use crate::bench::speed::{self, Sizes, Speed, Throughput};
use crate::bench::{Printed, triad};
use granular_core::glam::DVec2;
use granular_core::random::Chance;
use granular_driver::failure::Failure;
use granular_driver::parallel::pool;
use granular_driver::statistics::{median, order};
use granular_tessellate::{Diagram, Domain};
use serde::Serialize;
use std::time::{Duration, Instant};

pub(super) const THROUGHPUT: Throughput = Throughput {
    about: "Weighted Voronoi diagrams, on one thread; takes half a minute",
    sizes: &[Sizes {
        flag: "sites",
        about: "Numbers of sites of a tessellation",
        default: "1000,10000,100000,1000000",
        bytes: 500.0,
    }],
    run: |request| {
        let rates = tessellate(request.sizes("sites"), request.repeats)?;
        Ok(Printed::new(&rates, table(&rates)))
    },
};

/// A timed window lasts at least this long.
const WINDOW: Duration = Duration::from_millis(300);

/// A measured speed, and how the time of its scene grows with the number of sites.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Rate {
    /// The speed.
    #[serde(flatten)]
    speed: Speed,
    /// Exponent of time over the number of sites, fitted over all sizes; not a number for one size.
    exponent: f64,
}

/// Disks in the unit square.
pub(in crate::methods) struct Disks {
    pub(in crate::methods) centres: Vec<DVec2>,
    pub(in crate::methods) radii: Vec<f64>,
    /// Mean distance of neighbours.
    pub(in crate::methods) spacing: f64,
}

impl Disks {
    /// Graded disks that do not overlap, row by row, about a hexagonal lattice.
    pub(in crate::methods) fn packed(count: usize) -> Self {
        let mut chance = Chance::new(1);
        // Rows are sqrt(3)/2 of the spacing apart.
        let spacing = (2.0 / 3.0_f64.sqrt() / count as f64).sqrt();
        let columns = ((1.0 / spacing).round() as usize).max(1);
        let (across, up) = (1.0 / columns as f64, 1.0 / (count as f64 / columns as f64).ceil());
        let nearest = across.min((0.25 * across * across + up * up).sqrt());
        let mut disk = |index: usize| {
            let (column, row) = (index % columns, index / columns);
            let shift = 0.25 + 0.5 * (row % 2) as f64;
            let place = DVec2::new(across * (column as f64 + shift), up * (row as f64 + 0.5));
            let radius = 0.5 * nearest * chance.between(0.7, 0.98);
            let room = 0.5 * nearest - radius;
            let step = DVec2::from_angle(chance.between(0.0, std::f64::consts::TAU)) * room;
            (place + step, radius)
        };
        let (centres, radii) = (0..count).map(&mut disk).unzip();
        Self { centres, radii, spacing: nearest }
    }

    /// Disks anywhere, in no order; many overlap.
    fn scattered(count: usize) -> Self {
        let mut chance = Chance::new(2);
        let spacing = (1.0 / count as f64).sqrt();
        let mut disk = || (DVec2::new(chance.uniform(), chance.uniform()), 0.5 * spacing * chance.uniform());
        let (centres, radii) = (0..count).map(|_| disk()).unzip();
        Self { centres, radii, spacing }
    }
}

/// Measures diagrams of so many sites each.
fn tessellate(sizes: &[usize], repeats: usize) -> Result<Vec<Rate>, Failure> {
    let bandwidth = pool(1)?.install(triad::bandwidth);
    let mut rates = Vec::new();
    for (scene, make) in
        [("packed disks", Disks::packed as fn(usize) -> Disks), ("scattered disks", Disks::scattered)]
    {
        let mut speeds = Vec::new();
        for &size in sizes.iter().filter(|size| **size > 0) {
            speeds.push(measure(scene, &make(size), bandwidth, repeats)?);
        }
        let points: Vec<(f64, f64)> =
            speeds.iter().map(|speed| (speed.n as f64, speed.n as f64 / speed.rate)).collect();
        let exponent = if points.len() > 1 { order(&points) } else { f64::NAN };
        rates.extend(speeds.into_iter().map(|speed| Rate { speed, exponent }));
    }
    Ok(rates)
}

fn measure(scene: &str, disks: &Disks, bandwidth: f64, repeats: usize) -> Result<Speed, Failure> {
    let domain = Domain::rectangle(DVec2::ZERO, DVec2::ONE)?;
    let count = disks.centres.len();
    let mut bytes_per_item = 0;
    let mut rates = Vec::new();
    for _ in 0..repeats.max(1) {
        let (begun, mut sites) = (Instant::now(), 0);
        while begun.elapsed() < WINDOW {
            let diagram = Diagram::new(&disks.centres, &disks.radii)?;
            let cells = diagram.cells(&domain);
            bytes_per_item = (diagram.bytes() + cells.bytes()) / count;
            sites += count;
        }
        rates.push(sites as f64 / begun.elapsed().as_secs_f64());
    }
    let rate = median(rates);
    Ok(Speed {
        scene: scene.to_owned(),
        scheme: "sweep line, cells and areas",
        n: count,
        threads: 1,
        rate,
        unit: "sites/s",
        bytes_per_item,
        bandwidth,
        bandwidth_share: 2.0 * bytes_per_item as f64 * rate / bandwidth,
    })
}

/// Speeds as a table, with the exponents below.
fn table(rates: &[Rate]) -> String {
    let speeds: Vec<Speed> = rates.iter().map(|rate| rate.speed.clone()).collect();
    let mut text = speed::table(&speeds);
    let mut last = "";
    for Rate { speed, exponent } in rates {
        if speed.scene != last && exponent.is_finite() {
            text += &format!("{}: time grows as n^{exponent:.3}\n", speed.scene);
        }
        last = &speed.scene;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_disks_do_not_overlap() {
        let Disks { centres, radii, .. } = Disks::packed(500);
        for i in 0..centres.len() {
            for j in 0..i {
                assert!((centres[i] - centres[j]).length() > radii[i] + radii[j], "{i} {j}");
            }
        }
        assert!(
            centres.iter().all(|centre| centre.cmpge(DVec2::ZERO).all() && centre.cmple(DVec2::ONE).all())
        );
    }

    #[test]
    fn each_scene_has_an_exponent() {
        let rates = tessellate(&[50, 200], 1).unwrap();
        assert_eq!(rates.len(), 4);
        assert!(rates.iter().all(|rate| rate.speed.rate > 1e3 && rate.exponent.is_finite()));
        assert!(table(&rates).contains("time grows as n^"));
    }
}
