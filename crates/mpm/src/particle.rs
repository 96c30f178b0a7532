//! One particle, as it is put in and asked for.

use granular_core::{Dim, Linear, SetupError, SymmetricTensor, Vector};

/// A particle: a piece of a body.
#[derive(Clone, Copy, Debug)]
pub struct Particle<D: Dim> {
    /// Place \[m\].
    pub position: D::Vec,
    /// Velocity \[m/s\].
    pub velocity: D::Vec,
    /// Volume \[m^3; m^2 in the plane\].
    pub volume: f64,
    /// Stress \[Pa\], positive in tension; in the plane with the component across it.
    pub stress: SymmetricTensor,
}

impl<D: Dim> Particle<D> {
    /// A particle at rest without stress.
    pub fn at(position: D::Vec, volume: f64) -> Self {
        Self { position, velocity: D::Vec::ZERO, volume, stress: SymmetricTensor::ZERO }
    }

    /// The same particle with a velocity \[m/s\].
    pub fn moving(self, velocity: D::Vec) -> Self {
        Self { velocity, ..self }
    }

    /// The same particle with a stress \[Pa\].
    pub fn stressed(self, stress: SymmetricTensor) -> Self {
        Self { stress, ..self }
    }

    /// Particles that fill the block between two corners \[m\] on a lattice, at the middles of squares or cubes with this edge
    /// \[m\], or one a little smaller or larger along an axis that it does not divide. A cell of the grid has 16 of them in the plane when
    /// the edge is a quarter of the cell.
    pub fn filling(low: D::Vec, high: D::Vec, edge: f64) -> Vec<Self> {
        Self::filling_part(low, high, edge, |_| true)
    }

    /// As [`Particle::filling`], but only those whose middles are `inside`.
    pub fn filling_part(low: D::Vec, high: D::Vec, edge: f64, inside: impl Fn(D::Vec) -> bool) -> Vec<Self> {
        let size = high - low;
        let counts: [usize; 3] = std::array::from_fn(|axis| {
            if axis < D::N { (size.component(axis) / edge).round().max(1.0) as usize } else { 1 }
        });
        let edges: [f64; 3] =
            std::array::from_fn(
                |axis| {
                    if axis < D::N { size.component(axis) / counts[axis] as f64 } else { 1.0 }
                },
            );
        let volume = edges.iter().product();
        let all = counts.iter().product::<usize>();
        let place = |k: usize| {
            let mut at = low;
            let mut rest = k;
            for axis in 0..D::N {
                at += D::Vec::along(axis, ((rest % counts[axis]) as f64 + 0.5) * edges[axis]);
                rest /= counts[axis];
            }
            at
        };
        (0..all).map(place).filter(|&at| inside(at)).map(|at| Self::at(at, volume)).collect()
    }

    pub(crate) fn check(&self, index: usize) -> Result<(), SetupError> {
        let refuse = |what: &str, value: f64, allowed| {
            Err(SetupError::new(what, value, allowed).of(format_args!("particle {index}")))
        };
        if !(self.position.is_finite() && self.velocity.is_finite()) {
            return refuse("position or velocity", f64::NAN, "finite");
        }
        if !(self.volume > 0.0 && self.volume.is_finite()) {
            return refuse("volume", self.volume, "positive and finite");
        }
        let SymmetricTensor { xx, yy, zz, xy, yz, xz } = self.stress;
        if ![xx, yy, zz, xy, yz, xz].iter().all(|component| component.is_finite()) {
            return refuse("stress", f64::NAN, "finite");
        }
        Ok(())
    }
}
