//! Grains and branches as a grid sees them: in a periodic cell each with all images that reach into it.

use super::grid::CoarseGrid;
use super::source::{CoarseSource, Periods};
use crate::dim::{Dim, Linear, Vector};
use crate::matrix::Matrix;
use crate::shape::corners;

/// A grain, or an image of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<D: Dim> {
    /// Index of the grain.
    pub(super) grain: usize,
    /// In cells of the grid from the centre of its first one.
    pub(super) place: [f64; 3],
    /// Velocity there \[m/s\]: in a cell that deforms, images move with its flow.
    pub(super) velocity: D::Vec,
}

/// What repeats, and how far from a grain its images may matter to a grid.
pub(super) struct Images<'a, D: Dim> {
    cell: Option<Periods<D>>,
    grid: &'a CoarseGrid<D>,
    /// The grid and the reach of its kernel, in shares of the edges of the cell.
    low: [f64; 3],
    high: [f64; 3],
}

impl<'a, D: Dim> Images<'a, D> {
    /// Of points whose kernels, or branches of at most `reach` \[m\], touch the grid.
    pub(super) fn of(source: &CoarseSource<'_, D>, grid: &'a CoarseGrid<D>, reach: f64) -> Self {
        let cell = source.periods;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        if let Some(cell) = cell {
            let (shares, bounds) = (cell.edges.inverse(), grid.reached(reach));
            for corner in corners::<D>(bounds[0], bounds[1]) {
                let share = shares.apply(corner);
                for axis in 0..D::N {
                    low[axis] = low[axis].min(share.component(axis));
                    high[axis] = high[axis].max(share.component(axis));
                }
            }
        }
        Self { cell, grid, low, high }
    }

    /// Calls `visit` with the way \[m\] to each image of a point that may matter; only with none without a cell.
    pub(super) fn visit(&self, position: D::Vec, mut visit: impl FnMut(D::Vec)) {
        let Some(cell) = &self.cell else { return visit(D::Vec::ZERO) };
        let share = cell.edges.inverse().apply(position);
        let range = |axis: usize| {
            if axis >= D::N || !cell.is_periodic[axis] {
                return 0..=0;
            }
            let at = share.component(axis);
            (self.low[axis] - at).ceil() as i64..=(self.high[axis] - at).floor() as i64
        };
        let edge = |axis: usize, count: i64| cell.edges.columns[axis] * count as f64;
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let count = [x, y, z];
                    visit((0..D::N).fold(D::Vec::ZERO, |way, axis| way + edge(axis, count[axis])));
                }
            }
        }
    }

    /// All grains and images, in the order of the grains.
    pub(super) fn grains(&self, source: &CoarseSource<'_, D>) -> Vec<Seen<D>> {
        let flows = self.cell.is_some_and(|cell| cell.gradient != Matrix::zero());
        let mut seen = Vec::with_capacity(source.position.len());
        for (grain, (&position, &velocity)) in source.position.iter().zip(&*source.velocity).enumerate() {
            self.visit(position, |way| {
                let flow = if flows { self.flow(way) } else { D::Vec::ZERO };
                let place = self.grid.place(position + way);
                seen.push(Seen { grain, place, velocity: velocity + flow });
            });
        }
        seen
    }

    /// What the flow of the cell adds to the velocity over a way \[m/s\].
    fn flow(&self, way: D::Vec) -> D::Vec {
        self.cell.map_or(D::Vec::ZERO, |cell| cell.gradient.apply(way))
    }
}
