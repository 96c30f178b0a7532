//! Faces through which fluid enters and leaves, with velocity or pressure given at the centres of the
//! cells next to the face.
//!
//! What enters from outside follows by bouncing the departure from equilibrium back, with the
//! transverse momentum put right \[ZouHe1997; HechtHarting2010\]. The regularised form then rebuilds all populations of the cell
//! from density, velocity and stress \[Latt2008\], which is stable at higher Reynolds numbers. Where open faces
//! meet, see [`crate::edges`].

use crate::absorbing::{Flowing, Inner, Normal, Seen, Sums};
use crate::body_force::Force;
use crate::edges::OpenEdge;
use crate::lattice::{Lattice, opposite};
use crate::populations::Populations;
use crate::real::Real;

/// How unknown populations at an open face are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OpenScheme {
    /// Non-equilibrium bounce-back \[ZouHe1997\]; exact for a parabolic profile at `Lambda = 3/16`.
    #[default]
    ZouHe,
    /// The same, then all populations rebuilt from density, velocity and stress \[Latt2008\].
    Regularised,
}

/// What is known at an open face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Known {
    Velocity,
    /// Density, and the velocity along the face.
    Density,
    /// What travels inwards, see [`crate::absorbing`].
    Wave,
}

/// All open faces, and the edges and corners in which they meet.
#[derive(Clone, Debug, Default)]
pub(crate) struct Open {
    pub(crate) faces: Vec<OpenFace>,
    /// Edges before corners: those read cells beside them.
    pub(crate) edges: Vec<OpenEdge>,
}

/// A cell of an open face.
#[derive(Clone, Debug)]
pub(crate) struct OpenCell {
    pub(crate) place: usize,
    /// Lattice units.
    pub(crate) velocity: [f64; 3],
    /// Density over that at rest, minus one.
    pub(crate) excess: f64,
}

/// Cells of one open face that lie on no other.
#[derive(Clone, Debug)]
pub(crate) struct OpenFace {
    pub(crate) axis: usize,
    /// +1 when the inside lies towards higher coordinates.
    pub(crate) inward: i32,
    pub(crate) known: Known,
    pub(crate) scheme: OpenScheme,
    pub(crate) cells: Vec<OpenCell>,
    /// Of a face that absorbs, for each cell; those without hold the pressure given.
    pub(crate) inner: Vec<Option<Inner>>,
    pub(crate) seen: Seen,
}

/// Populations in equilibrium, without their weights.
pub(crate) fn equilibrium<L: Lattice<Q>, const Q: usize>(excess: f64, u: [f64; 3]) -> [f64; Q] {
    let squared: f64 = u.iter().map(|component| component * component).sum();
    std::array::from_fn(|i| {
        let along = dot(L::VELOCITIES[i], u);
        let flow = 3.0 * along + 4.5 * along * along - 1.5 * squared;
        L::WEIGHTS[i] * (excess + (1.0 + excess) * flow)
    })
}

pub(crate) fn dot(velocity: [i32; 3], vector: [f64; 3]) -> f64 {
    (0..3).map(|axis| f64::from(velocity[axis]) * vector[axis]).sum()
}

/// Density excess and momentum, half of the force included.
pub(crate) fn moments<L: Lattice<Q>, const Q: usize>(f: &[f64; Q], force: [f64; 3]) -> (f64, [f64; 3]) {
    let mut momentum = force.map(|component| 0.5 * component);
    for (f, velocity) in f.iter().zip(L::VELOCITIES) {
        for axis in 0..3 {
            momentum[axis] += f64::from(velocity[axis]) * f;
        }
    }
    (f.iter().sum(), momentum)
}

impl Open {
    pub(crate) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    pub(crate) fn bytes(&self) -> usize {
        let faces = self.faces.iter().map(|face| {
            face.cells.capacity() * size_of::<OpenCell>()
                + face.inner.iter().flatten().map(Inner::bytes).sum::<usize>()
        });
        faces.sum::<usize>() + self.edges.iter().map(OpenEdge::bytes).sum::<usize>()
    }

    /// Velocities that are given, in lattice units.
    pub(crate) fn given_velocities(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let faces = self.faces.iter().flat_map(|face| &face.cells).map(|cell| cell.velocity);
        faces.chain(self.edges.iter().flat_map(OpenEdge::given_velocities))
    }

    /// What faces that absorb know, to be saved.
    pub(crate) fn seen(&self) -> Vec<[f64; 2]> {
        self.absorbing().map(|face| [face.seen.missed, face.seen.inwards]).collect()
    }

    /// Puts what faces that absorb knew; one entry for each.
    pub(crate) fn set_seen(&mut self, values: &[[f64; 2]]) {
        let absorbing = self.faces.iter_mut().filter(|face| face.known == Known::Wave);
        for (face, &[missed, inwards]) in absorbing.zip(values) {
            face.seen = Seen { missed, inwards };
        }
    }

    fn absorbing(&self) -> impl Iterator<Item = &OpenFace> {
        self.faces.iter().filter(|face| face.known == Known::Wave)
    }

    /// Looks at a flow that was put from outside, or at other cells than before.
    pub(crate) fn look<L: Lattice<Q>, T: Real, const Q: usize>(
        &mut self,
        populations: &Populations<T>,
        force: Force<'_, T>,
    ) {
        for face in self.faces.iter_mut().filter(|face| face.known == Known::Wave) {
            face.seen.inwards = face.inwards::<L, T, Q>(populations, force);
        }
    }

    pub(crate) fn apply<L: Lattice<Q>, T: Real, const Q: usize>(
        &mut self,
        populations: &mut Populations<T>,
        force: Force<'_, T>,
    ) {
        for face in &mut self.faces {
            face.apply::<L, T, Q>(populations, force);
        }
        for edge in &self.edges {
            edge.apply::<L, T, Q>(populations, force);
        }
    }
}

impl OpenFace {
    fn apply<L: Lattice<Q>, T: Real, const Q: usize>(
        &mut self,
        populations: &mut Populations<T>,
        forces: Force<'_, T>,
    ) {
        if self.known == Known::Wave {
            let sums = self.absorb::<L, T, Q>(populations, forces);
            self.seen.learn(&sums);
            return;
        }
        for &OpenCell { place, velocity, excess } in &self.cells {
            let force = forces.at(place);
            let mut f = populations.entering::<L, Q>(place).map(T::double);
            let (excess, velocity) = self.fill::<L, Q>(&mut f, velocity, excess, force);
            if self.scheme == OpenScheme::Regularised {
                regularise::<L, Q>(&mut f, excess, velocity, force);
            }
            populations.set_entering::<L, Q>(place, f.map(T::of));
        }
    }

    fn normal(&self) -> Normal {
        Normal { axis: self.axis, inward: f64::from(self.inward) }
    }

    /// Lets sound leave.
    fn absorb<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        populations: &mut Populations<T>,
        forces: Force<'_, T>,
    ) -> Sums {
        let (normal, mut sums) = (self.normal(), Sums::default());
        for (&OpenCell { place, velocity, excess }, inner) in self.cells.iter().zip(&self.inner) {
            let force = forces.at(place);
            let mut f = populations.entering::<L, Q>(place).map(T::double);
            if let Some(inner) = inner {
                let known = self.known_sum::<L, Q>(&f, force);
                let flow_in = |place| Flowing::of::<L, T, Q>(populations, place, forces.at(place));
                let wave = inner.wave(known, (excess, self.seen.missed), normal, flow_in);
                let (excess, velocity) = self.fill::<L, Q>(&mut f, wave.velocity, wave.excess, force);
                sums.add(normal.inwards(excess, velocity), &wave, inner.share);
            } else {
                self.fill::<L, Q>(&mut f, velocity, excess, force);
            }
            populations.set_entering::<L, Q>(place, f.map(T::of));
        }
        sums
    }

    /// What travels inwards, mean over the cells of a face that absorbs and those within.
    fn inwards<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        populations: &Populations<T>,
        forces: Force<'_, T>,
    ) -> f64 {
        let of = |place| Flowing::of::<L, T, Q>(populations, place, forces.at(place)).inwards(self.normal());
        let pairs = self.cells.iter().zip(&self.inner);
        let pairs = pairs.filter_map(|(cell, inner)| Some([cell.place, inner.as_ref()?.place]));
        let (sum, count) = pairs.fold((0.0, 0), |(sum, count), [at_face, within]| {
            (sum + 0.5 * (of(at_face) + of(within)), count + 1)
        });
        sum / f64::from(count.max(1))
    }

    /// Density times one less the velocity inwards, which the known populations give.
    fn known_sum<L: Lattice<Q>, const Q: usize>(&self, f: &[f64; Q], force: [f64; 3]) -> f64 {
        let mut known = 1.0 - 0.5 * f64::from(self.inward) * force[self.axis];
        for i in 0..Q {
            known += match self.inward * L::VELOCITIES[i][self.axis] {
                0 => f[i],
                1 => 0.0,
                _ => 2.0 * f[i],
            };
        }
        known
    }

    /// Finds the unknown populations; returns density excess and velocity.
    fn fill<L: Lattice<Q>, const Q: usize>(
        &self,
        f: &mut [f64; Q],
        mut u: [f64; 3],
        mut excess: f64,
        force: [f64; 3],
    ) -> (f64, [f64; 3]) {
        let inwards = |i: usize| self.inward * L::VELOCITIES[i][self.axis];
        let known = self.known_sum::<L, Q>(f, force);
        match self.known {
            Known::Velocity => excess = known / (1.0 - f64::from(self.inward) * u[self.axis]) - 1.0,
            Known::Density | Known::Wave => {
                u[self.axis] = f64::from(self.inward) * (1.0 - known / (1.0 + excess))
            }
        }
        let density = 1.0 + excess;
        for i in 0..Q {
            if inwards(i) == 1 {
                let (along, pushed) = (dot(L::VELOCITIES[i], u), dot(L::VELOCITIES[i], force));
                f[i] = f[opposite(i)] + 6.0 * L::WEIGHTS[i] * density * along - 3.0 * L::WEIGHTS[i] * pushed;
            }
        }
        let (_, momentum) = moments::<L, Q>(f, force);
        for i in 0..Q {
            if inwards(i) != 1 {
                continue;
            }
            let velocity = L::VELOCITIES[i];
            let straight = velocity.iter().map(|c| c * c).sum::<i32>() == 1;
            for axis in 0..3 {
                let missing = density * u[axis] - momentum[axis];
                if axis != self.axis {
                    f[i] += 0.5 * f64::from(velocity[axis]) * missing;
                } else if straight {
                    f[i] += f64::from(velocity[axis]) * missing;
                }
            }
        }
        (excess, u)
    }
}

/// Keeps density, velocity and stress, and nothing else.
pub(crate) fn regularise<L: Lattice<Q>, const Q: usize>(
    f: &mut [f64; Q],
    excess: f64,
    u: [f64; 3],
    force: [f64; 3],
) {
    let at_rest = equilibrium::<L, Q>(excess, u);
    let mut stress = [[0.0; 3]; 3];
    for i in 0..Q {
        let velocity = L::VELOCITIES[i].map(f64::from);
        for (a, row) in stress.iter_mut().enumerate() {
            for (b, value) in row.iter_mut().enumerate() {
                *value += velocity[a] * velocity[b] * (f[i] - at_rest[i]);
            }
        }
    }
    let trace = (0..3).map(|axis| stress[axis][axis]).sum::<f64>();
    for i in 0..Q {
        let velocity = L::VELOCITIES[i].map(f64::from);
        let mut projected = -trace / 3.0;
        for (a, row) in stress.iter().enumerate() {
            for (b, value) in row.iter().enumerate() {
                projected += velocity[a] * velocity[b] * value;
            }
        }
        f[i] = at_rest[i] + L::WEIGHTS[i] * (4.5 * projected - 1.5 * dot(L::VELOCITIES[i], force));
    }
}
