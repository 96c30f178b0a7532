//! Edges and corners in which open faces meet.
//!
//! At the centre of such a cell velocity and density are known: given by the faces, or the density carried over
//! from the cells beside. What enters bounces its departure from equilibrium back, as at a face
//! \[ZouHe1997, section II; Kumar2014, eq. 5.30-5.33 with the misprints of 5.31 and 5.33 put right\]. Pairs
//! of directions that pass by the edge outside of the fluid enter from neither end ("buried"): equilibrium gives
//! their momentum, the density given fixes their sum.

use crate::absorbing::Flowing;
use crate::body_force::Force;
use crate::lattice::{Lattice, opposite};
use crate::open::{OpenScheme, dot, equilibrium, moments, regularise};
use crate::populations::Populations;
use crate::real::Real;

/// Cells on one edge or corner of the domain, between open faces.
#[derive(Clone, Debug)]
pub(crate) struct OpenEdge {
    /// Per axis: +1 or -1 towards the inside, 0 along the edge.
    pub(crate) inward: [i32; 3],
    pub(crate) scheme: OpenScheme,
    pub(crate) cells: Vec<EdgeCell>,
}

/// A cell of an edge.
#[derive(Clone, Debug)]
pub(crate) struct EdgeCell {
    pub(crate) place: usize,
    /// Lattice units.
    pub(crate) velocity: [f64; 3],
    /// Density over that at rest, minus one; to which comes what lies beside.
    pub(crate) excess: f64,
    /// Places from whose density that of this cell follows, with weights; none where it is given.
    pub(crate) beside: Vec<(usize, f64)>,
    /// Places whose velocity is added, with weights; none where it is given.
    pub(crate) carried: Vec<(usize, f64)>,
}

impl OpenEdge {
    pub(crate) fn bytes(&self) -> usize {
        let beside: usize =
            self.cells.iter().map(|cell| cell.beside.capacity() + cell.carried.capacity()).sum();
        self.cells.capacity() * size_of::<EdgeCell>() + beside * size_of::<(usize, f64)>()
    }

    pub(crate) fn given_velocities(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.cells.iter().map(|cell| cell.velocity)
    }

    pub(crate) fn apply<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        populations: &mut Populations<T>,
        forces: Force<'_, T>,
    ) {
        for cell in &self.cells {
            let force = forces.at(cell.place);
            let entering = |place: usize| populations.entering::<L, Q>(place).map(T::double);
            let (mut excess, mut velocity) = (cell.excess, cell.velocity);
            for &(place, weight) in &cell.beside {
                excess += weight * moments::<L, Q>(&entering(place), forces.at(place)).0;
            }
            for &(place, weight) in &cell.carried {
                let flowing = Flowing::of::<L, T, Q>(populations, place, forces.at(place));
                for axis in 0..3 {
                    velocity[axis] += weight * flowing.velocity[axis];
                }
            }
            let mut f = entering(cell.place);
            fill::<L, Q>(&mut f, self.inward, velocity, excess, force);
            if self.scheme == OpenScheme::Regularised {
                regularise::<L, Q>(&mut f, excess, velocity, force);
            }
            populations.set_entering::<L, Q>(cell.place, f.map(T::of));
        }
    }
}

/// Finds the unknown populations of a cell with open faces on the sides away from `inward`.
fn fill<L: Lattice<Q>, const Q: usize>(
    f: &mut [f64; Q],
    inward: [i32; 3],
    u: [f64; 3],
    excess: f64,
    force: [f64; 3],
) {
    let density = 1.0 + excess;
    let enters = |i: usize| (0..3).any(|axis| inward[axis] * L::VELOCITIES[i][axis] == 1);
    let is_bounced = |i: usize| enters(i) && !enters(opposite(i));
    let is_buried = |i: usize| enters(i) && enters(opposite(i));
    for i in (0..Q).filter(|i| is_bounced(*i)) {
        let (along, pushed) = (dot(L::VELOCITIES[i], u), dot(L::VELOCITIES[i], force));
        f[i] = f[opposite(i)] + 6.0 * L::WEIGHTS[i] * density * along - 3.0 * L::WEIGHTS[i] * pushed;
    }
    let at_rest = equilibrium::<L, Q>(excess, u);
    for i in (0..Q).filter(|i| is_buried(*i)) {
        let pushed = dot(L::VELOCITIES[i], force);
        f[i] = at_rest[i] - 1.5 * L::WEIGHTS[i] * pushed + buried_departure::<L, Q>(f, &at_rest, inward, i);
    }
    let (_, momentum) = moments::<L, Q>(f, force);
    for axis in 0..3 {
        let missing = density * u[axis] - momentum[axis];
        let takes = |i: usize| {
            let velocity = L::VELOCITIES[i];
            let straight = velocity.iter().map(|c| c * c).sum::<i32>() == 1;
            is_bounced(i) && velocity[axis] != 0 && (straight || inward[axis] == 0)
        };
        let count = (0..Q).filter(|i| takes(*i)).count() as f64;
        for i in (0..Q).filter(|i| takes(*i)) {
            f[i] += f64::from(L::VELOCITIES[i][axis]) * missing / count;
        }
    }
    let missing = excess - f.iter().sum::<f64>();
    let buried = (0..Q).filter(|i| is_buried(*i)).count() as f64;
    for i in (0..Q).filter(|i| is_buried(*i)) {
        f[i] += missing / buried;
    }
}

/// Departure from equilibrium along a buried direction: the stress of the two directions along the axes and of the
/// diagonal between them, which have bounced back, is that of the other diagonal too.
fn buried_departure<L: Lattice<Q>, const Q: usize>(
    f: &[f64; Q],
    at_rest: &[f64; Q],
    inward: [i32; 3],
    buried: usize,
) -> f64 {
    let departure = |velocity: [i32; 3]| {
        L::VELOCITIES.iter().position(|c| *c == velocity).map_or(0.0, |i| f[i] - at_rest[i])
    };
    let is_across = |axis: usize| L::VELOCITIES[buried][axis] != 0;
    let diagonal: [i32; 3] = std::array::from_fn(|axis| if is_across(axis) { inward[axis] } else { 0 });
    let mut straight = 0.0;
    for across in (0..3).filter(|axis| is_across(*axis)) {
        straight += departure(std::array::from_fn(|axis| if axis == across { inward[axis] } else { 0 }));
    }
    2.0 * L::WEIGHTS[buried] / L::WEIGHTS[1] * straight - departure(diagonal)
}
