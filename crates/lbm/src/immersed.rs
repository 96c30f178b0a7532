//! Grains that move through the lattice, by the thousand: cells are partially saturated with them \[NobleTorczynski1998\].
//!
//! A cell of which grains cover the share `e` collides as fluid and as solid,
//!
//! ```text
//! f_i' = (1 - B) (fluid) + B (f_-i + f_i^eq(rho, v) - f_-i^eq(rho, u)),   B = e (tau - 1/2) / (1 - e + tau - 1/2)
//! ```
//!
//! with the velocity `v` of the grains there. Populations bounce off what is covered, in the frame of the grain, so that cells
//! lose no mass, nothing is to be refilled when a grain moves on, and grains may touch. Where more than one covers a cell, `B` is
//! shared by what they cover, and `v` is their mean. What a grain takes of momentum, `B rho (u - v)` summed over its cells, is the
//! load on it, to round-off what the fluid loses.
//!
//! A body force acts on the whole of a cell. The fluid within a grain then is at rest under it like that around it, wherever the grain
//! is, and loads are without buoyancy, which is a weight that is known exactly.
//!
//! Shares are exact in the plane, and found again for grains that moved. Covered cells lie row by row in arrays of their own; the
//! rest of the fluid is left to the kernels that it has without grains.

mod cells;
mod frame;
mod spans;
mod tile;

pub(crate) use cells::{Cells, CoveredRows, Met, PieceCells};

use crate::obstacle::Domain;
use crate::populations::{Grid, Runs};
use crate::real::Real;
use crate::setup::Setup;
use frame::{Frame, Taken, Units, centre_in_cells};
use granular_core::blocks::{Blocks, Divide};
use granular_core::quantity::{CoveredFluid, ImmersedGrain, Load};
use granular_core::{Dim, Linear, Motion, Vector};
use spans::{Bounds, Spans};
use tile::Tile;

/// Grains of a block.
const GRAINS: usize = 16;

/// Grains in the fluid, and what they cover.
#[derive(Debug, Default)]
pub(crate) struct Immersed<D: Dim, T> {
    /// Whether anybody may put grains.
    pub(crate) is_on: bool,
    /// Whether the cells that are fluid have changed.
    pub(crate) is_stale: bool,
    /// As others put them for the next step.
    pub(crate) given: Vec<ImmersedGrain<D>>,
    /// As the fluid met them in the last one.
    pub(crate) met: Vec<ImmersedGrain<D>>,
    /// What the flow did to them then.
    pub(crate) loads: Vec<Load<D>>,
    /// The fluid that they found.
    pub(crate) covered: Vec<CoveredFluid<D>>,
    tiles: Vec<Tile>,
    spans: Spans,
    pub(crate) cells: Cells<T>,
    /// Fluid that no grain covers.
    free: Runs,
}

/// What grains need to know of the fluid.
pub(crate) struct Surroundings<'a, D: Dim> {
    pub(crate) setup: &'a Setup<D>,
    pub(crate) grid: &'a Grid,
    pub(crate) fluid: &'a Runs,
}

impl<D: Dim, T: Real> Immersed<D, T> {
    /// Whether there is any grain.
    pub(crate) fn is_empty(&self) -> bool {
        self.met.is_empty()
    }

    /// Where fluid collides alone, and where with grains.
    pub(crate) fn places<'a>(&'a mut self, fluid: &'a Runs) -> (&'a Runs, &'a mut Cells<T>) {
        (if self.is_empty() { fluid } else { &self.free }, &mut self.cells)
    }

    /// Takes up the grains given.
    pub(crate) fn meet(&mut self, around: &Surroundings<'_, D>) {
        if self.given == self.met && !std::mem::take(&mut self.is_stale) {
            return;
        }
        let Self { given, met, tiles, .. } = self;
        let domain = Domain::of(around.setup);
        tiles.resize_with(given.len(), Tile::default);
        let before = met.len();
        met.resize(given.len(), ImmersedGrain { motion: Motion::at(D::Vec::ZERO), radius: 0.0 });
        let work = (&mut met[..], &mut tiles[..]);
        Blocks::new(given.len(), GRAINS).for_each(work, |block, (met, tiles)| {
            for (k, (met, tile)) in met.iter_mut().zip(tiles).enumerate() {
                let number = block * GRAINS + k;
                let grain = given[number];
                let is_there = (grain.motion.position, grain.radius) == (met.motion.position, met.radius);
                if number >= before || !is_there {
                    place(tile, &grain, &domain);
                }
                *met = grain;
            }
        });
        self.is_stale = false;
        self.loads.resize(self.met.len(), Load::ZERO);
        self.covered.resize(self.met.len(), CoveredFluid::NONE);
        if !self.is_empty() {
            self.lay_out(around);
        }
    }

    /// Finds covered cells again, with weights and velocities.
    fn lay_out(&mut self, around: &Surroundings<'_, D>) {
        let domain = Domain::of(around.setup);
        let bounds = Bounds { cells: domain.cells, is_periodic: domain.is_periodic };
        let rows = around.fluid.rows();
        self.spans.sort(&self.tiles, rows, bounds, around.grid);
        self.spans.lay_out(&mut self.cells, around.fluid, &mut self.free);
        self.cells.resize(D::N);
        let Self { cells, spans, tiles, met, .. } = self;
        let grains = Frame { grains: met, tiles, domain };
        let excess = around.setup.tau() - 0.5;
        let speed = around.setup.lattice_speed();
        let Cells { starts, per_share, weight, velocity, .. } = cells;
        let [x, y, z] = velocity.each_mut().map(Vec::as_mut_slice);
        let work = RowCells { starts, row: 0, base: 0, numbers: [per_share, weight, x, y, z] };
        let blocks = Blocks::about(rows, 64, 16);
        blocks.for_each(work, |block, mut part| {
            for row in blocks.range(block) {
                let (cells, first) = (part.of_row(row), starts[row]);
                fill_row(cells, spans.of_row(row), first, &grains, (excess, speed));
            }
        });
        self.cells.leave_out_solids();
    }

    /// Sums what each grain took and what it found, in the order of its cells. `scale` is a lattice unit of force \[N\].
    pub(crate) fn sum_loads(&mut self, setup: &Setup<D>, scale: f64) {
        let Self { cells, spans, tiles, met, loads, covered, .. } = self;
        let grains = Frame { grains: met, tiles, domain: Domain::of(setup) };
        let speed = setup.lattice_speed();
        let units = Units { force: scale, spacing: setup.spacing, time_step: setup.time_step };
        Blocks::new(met.len(), GRAINS).for_each(
            (&mut loads[..], &mut covered[..]),
            |block, (loads, covered)| {
                for (k, (load, covered)) in loads.iter_mut().zip(covered).enumerate() {
                    let number = block * GRAINS + k;
                    let mut sum = Taken::default();
                    for span in spans.of_grain(number) {
                        grains.take(span, cells, 1.0 / speed, &mut sum);
                    }
                    (*load, *covered) = sum.in_units(&units, tiles[number].total());
                }
            },
        );
    }

    /// The share of each cell that grains cover, x fastest.
    pub(crate) fn shares(&self, grid: &Grid) -> Vec<f64> {
        let [nx, ny, nz] = grid.cells;
        let mut shares = vec![0.0; nx * ny * nz];
        for (row, at) in (0..nz).flat_map(|z| (0..ny).map(move |y| (grid.row_of(y, z), (z * ny + y) * nx))) {
            if self.is_empty() {
                break;
            }
            for span in self.spans.of_row(row) {
                let covered =
                    self.tiles[span.grain as usize].shares(span.share as usize, span.count as usize);
                for (sum, share) in shares[at + span.x as usize..].iter_mut().zip(covered) {
                    *sum = f64::min(*sum + share, 1.0);
                }
            }
        }
        shares
    }

    /// Fastest speed of a surface \[m/s\].
    pub(crate) fn fastest(&self) -> f64 {
        self.met.iter().map(speed_of).fold(0.0, f64::max)
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<ImmersedGrain<D>>() * (self.given.capacity() + self.met.capacity())
            + size_of::<Load<D>>() * self.loads.capacity()
            + size_of::<CoveredFluid<D>>() * self.covered.capacity()
            + self.tiles.iter().map(|tile| size_of::<Tile>() + tile.bytes()).sum::<usize>()
            + self.spans.bytes()
            + self.cells.bytes()
            + self.free.bytes()
    }
}

/// Fastest speed of the surface of a grain \[m/s\].
pub(crate) fn speed_of<D: Dim>(grain: &ImmersedGrain<D>) -> f64 {
    grain.motion.velocity.length() + grain.radius * grain.motion.spin.length()
}

/// Finds what a grain covers.
fn place<D: Dim>(tile: &mut Tile, grain: &ImmersedGrain<D>, domain: &Domain<D>) {
    let (centre, radius) = (centre_in_cells(grain, domain), grain.radius / domain.spacing);
    let reaches = |axis: usize| {
        let (at, cells) = (centre.component(axis), domain.cells[axis] as f64);
        at + radius > 0.0 && at - radius < cells
    };
    if (0..D::N).all(reaches) { tile.cover::<D>(centre, radius) } else { tile.clear() }
}

/// Numbers of covered cells in some rows: weight over share, weight, and the components of velocity.
struct RowCells<'a, T> {
    starts: &'a [usize],
    row: usize,
    base: usize,
    numbers: [&'a mut [T]; 5],
}

impl<T> RowCells<'_, T> {
    fn of_row(&mut self, row: usize) -> [&mut [T]; 5] {
        let range = self.starts[row] - self.base..self.starts[row + 1] - self.base;
        self.numbers.each_mut().map(|values| values.get_mut(range.clone()).unwrap_or(&mut []))
    }
}

impl<T: Send> Divide for RowCells<'_, T> {
    fn divide(self, blocks: usize, size: usize) -> (Self, Self) {
        let row = (self.row + blocks * size).min(self.starts.len() - 1);
        let base = self.starts[row];
        let mut rest: [Option<&mut [T]>; 5] = [const { None }; 5];
        let mut rests = rest.iter_mut();
        let first = self.numbers.map(|values| {
            let (first, second) = values.split_at_mut((base - self.base).min(values.len()));
            *rests.next().expect("one for each") = Some(second);
            first
        });
        let second = rest.map(|values| values.expect("one for each"));
        let starts = self.starts;
        (Self { numbers: first, ..self }, Self { starts, row, base, numbers: second })
    }
}

/// Weights and velocities of the covered cells of a row.
fn fill_row<D: Dim, T: Real>(
    [per_share, weight, x, y, z]: [&mut [T]; 5],
    spans: &[spans::Span],
    first: usize,
    grains: &Frame<'_, D>,
    (excess, speed): (f64, f64),
) {
    let mut velocity = [x, y, z];
    weight.fill(T::of(0.0));
    velocity.iter_mut().for_each(|values| values.fill(T::of(0.0)));
    for span in spans {
        let (grain, shares, arm) = grains.of(span);
        let [start, slope] = grains.velocities(grain, arm, 1.0 / speed);
        let at = span.at as usize - first;
        for (sum, share) in weight[at..].iter_mut().zip(shares) {
            *sum += T::of(*share);
        }
        for (axis, values) in velocity.iter_mut().enumerate().take(D::N) {
            let (start, slope) = (start.component(axis), slope.component(axis));
            for (k, (sum, share)) in values[at..].iter_mut().zip(shares).enumerate() {
                *sum += T::of(share * (start + slope * k as f64));
            }
        }
    }
    let (one, excess) = (T::of(1.0), T::of(excess));
    for k in 0..weight.len() {
        let share = weight[k];
        let mean = if share > T::of(0.0) { one / share } else { T::of(0.0) };
        for values in velocity.iter_mut().take(D::N) {
            values[k] = values[k] * mean;
        }
        // Grains that overlap share a cell that is full.
        let is_full = share >= one;
        per_share[k] = if is_full { mean } else { excess / (one - share + excess) };
        weight[k] = if is_full { one } else { share * per_share[k] };
    }
}
