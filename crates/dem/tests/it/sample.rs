//! Samples for tests: jittered lattices from a small generator of its own.

use granular_core::{Dim, Linear, Spin, Vector};
use granular_dem::{Dem, Grain, MaterialId, Materials, Options, Setup, Wall};

/// Deterministic numbers (splitmix64): tests must not change with a dependency.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 2.0_f64.powi(-53)
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Components in [-size, size).
    pub(crate) fn vector<D: Dim>(&mut self, size: f64) -> D::Vec {
        (0..D::N).fold(D::Vec::ZERO, |v, axis| v + D::Vec::along(axis, self.within(-size, size)))
    }

    pub(crate) fn spin<D: Dim>(&mut self, size: f64) -> D::Spin {
        D::Spin::of_components(std::array::from_fn(|_| self.within(-size, size)))
    }
}

/// What a lattice is like; lengths in metres.
#[derive(Clone, Copy)]
pub(crate) struct Lattice {
    /// Grains along each axis.
    pub(crate) side: usize,
    pub(crate) spacing: f64,
    pub(crate) jitter: f64,
    pub(crate) radii: (f64, f64),
    pub(crate) speed: f64,
    pub(crate) seed: u64,
}

impl Default for Lattice {
    /// Grains of about 1 mm, most of them in touch, all of them in motion.
    fn default() -> Self {
        Self { side: 48, spacing: 1e-3, jitter: 5e-6, radii: (0.48e-3, 0.502e-3), speed: 1.0, seed: 1 }
    }
}

impl Lattice {
    /// The grains; their materials take turns.
    pub(crate) fn grains<D: Dim>(&self, materials: &[MaterialId]) -> Vec<Grain<D>> {
        let mut random = Random::new(self.seed);
        let grain = |index: usize| {
            let place = (0..D::N).fold(D::Vec::ZERO, |place, axis| {
                let number = index / self.side.pow(axis as u32) % self.side;
                place + D::Vec::along(axis, self.spacing * (number as f64 + 0.5))
            });
            let place = place + random.vector::<D>(self.jitter);
            let radius = random.within(self.radii.0, self.radii.1);
            let material = materials[index % materials.len()];
            Grain::at(place, radius, material).moving(random.vector::<D>(self.speed))
        };
        (0..self.side.pow(D::N as u32)).map(grain).collect()
    }

    /// Planes on all sides.
    pub(crate) fn walls<D: Dim>(&self, material: MaterialId) -> Vec<Wall<D>> {
        let far = self.spacing * self.side as f64;
        let sides = (0..D::N).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]);
        let wall = |(axis, sign): (usize, f64)| {
            let point = if sign > 0.0 { D::Vec::ZERO } else { D::Vec::along(axis, far) };
            let name = format!("{}{}", D::AXES[axis], if sign > 0.0 { "_low" } else { "_high" });
            Wall::plane(&name, point, D::Vec::along(axis, sign), material).unwrap()
        };
        sides.map(wall).collect()
    }
}

/// Gravity downwards \[m/s^2\].
pub(crate) fn down<D: Dim>(size: f64) -> D::Vec {
    D::Vec::along(D::UP, -size)
}

/// A solver without walls or gravity.
pub(crate) fn free<D: Dim>(materials: Materials, grains: Vec<Grain<D>>, options: Options) -> Dem<D> {
    Dem::new(Setup { materials, grains, walls: vec![], gravity: D::Vec::ZERO, options }).unwrap()
}
