//! The pyramid of Mohr-Coulomb in principal stresses, and the return to it.
//!
//! Symbols: `k` and `m` of friction and dilation, `y = 2 c sqrt(k)` the strength in uniaxial compression, trial stress
//! `b1 >= b2 >= b3`. Plane: `k s1 - s3 = y`, flow `(m, 0, -1)`. Edges: where `s1 = s2` the line through `(0, 0, -y)` along
//! `(1, 1, k)`; two planes meet there, both of whose flows are at right angles to `(1, 1, m)`. Where `s2 = s3` the line through
//! `(0, -y, -y)` along `(1, k, k)`, with `(1, m, m)`. A trial stress returns to the point of a line for which the lost strain is
//! at right angles to the latter too.

use super::{Returned, Strength};
use crate::elastic::LinearElastic;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pyramid {
    pub(super) k: f64,
    pub(super) m: f64,
    /// Strength in uniaxial compression.
    pub(super) y: f64,
    pub(super) apex: f64,
    /// Stress that the flow of the plane takes away, over the excess.
    pub(super) fall: [f64; 3],
    /// What the stress along the edges follows from: `t = w . b + w0`, for `s1 = s2` and for `s2 = s3`.
    pub(super) edges: [([f64; 3], f64); 2],
    /// `1 / (2 G)`.
    pub(super) shear_compliance: f64,
    /// `1 / (3 K)`.
    pub(super) volumetric_compliance: f64,
    /// `nu / E`: the part of the compliance that acts on the trace.
    cross_compliance: f64,
}

impl Pyramid {
    pub(super) fn new(elastic: &LinearElastic, strength: &Strength) -> Self {
        let passive = |angle: f64| (1.0 + angle.sin()) / (1.0 - angle.sin());
        let (k, m) = (passive(strength.friction_angle), passive(strength.dilation_angle));
        let y = 2.0 * strength.cohesion * k.sqrt();
        let (bulk, shear) = (elastic.bulk(), elastic.shear());
        let lambda = bulk - shear * (2.0 / 3.0);
        let flow =
            [lambda * (m - 1.0) + 2.0 * shear * m, lambda * (m - 1.0), lambda * (m - 1.0) - 2.0 * shear];
        let stiffness = k * flow[0] - flow[2];
        let mut pyramid = Self {
            k,
            m,
            y,
            apex: strength.apex(),
            fall: flow.map(|part| part / stiffness),
            edges: [([0.0; 3], 0.0); 2],
            shear_compliance: 0.5 / shear,
            volumetric_compliance: 1.0 / (3.0 * bulk),
            cross_compliance: lambda / (6.0 * shear * bulk),
        };
        pyramid.edges = [
            pyramid.edge([0.0, 0.0, -y], [1.0, 1.0, k], [1.0, 1.0, m]),
            pyramid.edge([0.0, -y, -y], [1.0, k, k], [1.0, m, m]),
        ];
        pyramid
    }

    /// Weights for a line through `point` along `line`, with lost strain at right angles to `flow`.
    fn edge(&self, point: [f64; 3], line: [f64; 3], flow: [f64; 3]) -> ([f64; 3], f64) {
        let weights = self.strain(flow);
        let scale = 1.0 / dot(weights, line);
        let weights = weights.map(|weight| weight * scale);
        (weights, -dot(weights, point))
    }

    /// Elastic strain of a stress, both in principal values.
    #[inline(always)]
    pub(super) fn strain(&self, stress: [f64; 3]) -> [f64; 3] {
        let mean = self.cross_compliance * (stress[0] + stress[1] + stress[2]);
        stress.map(|value| self.shear_compliance * value - mean)
    }

    /// Work of a stress on the strain that belongs to a loss of stress.
    #[inline(always)]
    pub(super) fn work(&self, stress: [f64; 3], lost: [f64; 3]) -> f64 {
        dot(stress, self.strain(lost))
    }

    #[inline(always)]
    pub(super) fn excess(&self, stress: [f64; 3]) -> f64 {
        self.k * stress[0] - stress[2] - self.y
    }

    /// Stress on the plane of the two extreme values.
    #[inline(always)]
    pub(super) fn on_plane(&self, b: [f64; 3]) -> [f64; 3] {
        let excess = self.excess(b);
        [b[0] - excess * self.fall[0], b[1] - excess * self.fall[1], b[2] - excess * self.fall[2]]
    }

    /// Largest stress on an edge.
    #[inline(always)]
    pub(super) fn along_edge(&self, edge: usize, b: [f64; 3]) -> f64 {
        let (weights, constant) = self.edges[edge];
        dot(weights, b) + constant
    }

    /// The smallest stress that goes with the largest.
    #[inline(always)]
    pub(super) fn smallest(&self, largest: f64) -> f64 {
        self.k * largest - self.y
    }

    /// Whether the flow of the plane meets the edge of the two larger stresses before that of the two smaller ones.
    #[inline(always)]
    pub(super) fn meets_first_edge(&self, b: [f64; 3]) -> bool {
        b[0] - b[1] < self.m * (b[1] - b[2])
    }

    /// The stress to which a trial stress beyond the strength returns.
    #[inline(always)]
    pub(super) fn returned(&self, b: [f64; 3]) -> Returned {
        let plane = self.on_plane(b);
        let is_on_plane = plane[0] >= plane[1] && plane[1] >= plane[2];
        let is_first = self.meets_first_edge(b);
        let (first, second) = (self.along_edge(0, b), self.along_edge(1, b));
        let along = if is_first { first } else { second };
        let at_tip = !is_on_plane && along > self.apex;
        // The product keeps what is not finite.
        let along = if at_tip { self.apex + 0.0 * along } else { along };
        let smallest = self.smallest(along);
        let smallest = if at_tip { along } else { smallest };
        let edge = [along, if is_first { along } else { smallest }, smallest];
        let values = std::array::from_fn(|i| if is_on_plane { plane[i] } else { edge[i] });
        Returned { values, at_tip }
    }
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
