//! Sums over grains and contacts in every cell. Cells are cut into blocks of layers; every block goes through all grains
//! and contacts in their order, so that the bits do not depend on the number of threads.

use super::grid::CoarseGrid;
use super::images::{Images, Seen};
use super::source::{CoarseSource, ForceBranch};
use super::spline::{Weights, gauss, touches};
use crate::blocks::Blocks;
use crate::dim::{Dim, Vector};
use crate::tensor::SymmetricTensor;
use glam::DVec3;
use std::ops::Range;

/// Most blocks that a grid is cut into.
const BLOCKS: usize = 32;

/// What is summed besides [`Bulk`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Wanted {
    pub(super) slopes: bool,
    pub(super) kinetic: bool,
    pub(super) contacts: bool,
    pub(super) fabric: bool,
}

impl Wanted {
    pub(super) const ALL: Self = Self { slopes: true, kinetic: true, contacts: true, fabric: true };
}

/// Sums over grains, each with its weight in the cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bulk<D: Dim> {
    /// Grains \[-\].
    pub(super) number: f64,
    /// Their mass \[kg\].
    pub(super) mass: f64,
    /// Their area or volume \[m^2, m^3\].
    pub(super) volume: f64,
    /// Mass times diameter \[kg m\].
    pub(super) diameter: f64,
    /// Momentum \[kg m/s\].
    pub(super) momentum: D::Vec,
}

/// Derivatives per cell of mass and momentum, along each axis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slopes<D: Dim> {
    pub(super) mass: [f64; 3],
    pub(super) momentum: [D::Vec; 3],
}

/// Sums over contacts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pushes<D: Dim> {
    /// Force times branch \[N m\].
    pub(super) stress: SymmetricTensor,
    /// Force of walls \[N\].
    pub(super) walls: D::Vec,
}

/// Sums over the contacts of grains, with the weight of the grain.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fabric {
    pub(super) contacts: f64,
    /// Sum of `n n`.
    pub(super) normals: SymmetricTensor,
}

/// One value per cell; empty where it is not wanted.
#[derive(Clone, Debug)]
pub(super) struct Sums<D: Dim> {
    pub(super) bulk: Vec<Bulk<D>>,
    pub(super) slopes: Vec<Slopes<D>>,
    /// Mass times square of the velocity about the mean \[J\].
    pub(super) kinetic: Vec<SymmetricTensor>,
    pub(super) pushes: Vec<Pushes<D>>,
    pub(super) fabric: Vec<Fabric>,
    /// Mass that is spread beyond the grid \[kg\].
    pub(super) outside: f64,
}

/// A line along which a contact force acts, in cells from the centre of the first.
struct Branch<D: Dim> {
    from: [f64; 3],
    to: [f64; 3],
    /// Force times branch \[N m\].
    product: SymmetricTensor,
    /// Force of a wall at `from` \[N\], if it is one.
    wall: Option<D::Vec>,
}

/// The part of the grid that a block fills.
struct Part<'a, D: Dim> {
    grid: &'a CoarseGrid<D>,
    layers: Range<usize>,
    /// First cell.
    start: usize,
}

impl<D: Dim> Sums<D> {
    pub(super) fn of(source: &CoarseSource<'_, D>, grid: &CoarseGrid<D>, wanted: Wanted) -> Self {
        let count = |wanted: bool| if wanted { grid.count() } else { 0 };
        let mut sums = Self {
            bulk: vec![Bulk::default(); grid.count()],
            slopes: vec![Slopes::default(); count(wanted.slopes)],
            kinetic: vec![SymmetricTensor::ZERO; count(wanted.kinetic)],
            pushes: vec![Pushes::default(); count(wanted.contacts)],
            fabric: vec![Fabric::default(); count(wanted.fabric)],
            outside: 0.0,
        };
        let seen = Images::of(source, grid, 0.0).grains(source);
        let branches = if wanted.contacts { branches(source, grid) } else { Vec::new() };
        let normals = if wanted.fabric { normals(source) } else { Vec::new() };
        let blocks = Blocks::new(grid.count(), grid.layer() * grid.layers().div_ceil(BLOCKS));
        let Self { bulk, slopes, kinetic, pushes, fabric, .. } = &mut sums;
        let work = (&mut bulk[..], &mut slopes[..], &mut kinetic[..], &mut pushes[..], &mut fabric[..]);
        blocks.for_each(work, |block, (bulk, slopes, kinetic, pushes, fabric)| {
            let range = blocks.range(block);
            let layers = range.start / grid.layer()..range.end / grid.layer();
            let part = Part { grid, layers, start: range.start };
            part.grains(source, &seen, bulk);
            if wanted.slopes {
                part.slopes(source, &seen, slopes);
            }
            if wanted.kinetic {
                part.kinetic(source, &seen, bulk, kinetic);
            }
            if wanted.contacts {
                part.contacts(&branches, pushes);
                part.stresses(source, &seen, pushes);
            }
            if wanted.fabric {
                part.fabric(&seen, &normals, fabric);
            }
        });
        sums.outside = outside(source, grid, &seen);
        sums
    }
}

impl<D: Dim> Part<'_, D> {
    fn reaches(&self, between: [f64; 2]) -> bool {
        touches(between, self.grid.width(), self.layers.start, self.layers.end)
    }

    /// What reaches into this part.
    fn near<'a>(&'a self, seen: &'a [Seen<D>]) -> impl Iterator<Item = &'a Seen<D>> + 'a {
        let last = D::N - 1;
        seen.iter().filter(move |seen| self.reaches([seen.place[last]; 2]))
    }

    /// Calls `add` with the index within the part and the weight of every cell that a kernel reaches.
    #[inline(always)]
    fn spread(&self, weights: &[Weights; 3], mut add: impl FnMut(usize, f64)) {
        let [columns, rows, _] = self.grid.cells();
        let range = |axis: usize| {
            if axis == D::N - 1 { (self.layers.start, self.layers.end) } else { (0, self.grid.cells()[axis]) }
        };
        let [x, y, z] = [range(0), range(1), range(2)];
        for (k, along_z) in weights[2].within(z.0, z.1) {
            for (j, along_y) in weights[1].within(y.0, y.1) {
                let row = (k * rows + j) * columns - self.start;
                for (i, along_x) in weights[0].within(x.0, x.1) {
                    add(row + i, along_x * along_y * along_z);
                }
            }
        }
    }

    fn grains(&self, source: &CoarseSource<'_, D>, seen: &[Seen<D>], bulk: &mut [Bulk<D>]) {
        for &Seen { grain, place, velocity } in self.near(seen) {
            let (mass, (volume, diameter)) = (source.mass[grain], source.solid(grain));
            let diameter = diameter * mass;
            let momentum = velocity * mass;
            self.spread(&self.grid.weights(place), |cell, weight| {
                let bulk = &mut bulk[cell];
                bulk.number += weight;
                bulk.mass += weight * mass;
                bulk.volume += weight * volume;
                bulk.diameter += weight * diameter;
                bulk.momentum += momentum * weight;
            });
        }
    }

    fn slopes(&self, source: &CoarseSource<'_, D>, seen: &[Seen<D>], slopes: &mut [Slopes<D>]) {
        for &Seen { grain, place, velocity } in self.near(seen) {
            let mass = source.mass[grain];
            let momentum = velocity * mass;
            let (weights, along) = (self.grid.weights(place), self.grid.slopes(place));
            for axis in 0..D::N {
                let mut mixed = weights;
                mixed[axis] = along[axis];
                self.spread(&mixed, |cell, slope| {
                    slopes[cell].mass[axis] += slope * mass;
                    slopes[cell].momentum[axis] += momentum * slope;
                });
            }
        }
    }

    /// About the mean velocity of each cell: nothing is lost in a difference of large numbers.
    fn kinetic(
        &self,
        source: &CoarseSource<'_, D>,
        seen: &[Seen<D>],
        bulk: &[Bulk<D>],
        kinetic: &mut [SymmetricTensor],
    ) {
        let mean: Vec<D::Vec> = bulk.iter().map(|bulk| mean_velocity(bulk).unwrap_or_default()).collect();
        for &Seen { grain, place, velocity } in self.near(seen) {
            let mass = source.mass[grain];
            self.spread(&self.grid.weights(place), |cell, weight| {
                let about = DVec3::from((velocity - mean[cell]).padded());
                kinetic[cell] += SymmetricTensor::dyad(about, about) * (weight * mass);
            });
        }
    }

    fn contacts(&self, branches: &[Branch<D>], pushes: &mut [Pushes<D>]) {
        let (last, nodes) = (D::N - 1, gauss());
        let mut cuts = Vec::new();
        for branch in branches {
            let ends = [branch.from[last], branch.to[last]];
            if !self.reaches([ends[0].min(ends[1]), ends[0].max(ends[1])]) {
                continue;
            }
            if let Some(force) = branch.wall {
                self.spread(&self.grid.weights(branch.from), |cell, weight| {
                    pushes[cell].walls += force * weight;
                });
            }
            branch.cut(&mut cuts);
            for piece in cuts.windows(2) {
                let length = piece[1] - piece[0];
                for (node, share) in nodes {
                    let s = piece[0] + length * node;
                    let place = std::array::from_fn(|k| branch.from[k] + s * (branch.to[k] - branch.from[k]));
                    let product = branch.product * (length * share);
                    self.spread(&self.grid.weights(place), |cell, weight| {
                        pushes[cell].stress += product * weight;
                    });
                }
            }
        }
    }

    /// Stresses that particles of a continuum carry themselves.
    fn stresses(&self, source: &CoarseSource<'_, D>, seen: &[Seen<D>], pushes: &mut [Pushes<D>]) {
        if source.stress.is_empty() {
            return;
        }
        for &Seen { grain, place, .. } in self.near(seen) {
            let product = source.stress[grain] * source.size.of::<D>(grain).0;
            self.spread(&self.grid.weights(place), |cell, weight| {
                pushes[cell].stress += product * weight;
            });
        }
    }

    fn fabric(&self, seen: &[Seen<D>], normals: &[Fabric], fabric: &mut [Fabric]) {
        for &Seen { grain, place, .. } in self.near(seen) {
            let own = normals[grain];
            self.spread(&self.grid.weights(place), |cell, weight| {
                fabric[cell].contacts += weight * own.contacts;
                fabric[cell].normals += own.normals * weight;
            });
        }
    }
}

impl<D: Dim> Branch<D> {
    /// Shares of the length, from 0 to 1, between which the kernel is one polynomial for every cell.
    fn cut(&self, cuts: &mut Vec<f64>) {
        cuts.clear();
        cuts.extend([0.0, 1.0]);
        for axis in 0..D::N {
            let (a, b) = (self.from[axis], self.to[axis]);
            let mut plane = a.min(b).floor() + 1.0;
            while plane < a.max(b) {
                cuts.push((plane - a) / (b - a));
                plane += 1.0;
            }
        }
        cuts.sort_unstable_by(f64::total_cmp);
    }
}

/// Mean velocity in a cell \[m/s\]; none where there is no grain.
pub(super) fn mean_velocity<D: Dim>(bulk: &Bulk<D>) -> Option<D::Vec> {
    (bulk.mass > 0.0).then(|| bulk.momentum * (1.0 / bulk.mass))
}

/// Mass that the kernel spreads beyond the grid \[kg\]; images of a grain may be on the grid where it is not.
fn outside<D: Dim>(source: &CoarseSource<'_, D>, grid: &CoarseGrid<D>, seen: &[Seen<D>]) -> f64 {
    let mut missing = vec![1.0; source.position.len()];
    for seen in seen {
        missing[seen.grain] -= grid.share(seen.place);
    }
    missing.iter().zip(source.mass).map(|(missing, mass)| mass * f64::max(*missing, 0.0)).sum()
}

/// Branches of all forces, from each image of the first body that may matter.
fn branches<D: Dim>(source: &CoarseSource<'_, D>, grid: &CoarseGrid<D>) -> Vec<Branch<D>> {
    let mut branches = Vec::new();
    let images = Images::of(source, grid, source.longest_branch);
    (source.visit_branches)(&mut |branch: ForceBranch<D>| {
        let (arm, position) = (branch.normal * branch.length, source.position[branch.first]);
        let wall = branch.second.is_none().then_some(branch.force);
        let [arm3, force] = [arm, branch.force].map(|v| DVec3::from(v.padded()));
        let product = SymmetricTensor::dyad(force, arm3);
        images.visit(position, |way| {
            let (from, to) = (grid.place(position + way - arm), grid.place(position + way));
            branches.push(Branch { from, to, product, wall });
        });
    });
    branches
}

/// Number of contacts and sum of `n n` of each particle, walls included.
fn normals<D: Dim>(source: &CoarseSource<'_, D>) -> Vec<Fabric> {
    let mut list = vec![Fabric::default(); source.position.len()];
    (source.visit_branches)(&mut |branch: ForceBranch<D>| {
        let normal = DVec3::from(branch.normal.padded());
        let dyad = SymmetricTensor::dyad(normal, normal);
        let mut add = |index: usize| {
            list[index].contacts += 1.0;
            list[index].normals += dyad;
        };
        add(branch.first);
        branch.second.into_iter().for_each(add);
    });
    list
}
