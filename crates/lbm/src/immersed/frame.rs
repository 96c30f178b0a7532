//! Grains with what they cover: their velocities in cells, and what they take from the fluid there.

use super::cells::Cells;
use super::spans::Span;
use super::tile::Tile;
use crate::obstacle::Domain;
use crate::real::Real;
use granular_core::quantity::{CoveredFluid, ImmersedGrain, Load};
use granular_core::{Dim, Linear, Motion, Vector};

/// Grains with what they cover.
pub(super) struct Frame<'a, D: Dim> {
    pub(super) grains: &'a [ImmersedGrain<D>],
    pub(super) tiles: &'a [Tile],
    pub(super) domain: Domain<D>,
}

impl<D: Dim> Frame<'_, D> {
    /// Shares of a span, and the arm \[cells\] of its first cell.
    pub(super) fn of(&self, span: &Span) -> (&ImmersedGrain<D>, &[f64], D::Vec) {
        let grain = &self.grains[span.grain as usize];
        let shares = self.tiles[span.grain as usize].shares(span.share as usize, span.count as usize);
        let centre = D::Vec::from_fn(|axis| span.cell[axis] as f64 + 0.5);
        (grain, shares, centre - centre_in_cells(grain, &self.domain))
    }

    /// Velocity of a grain at an arm \[cells\], and its change from cell to cell along x, over the speed of the lattice.
    pub(super) fn velocities(&self, grain: &ImmersedGrain<D>, arm: D::Vec, per_speed: f64) -> [D::Vec; 2] {
        let Motion { velocity, spin, .. } = grain.motion;
        let turning = spin * (self.domain.spacing * per_speed);
        [velocity * per_speed + D::turn(turning, arm), D::turn(turning, D::Vec::along(0, 1.0))]
    }

    /// Adds what a grain took in the cells of a span, and what it found there.
    pub(super) fn take<T: Real>(&self, span: &Span, cells: &Cells<T>, per_speed: f64, sum: &mut Taken<D>) {
        let (grain, shares, arm) = self.of(span);
        let [start, slope] = self.velocities(grain, arm, per_speed);
        let first = span.at as usize;
        let (per_share, density) =
            (&cells.per_share[first..][..shares.len()], &cells.density[first..][..shares.len()]);
        let momentum =
            cells.momentum.each_ref().map(|values| values.get(first..first + shares.len()).unwrap_or(&[]));
        let mut taken = Load::<D>::ZERO;
        for k in 0..shares.len() {
            let weight = per_share[k].double();
            // An obstacle is there.
            if weight == 0.0 {
                continue;
            }
            let (along, share) = (k as f64, shares[k]);
            let (arm, own) = (arm + D::Vec::along(0, along), start + slope * along);
            let met = D::Vec::from_fn(|axis| momentum[axis][k].double());
            let force = (met - own * density[k].double()) * (share * weight);
            taken.force += force;
            taken.torque += D::cross(arm, force);
            sum.cells += share;
            sum.arms += arm * share;
            sum.momentum += met * share;
            sum.angular_momentum += D::cross(arm, met * share);
        }
        sum.load += taken;
    }
}

/// What a grain took in a step, and the fluid that it found: in lattice units.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken<D: Dim> {
    load: Load<D>,
    cells: f64,
    /// Of all covered cells, weighted with their shares.
    arms: D::Vec,
    momentum: D::Vec,
    angular_momentum: D::Spin,
}

/// Lattice units: of force \[N\], length \[m\] and time \[s\].
pub(super) struct Units {
    pub(super) force: f64,
    pub(super) spacing: f64,
    pub(super) time_step: f64,
}

impl<D: Dim> Taken<D> {
    /// In units, for a grain that covers `whole` cells wherever they are.
    pub(super) fn in_units(&self, units: &Units, whole: f64) -> (Load<D>, CoveredFluid<D>) {
        let Self { load, cells, arms, momentum, angular_momentum } = *self;
        let impulse = units.force * units.time_step;
        let load =
            Load { force: load.force * units.force, torque: load.torque * (units.force * units.spacing) };
        // The centres of cells that a ball cuts do not have its centre as their mean; a uniform stream does not turn all the same.
        let mean_arm = if cells > 0.0 { arms * (1.0 / cells) } else { D::Vec::ZERO };
        let angular_momentum = angular_momentum - D::cross(mean_arm, momentum);
        let covered = CoveredFluid {
            share: if whole > 0.0 { cells / whole } else { 0.0 },
            momentum: momentum * impulse,
            angular_momentum: angular_momentum * (impulse * units.spacing),
        };
        (load, covered)
    }
}

/// The centre of a grain in cells, in the domain where that repeats.
pub(super) fn centre_in_cells<D: Dim>(grain: &ImmersedGrain<D>, domain: &Domain<D>) -> D::Vec {
    let mut centre = (grain.motion.position - domain.origin) * (1.0 / domain.spacing);
    for axis in (0..D::N).filter(|axis| domain.is_periodic[*axis]) {
        let cells = domain.cells[axis] as f64;
        centre -= D::Vec::along(axis, (centre.component(axis) / cells).floor() * cells);
    }
    centre
}
