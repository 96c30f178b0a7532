//! What enters cells from beyond the fluid: lists of links, applied after each step.
//!
//! A link replaces the population that enters a cell along one direction by populations that left cells in
//! the same step. No link writes what another reads, so their order does not matter.

use crate::lattice::{Lattice, opposite};
use crate::mass::{counted, due};
use crate::open::dot;
use crate::populations::{Grid, Layout, Populations};
use crate::real::Real;
use crate::wall_faces::SlipLink;

/// A population: the place of a cell and a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Port {
    pub(crate) place: usize,
    pub(crate) direction: usize,
}

/// Index of a population in both layouts.
pub(crate) type Both = [u32; 2];

pub(crate) fn entering<L: Lattice<Q>, const Q: usize>(grid: &Grid, port: Port) -> Both {
    [Layout::Natural, Layout::Turned]
        .map(|layout| grid.entering::<L, Q>(layout, port.place, port.direction) as u32)
}

pub(crate) fn leaving<L: Lattice<Q>, const Q: usize>(grid: &Grid, port: Port) -> Both {
    [Layout::Natural, Layout::Turned]
        .map(|layout| grid.leaving::<L, Q>(layout, port.place, port.direction) as u32)
}

/// Links that copy: walls half-way between cells, free slip, periodic faces.
#[derive(Clone, Debug)]
pub(crate) struct Copies<T> {
    pub(crate) resting: Vec<(Both, Both)>,
    /// With what a moving wall adds.
    pub(crate) moving: Vec<(Both, Both, T)>,
    /// Of walls along which the fluid slips.
    pub(crate) slipping: Vec<SlipLink<T>>,
}

impl<T: Real> Copies<T> {
    pub(crate) fn new() -> Self {
        Self { resting: Vec::new(), moving: Vec::new(), slipping: Vec::new() }
    }

    /// What enters at `to` is what left at `from`, plus `added`.
    pub(crate) fn push<L: Lattice<Q>, const Q: usize>(
        &mut self,
        grid: &Grid,
        to: Port,
        from: Port,
        added: f64,
    ) {
        let (to, from) = (entering::<L, Q>(grid, to), leaving::<L, Q>(grid, from));
        if added == 0.0 {
            self.resting.push((to, from));
        } else {
            self.moving.push((to, from, T::of(added)));
        }
    }

    pub(crate) fn apply(&self, populations: &mut Populations<T>) {
        let at = populations.layout as usize;
        let values = &mut populations.values[..];
        for (to, from) in &self.resting {
            values[to[at] as usize] = values[from[at] as usize];
        }
        for (to, from, added) in &self.moving {
            values[to[at] as usize] = values[from[at] as usize] + *added;
        }
        self.slipping.iter().for_each(|link| link.apply(populations));
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<(Both, Both)>() * self.resting.capacity()
            + size_of::<(Both, Both, T)>() * self.moving.capacity()
            + size_of::<SlipLink<T>>() * self.slipping.capacity()
    }
}

/// How a curved wall is met by a link that it cuts at the fraction `q` of its length. No scheme lets mass through: what
/// interpolation would lose or gain in a step, each obstacle gives back over all its links in the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum WallScheme {
    /// Half-way, wherever the wall is.
    HalfWay,
    /// Linear interpolation by cases \[Bouzidi2001\].
    #[default]
    Bouzidi,
    /// One linear formula for all `q` \[Yu2003; Kumar2014, eq. 5.51\].
    Yu,
}

impl WallScheme {
    /// The scheme of a link without a cell behind: beyond half of the link interpolation does without it.
    fn possible(self, q: f64, has_cell_behind: bool) -> Self {
        match self {
            Self::HalfWay => self,
            _ if has_cell_behind => self,
            _ if q >= 0.5 => Self::Bouzidi,
            _ => Self::HalfWay,
        }
    }

    /// Weights of what left the cell towards the wall, what left the cell behind towards the wall, and what left the
    /// cell away from the wall.
    pub(crate) fn weights(self, q: f64, has_cell_behind: bool) -> [f64; 3] {
        match self.possible(q, has_cell_behind) {
            Self::HalfWay => [1.0, 0.0, 0.0],
            Self::Bouzidi if q < 0.5 => [2.0 * q, 1.0 - 2.0 * q, 0.0],
            Self::Bouzidi => [0.5 / q, 0.0, 1.0 - 0.5 / q],
            Self::Yu => [q / (1.0 + q), (1.0 - q) / (1.0 + q), q / (1.0 + q)],
        }
    }

    /// Factor of `-2 w_i rho c_i . u_w / c_s^2` for a moving wall.
    pub(crate) fn motion(self, q: f64, has_cell_behind: bool) -> f64 {
        match self.possible(q, has_cell_behind) {
            Self::HalfWay => 1.0,
            Self::Bouzidi if q < 0.5 => 1.0,
            Self::Bouzidi => 0.5 / q,
            Self::Yu => 1.0 / (1.0 + q),
        }
    }
}

/// A link cut by an obstacle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// Cell in the fluid and direction towards the wall.
    pub(crate) port: Port,
    /// Cell behind and direction towards the wall, as it lies or is seen there.
    pub(crate) behind: Option<Port>,
    /// Direction in which the wall is met: seen in a mirror, another one than that of `port`.
    pub(crate) towards: usize,
    /// Weights after [`WallScheme::weights`].
    pub(crate) weights: [f64; 3],
    /// Factor of the wall's motion after [`WallScheme::motion`].
    pub(crate) motion: f64,
    /// From the centre of the obstacle to the wall \[cells\].
    pub(crate) arm: [f64; 3],
}

/// All links of one obstacle.
#[derive(Clone, Debug)]
pub(crate) struct Cuts<T> {
    pub(crate) links: Vec<CutLink<T>>,
    /// Sum of the lattice weights of all links.
    weight: f64,
    /// Mass that came off the fluid and is not given back yet, see [`crate::mass`].
    pub(crate) kept: i64,
    /// Mass that goes with the velocity of the obstacle in each step, without its spin.
    swept: i64,
    /// Force and torque of the fluid on the obstacle in the last step, in lattice units.
    pub(crate) force: [f64; 3],
    pub(crate) torque: [f64; 3],
}

#[derive(Clone, Debug)]
pub(crate) struct CutLink<T> {
    pub(crate) to: Both,
    pub(crate) from: [Both; 3],
    pub(crate) weights: [T; 3],
    pub(crate) added: T,
    /// Weight of its direction on the lattice.
    pub(crate) share: T,
    direction: u8,
    /// What a velocity of the wall along the link adds, by its component.
    pull: f64,
    arm: [f64; 3],
    velocity: [f64; 3],
}

/// What enters from a wall, from what left the cell towards it, the cell behind towards it, and the cell away from it.
#[inline]
pub(crate) fn entering_cut<T: Real>([near, behind, away]: [T; 3], [a, b, c]: [T; 3], added: T) -> T {
    a * near + b * behind + c * away + added
}

impl<T: Real> Cuts<T> {
    /// Links of a wall at rest.
    pub(crate) fn new<L: Lattice<Q>, const Q: usize>(grid: &Grid, cuts: &[Cut]) -> Self {
        let link = |cut: &Cut| {
            let Port { place, direction } = cut.port;
            let back = opposite(direction);
            let away = leaving::<L, Q>(grid, Port { place, direction: back });
            let near = leaving::<L, Q>(grid, cut.port);
            // Without a cell behind, the weight is zero and any place does.
            let behind = cut.behind.map_or(near, |behind| leaving::<L, Q>(grid, behind));
            CutLink {
                to: entering::<L, Q>(grid, Port { place, direction: back }),
                from: [near, behind, away],
                weights: cut.weights.map(T::of),
                added: T::of(0.0),
                share: T::of(L::WEIGHTS[direction]),
                direction: cut.towards as u8,
                pull: -6.0 * L::WEIGHTS[cut.towards] * cut.motion,
                arm: cut.arm,
                velocity: [0.0; 3],
            }
        };
        // Weights are whole multiples of 1/36: their sum does not depend on the order.
        let weight =
            cuts.iter().map(|cut| (36.0 * L::WEIGHTS[cut.port.direction]).round()).sum::<f64>() / 36.0;
        let links = cuts.iter().map(link).collect();
        Self { links, weight, kept: 0, swept: 0, force: [0.0; 3], torque: [0.0; 3] }
    }

    /// Takes the velocity \[cells per step\] of the wall at the end of each arm \[cells\]; without an arm it is that of the centre.
    pub(crate) fn set_velocity<L: Lattice<Q>, const Q: usize>(
        &mut self,
        velocity: impl Fn([f64; 3]) -> [f64; 3],
    ) {
        let centre = velocity([0.0; 3]);
        self.swept = 0;
        for link in &mut self.links {
            let (way, weight) = (L::VELOCITIES[link.direction as usize], L::WEIGHTS[link.direction as usize]);
            link.velocity = velocity(link.arm);
            link.added = T::of(link.pull * dot(way, link.velocity));
            self.swept = self.swept.wrapping_add(counted(6.0 * weight * dot(way, centre)));
        }
    }

    /// Leaves with the obstacle what came off the fluid in a step, but for what it swept.
    pub(crate) fn keep_of_step(&mut self, taken: i64) {
        self.kept = self.kept.wrapping_add(taken.wrapping_sub(self.swept));
    }

    /// The density that all links give back in the next step.
    pub(crate) fn due(&self) -> T {
        due(self.kept, self.weight)
    }

    /// Applies all links, and adds up force and torque in their order. Momentum is exchanged in the
    /// frame of the wall, so that an obstacle carried by a stream feels no force \[Wen2014\].
    pub(crate) fn apply<L: Lattice<Q>, const Q: usize>(&mut self, populations: &mut Populations<T>) {
        let at = populations.layout as usize;
        let values = &mut populations.values[..];
        let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
        let due = self.due();
        let mut taken = 0_i64;
        for link in &self.links {
            let left = link.from.map(|from| values[from[at] as usize]);
            let entering = entering_cut(left, link.weights, link.added + link.share * due);
            values[link.to[at] as usize] = entering;
            let (out, back) = (left[0].double(), entering.double());
            taken = taken.wrapping_add(counted(out - back));
            let velocity = L::VELOCITIES[link.direction as usize].map(f64::from);
            let push: [f64; 3] = std::array::from_fn(|axis| {
                out * (velocity[axis] - link.velocity[axis]) + back * (velocity[axis] + link.velocity[axis])
            });
            let [x, y, z] = link.arm;
            let turn = [y * push[2] - z * push[1], z * push[0] - x * push[2], x * push[1] - y * push[0]];
            for axis in 0..3 {
                force[axis] += push[axis];
                torque[axis] += turn[axis];
            }
        }
        (self.force, self.torque) = (force, torque);
        self.keep_of_step(taken);
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<CutLink<T>>() * self.links.capacity()
    }
}
