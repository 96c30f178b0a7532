//! Faces that are walls whose velocity varies, or along which the fluid slips.
//!
//! A link that bounces at a wall half-way meets it in the middle between two cells: the velocity there is what the
//! fluid is given. At a wall with a slip length the share `r` of what leaves bounces, the rest is mirrored. In a
//! steady flow along such a wall, the populations that enter less those that would if they mirrored give
//!
//! ```text
//! u(1/2) = s (1 - r) / r (tau - 1/2) + s / 2,  s = du/dy
//! ```
//!
//! so the slip length is `(1 / r - 1) (tau - 1/2)` cells; with a second derivative `u''` in a flow that a body force
//! drives, the velocity at the wall is more by `-u'' (16 Lambda - 3) / 24`, as at a wall that does not slip.

use crate::boundary::{Builder, beyond};
use crate::lattice::{Lattice, opposite};
use crate::links::{Both, Copies, Port, entering, leaving};
use crate::obstacle::{Domain, cells_of};
use crate::open::dot;
use crate::populations::{Grid, Populations};
use crate::real::Real;
use crate::setup::{Face, Setup, SetupError};
use granular_core::{Dim, Linear, Vector};

impl<D: Dim> Face<D> {
    /// Whether it is a wall, also one whose velocity varies or along which the fluid slips; a face without friction is none.
    pub(crate) fn is_wall(&self) -> bool {
        matches!(self, Self::Wall(_) | Self::WallProfile(_) | Self::NavierSlip { .. })
    }

    /// Velocity \[m/s\] of a wall at a point \[m\]; none of what is no wall.
    pub(crate) fn wall_velocity(&self, point: D::Vec) -> Option<D::Vec> {
        match self {
            Self::Wall(velocity) | Self::NavierSlip { velocity, .. } => Some(*velocity),
            Self::WallProfile(profile) => Some(profile.at(point)),
            _ => None,
        }
    }
}

impl<D: Dim> Setup<D> {
    /// Points \[m\] at which links meet a face half-way beyond the last cells.
    fn points_on_face(&self, axis: usize, side: usize) -> impl Iterator<Item = D::Vec> {
        let (mut low, mut high) = ([0; 3], self.cells);
        low[axis] = if side == 0 { 0 } else { self.cells[axis] - 1 };
        high[axis] = low[axis] + 1;
        let (domain, half) = (Domain::of(self), 0.5 * self.spacing);
        let out = D::Vec::along(axis, if side == 0 { -half } else { half });
        let across = (0..D::N).filter(move |other| *other != axis);
        let aside = across.flat_map(move |other| [-half, half].map(|way| D::Vec::along(other, way)));
        let ways: Vec<_> = std::iter::once(D::Vec::ZERO).chain(aside).collect();
        cells_of([low, high]).flat_map(move |cell| {
            let centre = domain.centre(cell.map(|at| at as i64)) + out;
            ways.clone().into_iter().map(move |way| centre + way)
        })
    }

    /// Points at which the velocity of a wall is looked at: one where it is the same everywhere.
    fn wall_points(&self, axis: usize, side: usize) -> impl Iterator<Item = D::Vec> {
        let varies = matches!(self.faces[axis][side], Face::WallProfile(_));
        let points = (axis < D::N && varies).then(|| self.points_on_face(axis, side));
        let one = points.is_none().then_some(D::Vec::ZERO);
        points.into_iter().flatten().chain(one)
    }

    /// Walls move along themselves, and slip lengths are zero or more.
    pub(crate) fn check_wall(&self, axis: usize, side: usize) -> Result<(), SetupError> {
        let face = &self.faces[axis][side];
        if let Face::NavierSlip { length, .. } = face
            && !(*length >= 0.0 && length.is_finite())
        {
            let allowed = "zero or more, and finite: FreeSlip has no friction at all";
            return Err(SetupError::new("slip length of a face", format!("{length} m"), allowed));
        }
        for point in self.wall_points(axis, side) {
            let Some(velocity) = face.wall_velocity(point) else { return Ok(()) };
            if !velocity.is_finite() || (axis < D::N && velocity.component(axis) != 0.0) {
                let place = if point == D::Vec::ZERO { String::new() } else { format!(" at {point:?}") };
                let value = format!("{velocity:?} along axis {axis}{place}");
                return Err(SetupError::new("velocity of a wall", value, "a velocity along the wall"));
            }
        }
        Ok(())
    }

    /// Largest speed of any wall \[m/s\].
    pub(crate) fn fastest_wall(&self) -> f64 {
        let sides = (0..D::N).flat_map(|axis| [(axis, 0), (axis, 1)]);
        sides
            .flat_map(|(axis, side)| {
                let face = &self.faces[axis][side];
                let points = face.wall_velocity(D::Vec::ZERO).map(|_| self.wall_points(axis, side));
                points.into_iter().flatten().filter_map(|point| face.wall_velocity(point))
            })
            .map(Linear::length)
            .fold(0.0, f64::max)
    }
}

/// A link of a wall that slips: what enters, from what left towards the wall in this cell and where it is mirrored.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlipLink<T> {
    pub(crate) to: Both,
    /// What left this cell, and what is mirrored.
    pub(crate) from: [Both; 2],
    pub(crate) shares: [T; 2],
    /// What a moving wall adds.
    pub(crate) added: T,
}

/// What enters along such a link.
#[inline]
pub(crate) fn entering_slip<T: Real>([bounced, mirrored]: [T; 2], [a, b]: [T; 2], added: T) -> T {
    a * bounced + b * mirrored + added
}

impl<T: Real> SlipLink<T> {
    fn new<L: Lattice<Q>, const Q: usize>(
        grid: &Grid,
        bounced: Port,
        mirrored: Port,
        share: f64,
        added: f64,
    ) -> Self {
        let to = Port { place: bounced.place, direction: opposite(bounced.direction) };
        Self {
            to: entering::<L, Q>(grid, to),
            from: [bounced, mirrored].map(|port| leaving::<L, Q>(grid, port)),
            shares: [share, 1.0 - share].map(T::of),
            added: T::of(added),
        }
    }

    pub(crate) fn apply(&self, populations: &mut Populations<T>) {
        let at = populations.layout as usize;
        let values = &mut populations.values[..];
        let left = self.from.map(|from| values[from[at] as usize]);
        values[self.to[at] as usize] = entering_slip(left, self.shares, self.added);
    }
}

impl<L: Lattice<Q>, const Q: usize> Builder<'_, L, Q> {
    /// Faces beyond which the neighbour of a cell along a direction lies.
    fn faces_crossed(&self, cell: [i64; 3], direction: usize) -> impl Iterator<Item = &Face<L::Dim>> {
        let there = beyond::<L, Q>(cell, direction);
        (0..L::Dim::N).filter_map(move |axis| match there[axis] {
            at if at < 0 => Some(&self.setup.faces[axis][0]),
            at if at >= self.setup.cells[axis] as i64 => Some(&self.setup.faces[axis][1]),
            _ => None,
        })
    }

    /// Velocity in lattice units of the wall that a link meets, if it varies along any wall that it crosses: of two
    /// walls the one that moves less.
    pub(crate) fn varying_wall(&self, cell: [i64; 3], direction: usize) -> Option<[f64; 3]> {
        if !self.faces_crossed(cell, direction).any(|face| matches!(face, Face::WallProfile(_))) {
            return None;
        }
        let (here, there) = (self.domain.centre(cell), self.domain.centre(beyond::<L, Q>(cell, direction)));
        let point = (here + there) * 0.5;
        self.faces_crossed(cell, direction)
            .filter(|face| matches!(face, Face::WallProfile(_) | Face::Wall(_)))
            .filter_map(|face| face.wall_velocity(point))
            .reduce(|a, b| if b.length_squared() < a.length_squared() { b } else { a })
            .map(|velocity| velocity.padded().map(|c| c / self.setup.lattice_speed()))
    }

    /// Adds the link of a cell that is mirrored from a port, if it crosses a wall that slips; says whether it does.
    pub(crate) fn slip<T: Real>(
        &self,
        copies: &mut Copies<T>,
        bounced: Port,
        cell: [i64; 3],
        from: Port,
    ) -> bool {
        let Port { direction, .. } = bounced;
        let slipping = self.faces_crossed(cell, direction).find_map(|face| match face {
            Face::NavierSlip { length, velocity } => Some((*length, *velocity)),
            _ => None,
        });
        let Some((length, velocity)) = slipping else { return false };
        let relaxed = self.setup.tau() - 0.5;
        let share = relaxed / (length / self.setup.spacing + relaxed);
        let wall = velocity.padded().map(|c| c / self.setup.lattice_speed());
        let added = -6.0 * L::WEIGHTS[direction] * share * dot(L::VELOCITIES[direction], wall);
        copies.slipping.push(SlipLink::new::<L, Q>(self.grid, bounced, from, share, added));
        true
    }
}
