//! Cell updates a second of the lattice Boltzmann method: boxes with half-way walls, all cells fluid, relaxation
//! time 0.504.
//!
//! A pass over memory moves each population out of it and back once, `2 Q` numbers a cell; in the plane, where no face is
//! open, two steps share one. The share of the bandwidth compares that with an update in place, in pages of the same kind,
//! which the same threads run.

mod update;

use crate::bench::Printed;
use crate::bench::speed::{Request, Speed, Throughput, table};
use granular_core::{Solver, Vector};
use granular_driver::failure::Failure;
use granular_driver::parallel::pool;
use granular_driver::statistics::median;
use granular_lbm::{D2Q9, D3Q19, Face, Flow, Lattice, Lbm, Operator, Real, Setup};
use std::time::Instant;

pub(super) const THROUGHPUT: Throughput = Throughput {
    about: "Lattice Boltzmann method; takes 2 GB of memory",
    sizes: &[],
    run: |request| {
        let speeds = lbm(request)?;
        Ok(Printed::new(&speeds, table(&speeds)))
    },
};

/// Cells in the plane and in space.
const PLANE: [usize; 3] = [3600, 2000, 1];
const SPACE: [usize; 3] = [256, 256, 256];
/// Cell updates of a timed window.
const WINDOW: usize = 150_000_000;
/// Steps before the clock starts.
const WARM_UP: u64 = 2;

/// An operator with or without closure, under a name.
type Scheme = (&'static str, Operator, Option<f64>);

const SINGLE: Operator = Operator::SingleRelaxation;
const MULTIPLE: Operator = Operator::EXACT_WALLS;

/// Measures all schemes.
fn lbm(request: &Request) -> Result<Vec<Speed>, Failure> {
    let mut speeds = Vec::new();
    for &threads in &request.threads {
        let bench =
            Bench { threads, repeats: request.repeats, bandwidth: pool(threads)?.install(update::bandwidth) };
        speeds.push(bench.run::<D2Q9, 9, f64>(PLANE, ("D2Q9 f64, one relaxation time", SINGLE, None))?);
        speeds
            .push(bench.run::<D2Q9, 9, f64>(PLANE, ("D2Q9 f64, multiple relaxation times", MULTIPLE, None))?);
        speeds.push(
            bench.run::<D2Q9, 9, f64>(PLANE, ("D2Q9 f64, multiple, Smagorinsky", MULTIPLE, Some(0.1)))?,
        );
        speeds.push(bench.run::<D2Q9, 9, f32>(PLANE, ("D2Q9 f32, one relaxation time", SINGLE, None))?);
        speeds.push(
            bench.run::<D2Q9, 9, f32>(PLANE, ("D2Q9 f32, multiple, Smagorinsky", MULTIPLE, Some(0.1)))?,
        );
        speeds.push(
            bench.run::<D3Q19, 19, f64>(SPACE, ("D3Q19 f64, multiple relaxation times", MULTIPLE, None))?,
        );
        speeds.push(
            bench.run::<D3Q19, 19, f32>(SPACE, ("D3Q19 f32, multiple relaxation times", MULTIPLE, None))?,
        );
    }
    Ok(speeds)
}

struct Bench {
    threads: usize,
    repeats: usize,
    bandwidth: f64,
}

impl Bench {
    fn run<L: Lattice<Q>, const Q: usize, T: Real>(
        &self,
        cells: [usize; 3],
        (scheme, operator, smagorinsky): Scheme,
    ) -> Result<Speed, Failure> {
        let mut setup = Setup::<L::Dim>::new(cells, 1.0, 1.0, 0.504);
        (setup.operator, setup.smagorinsky) = (operator, smagorinsky);
        for faces in &mut setup.faces[..<L::Dim as granular_core::Dim>::N] {
            *faces = [Face::REST, Face::REST];
        }
        let speed = 1e-3 * setup.lattice_speed();
        let mut lbm = Lbm::<L, Q, T>::new(setup).expect("the box is in range");
        lbm.set_flow(|point| Flow {
            pressure: 0.0,
            velocity: Vector::along(0, speed * (0.01 * point.component(1)).sin()),
        });
        let dt = lbm.setup().time_step;
        let n: usize = cells.iter().product();
        let steps = (WINDOW / n).max(2) as u64;
        let mut rates = Vec::new();
        for _ in 0..self.repeats.max(1) {
            rates.push(pool(self.threads)?.install(|| -> Result<f64, Failure> {
                lbm.advance(dt, WARM_UP)?;
                let begun = Instant::now();
                lbm.advance(dt, steps)?;
                Ok(steps as f64 * n as f64 / begun.elapsed().as_secs_f64())
            })?);
        }
        let steps_of_a_pass = if cells[2] == 1 { 2.0 } else { 1.0 };
        let rate = median(rates);
        Ok(Speed {
            scene: "box".to_owned(),
            scheme,
            n,
            threads: self.threads,
            rate,
            unit: "updates/s",
            bytes_per_item: lbm.memory().bytes_per_item,
            bandwidth: self.bandwidth,
            bandwidth_share: (2 * Q * size_of::<T>()) as f64 * rate / (steps_of_a_pass * self.bandwidth),
        })
    }
}
