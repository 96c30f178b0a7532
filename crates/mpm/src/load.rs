//! What particles of a batch give to the nodes.

use crate::batch::BATCH;
use crate::layout::Node;
use granular_core::{Dim, Vector};
use multiversion::multiversion;

/// Particles that give their mass and momentum to nodes, and the force of their stress if it is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Givers<'a, D: Dim> {
    pub(crate) position: &'a [D::Vec],
    pub(crate) velocity: &'a [D::Vec],
    pub(crate) mass: &'a [f64],
    pub(crate) volume: &'a [f64],
    /// Components that are kept; the others are empty.
    pub(crate) stress: [&'a [f64]; 6],
    /// Empty unless shape functions have a width.
    pub(crate) width: &'a [f64],
    /// Forces from outside; empty unless there are any.
    pub(crate) load: &'a [D::Vec],
    /// Moments of the velocity along each axis; empty unless velocities are affine.
    pub(crate) affine: [&'a [D::Vec]; 3],
}

impl<D: Dim> Givers<'_, D> {
    /// Some of them.
    #[inline(always)]
    pub(crate) fn range(&self, from: usize, to: usize) -> Self {
        Self {
            position: &self.position[from..to],
            velocity: &self.velocity[from..to],
            mass: &self.mass[from..to],
            volume: &self.volume[from..to],
            stress: self.stress.map(|component| component.get(from..to).unwrap_or(&[])),
            width: self.width.get(from..to).unwrap_or(&[]),
            load: self.load.get(from..to).unwrap_or(&[]),
            affine: self.affine.map(|along| along.get(from..to).unwrap_or(&[])),
        }
    }
}

/// Lays out what particles give: mass and momentum in proportion to the values of shape functions, and with a number of cells per
/// metre forces from outside likewise, and the force `-V s` in proportion to their derivatives by places in cells.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn load<D: Dim>(rows: &mut [[Node; BATCH]; 4], givers: &Givers<'_, D>, force: Option<f64>) {
    let count = givers.mass.len().min(BATCH);
    let (mass, velocity, volume) =
        (&givers.mass[..count], &givers.velocity[..count], &givers.volume[..count]);
    for k in 0..count {
        let mut row = Node::ZERO;
        row.0[0] = mass[k];
        for axis in 0..D::N {
            row.0[1 + axis] = mass[k] * velocity[k].component(axis);
        }
        rows[0][k] = row;
    }
    let Some(per_cell) = force else {
        for row in &mut rows[1..=D::N] {
            row[..count].fill(Node::ZERO);
        }
        return;
    };
    for (row, &load) in rows[0].iter_mut().zip(givers.load) {
        for axis in 0..D::N {
            row.0[1 + D::N + axis] = load.component(axis);
        }
    }
    let [xx, yy, zz, xy, yz, xz] = givers.stress;
    let (xx, yy, xy) = (&xx[..count], &yy[..count], &xy[..count]);
    if D::N == 2 {
        for k in 0..count {
            let scale = -volume[k] * per_cell;
            rows[1][k] = Node([0.0, 0.0, 0.0, scale * xx[k], scale * xy[k], 0.0, 0.0, 0.0]);
            rows[2][k] = Node([0.0, 0.0, 0.0, scale * xy[k], scale * yy[k], 0.0, 0.0, 0.0]);
        }
        return;
    }
    let (zz, yz, xz) = (&zz[..count], &yz[..count], &xz[..count]);
    for k in 0..count {
        let scale = -volume[k] * per_cell;
        rows[1][k] = Node([0.0, 0.0, 0.0, 0.0, scale * xx[k], scale * xy[k], scale * xz[k], 0.0]);
        rows[2][k] = Node([0.0, 0.0, 0.0, 0.0, scale * xy[k], scale * yy[k], scale * yz[k], 0.0]);
        rows[3][k] = Node([0.0, 0.0, 0.0, 0.0, scale * xz[k], scale * yz[k], scale * zz[k], 0.0]);
    }
}

/// Lays out the momentum that moments of the velocity give, in proportion to the arms of nodes along each axis.
pub(crate) fn load_affine<D: Dim>(rows: &mut [[Node; BATCH]; 4], givers: &Givers<'_, D>) {
    rows[0].fill(Node::ZERO);
    for (along, moments) in givers.affine.iter().enumerate().take(D::N) {
        for ((row, moment), mass) in rows[1 + along].iter_mut().zip(*moments).zip(givers.mass) {
            *row = Node::ZERO;
            for axis in 0..D::N {
                row.0[1 + axis] = mass * moment.component(axis);
            }
        }
    }
}

/// Lays out where a body ends near nodes: the gradient of its volume, in proportion to the derivatives of shape functions, which points out of
/// the body and is as long as its surface near a node is large; then, in proportion to their values, the moment of its volume, in cells from
/// the origin of the lattice, and its volume.
pub(crate) fn load_outline<D: Dim>(
    rows: &mut [[Node; BATCH]; 4],
    givers: &Givers<'_, D>,
    (origin, per_cell): (D::Vec, f64),
) {
    let (position, volume) = (givers.position, givers.volume);
    for ((node, &position), &volume) in rows[0].iter_mut().zip(position).zip(volume) {
        *node = Node::ZERO;
        for axis in 0..D::N {
            node.0[D::N + axis] = (position - origin).component(axis) * (per_cell * volume);
        }
        node.0[2 * D::N] = volume;
    }
    for (axis, row) in rows[1..].iter_mut().enumerate() {
        for (node, volume) in row.iter_mut().zip(volume) {
            *node = Node::ZERO;
            node.0[axis] = volume * per_cell;
        }
    }
}
