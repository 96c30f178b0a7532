//! From open faces of a setup to lists of cells.

use crate::absorbing::{Inner, Seen, Side};
use crate::edges::{EdgeCell, OpenEdge};
use crate::lattice::Lattice;
use crate::obstacle::{Cover, Domain, cell_index, cells_of};
use crate::open::{Known, Open, OpenCell, OpenFace, OpenScheme};
use crate::populations::Grid;
use crate::setup::{Face, Setup};
use granular_core::{Dim, Vector};

/// Lists the cells of all open faces, and of edges and corners between them.
pub(crate) fn open_faces<L: Lattice<Q>, const Q: usize>(
    setup: &Setup<L::Dim>,
    grid: &Grid,
    cover: &Cover,
) -> Open {
    let lister = Lister { setup, grid, cover };
    let mut open = Open::default();
    for axis in 0..L::Dim::N {
        for (side, face) in setup.faces[axis].iter().enumerate().filter(|(_, face)| face.is_open()) {
            let mut inward = [0; 3];
            inward[axis] = if side == 0 { 1 } else { -1 };
            open.faces.extend(lister.face(face, axis, inward));
        }
    }
    // Those that absorb look at cells of the others.
    open.faces.sort_by_key(|face| face.known == Known::Wave);
    // Edges before corners.
    for count in 2..=3 {
        for number in 0..27 {
            let inward = [number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1];
            if inward.iter().filter(|way| **way != 0).count() == count {
                open.edges.extend(lister.edge(inward));
            }
        }
    }
    open
}

struct Lister<'a, D: Dim> {
    setup: &'a Setup<D>,
    grid: &'a Grid,
    cover: &'a Cover,
}

impl<D: Dim> Lister<'_, D> {
    fn is_fluid(&self, cell: [usize; 3]) -> bool {
        self.cover.is_empty() || self.cover[cell_index(self.setup.cells, cell)] == 0
    }

    fn place(&self, cell: [usize; 3]) -> usize {
        self.grid.place(cell.map(|x| x as i64))
    }

    /// The open face on the side away from `inward` along an axis.
    fn open_face(&self, axis: usize, inward: i32) -> Option<&Face<D>> {
        let side = if inward == 1 { 0 } else { 1 };
        Some(&self.setup.faces[axis][side]).filter(|face| inward != 0 && face.is_open())
    }

    /// Fluid cells that lie on the open faces away from `inward` and on no other.
    fn cells(&self, inward: [i32; 3]) -> impl Iterator<Item = [usize; 3]> {
        let (mut low, mut high) = ([0; 3], self.setup.cells);
        for axis in 0..D::N {
            let last = self.setup.cells[axis] - 1;
            match inward[axis] {
                1 => high[axis] = 1,
                -1 => low[axis] = last,
                _ => {
                    low[axis] += usize::from(self.open_face(axis, 1).is_some());
                    high[axis] -= usize::from(self.open_face(axis, -1).is_some());
                }
            }
        }
        cells_of([low, high]).filter(|cell| self.is_fluid(*cell))
    }

    /// Velocity of a profile at the centre of a cell, in lattice units.
    fn velocity(&self, profile: &crate::Profile<D>, cell: [usize; 3]) -> [f64; 3] {
        let centre = Domain::of(self.setup).centre(cell.map(|x| x as i64));
        (profile.0)(centre).padded().map(|c| c / self.setup.lattice_speed())
    }

    fn face(&self, face: &Face<D>, axis: usize, inward: [i32; 3]) -> Option<OpenFace> {
        let known = match face {
            Face::Velocity(..) => Known::Velocity,
            Face::Absorbing { .. } => Known::Wave,
            _ => Known::Density,
        };
        let cells = self.cells(inward).map(|cell| {
            let mut velocity = face.profile().map_or([0.0; 3], |profile| self.velocity(profile, cell));
            if known == Known::Density {
                velocity[axis] = 0.0;
            }
            let excess = face.pressure().map_or(0.0, |pressure| self.setup.density_excess(pressure));
            OpenCell { place: self.place(cell), velocity, excess }
        });
        let mut inner = Vec::new();
        if let Face::Absorbing { relaxation, .. } = face {
            let share = relaxation / self.setup.cells[axis] as f64;
            inner.extend(self.cells(inward).map(|cell| self.inner(cell, axis, inward, share)));
        }
        Some(OpenFace {
            axis,
            inward: inward[axis],
            known,
            scheme: face.scheme()?,
            cells: cells.collect(),
            inner,
            seen: Seen::default(),
        })
    }

    fn edge(&self, inward: [i32; 3]) -> Option<OpenEdge> {
        let mut faces = Vec::new();
        for axis in (0..3).filter(|axis| inward[*axis] != 0) {
            faces.push((axis, self.open_face(axis, inward[axis])?));
        }
        let regularised = faces.iter().any(|(_, face)| face.scheme() == Some(OpenScheme::Regularised));
        let scheme = if regularised { OpenScheme::Regularised } else { OpenScheme::ZouHe };
        let is_absorbing = |face: &Face<D>| matches!(face, Face::Absorbing { .. });
        let has_velocity = faces.iter().any(|(_, face)| matches!(face, Face::Velocity(..)));
        let absorbs = faces.iter().any(|(_, face)| is_absorbing(face));
        let held =
            faces.iter().filter(|(_, face)| !is_absorbing(face)).filter_map(|(_, face)| face.pressure());
        let held: Vec<f64> = held.collect();
        let cells = self.cells(inward).map(|cell| {
            let mut edge = EdgeCell {
                place: self.place(cell),
                velocity: [0.0; 3],
                excess: mean(held.iter().map(|pressure| self.setup.density_excess(*pressure))),
                beside: Vec::new(),
                carried: Vec::new(),
            };
            if has_velocity || !absorbs {
                edge.velocity = self.edge_velocity(&faces, cell);
            } else {
                edge.carried = self.near(cell, inward);
            }
            if absorbs && held.is_empty() {
                self.relax(&mut edge, &faces, cell, inward);
            } else if held.is_empty() {
                edge.beside = self.beside(cell, inward);
            }
            edge
        });
        Some(OpenEdge { inward, scheme, cells: cells.collect() })
    }

    /// Lets the density of an edge follow that beside it, and settle at what the faces that absorb give.
    fn relax(&self, edge: &mut EdgeCell, faces: &[(usize, &Face<D>)], cell: [usize; 3], inward: [i32; 3]) {
        let absorbing = || {
            faces.iter().filter_map(|(axis, face)| match face {
                Face::Absorbing { pressure, relaxation, .. } => {
                    Some((*pressure, relaxation / self.setup.cells[*axis] as f64))
                }
                _ => None,
            })
        };
        let share = mean(absorbing().map(|(_, share)| share));
        edge.excess = share * mean(absorbing().map(|(pressure, _)| self.setup.density_excess(pressure)));
        edge.beside = self.near(cell, inward);
        for (_, weight) in &mut edge.beside {
            *weight *= 1.0 - share;
        }
    }

    /// What an absorbing face needs of the cell within; none if that is not fluid.
    fn inner(&self, cell: [usize; 3], axis: usize, inward: [i32; 3], share: f64) -> Option<Inner> {
        let mut within = cell;
        within[axis] = (cell[axis] as i64 + i64::from(inward[axis])) as usize;
        if !self.is_fluid(within) {
            return None;
        }
        let sides = (0..D::N)
            .filter(|across| *across != axis)
            .map(|across| (across, [self.side(within, across, -1), self.side(within, across, 1)]));
        let viscosity = (self.setup.tau() - 0.5) / 3.0;
        Some(Inner { place: self.place(within), share, viscosity, sides: sides.collect() })
    }

    /// What lies beside a cell along an axis.
    fn side(&self, mut cell: [usize; 3], axis: usize, way: i64) -> Side {
        let (at, count) = (cell[axis] as i64 + way, self.setup.cells[axis] as i64);
        if !(0..count).contains(&at) {
            match &self.setup.faces[axis][usize::from(way == 1)] {
                face @ (Face::Wall(_) | Face::WallProfile(_)) => {
                    let to_wall = D::Vec::along(axis, 0.5 * self.setup.spacing * way as f64);
                    let point = Domain::of(self.setup).centre(cell.map(|x| x as i64)) + to_wall;
                    let velocity = face.wall_velocity(point).unwrap_or_default();
                    return Side::Wall(velocity.padded().map(|c| c / self.setup.lattice_speed()));
                }
                Face::Periodic => {}
                _ => return Side::Mirror,
            }
        }
        cell[axis] = at.rem_euclid(count) as usize;
        let is_last = [cell[axis] == 0, cell[axis] + 1 == self.setup.cells[axis]];
        for (face, is_last) in self.setup.faces[axis].iter().zip(is_last) {
            if is_last && matches!(face, Face::Absorbing { .. }) {
                return Side::Later;
            }
        }
        if self.is_fluid(cell) { Side::Cell(self.place(cell)) } else { Side::Wall([0.0; 3]) }
    }

    /// Mean of what faces with a velocity give; without those, of what the others give along themselves.
    fn edge_velocity(&self, faces: &[(usize, &Face<D>)], cell: [usize; 3]) -> [f64; 3] {
        let has_velocity = faces.iter().any(|(_, face)| matches!(face, Face::Velocity(..)));
        std::array::from_fn(|axis| {
            let giving = faces.iter().filter(|(normal, face)| {
                if has_velocity { matches!(face, Face::Velocity(..)) } else { *normal != axis }
            });
            mean(
                giving.map(|(_, face)| {
                    face.profile().map_or(0.0, |profile| self.velocity(profile, cell)[axis])
                }),
            )
        })
    }

    /// Fluid cells beside an edge within the faces, or else across, with equal weights.
    fn near(&self, cell: [usize; 3], inward: [i32; 3]) -> Vec<(usize, f64)> {
        let inner = |axis: usize| (cell[axis] as i64 + i64::from(inward[axis])) as usize;
        let mut near = Vec::new();
        for across in (0..3).filter(|axis| inward[*axis] != 0) {
            near.push(std::array::from_fn(|axis| if axis == across { inner(axis) } else { cell[axis] }));
        }
        near.retain(|cell| self.is_fluid(*cell));
        if near.is_empty() {
            near.push(std::array::from_fn(inner));
            near.retain(|cell| self.is_fluid(*cell));
        }
        let weight = 1.0 / near.len().max(1) as f64;
        near.iter().map(|cell| (self.place(*cell), weight)).collect()
    }

    /// Cells from which the density of an edge follows: exact where it varies linearly; the mean of those that are
    /// fluid near obstacles.
    fn beside(&self, cell: [usize; 3], inward: [i32; 3]) -> Vec<(usize, f64)> {
        let near = self.near(cell, inward);
        let axes = inward.iter().filter(|way| **way != 0).count();
        let across: [usize; 3] =
            std::array::from_fn(|axis| (cell[axis] as i64 + i64::from(inward[axis])) as usize);
        if near.len() < axes || !self.is_fluid(across) {
            return near;
        }
        let weight = 1.0 / (axes - 1) as f64;
        let near = near.into_iter().map(|(place, _)| (place, weight));
        near.chain([(self.place(across), -weight)]).collect()
    }
}

/// Mean; zero of nothing.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count.max(1))
}
