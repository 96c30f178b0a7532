//! From faces and obstacles to lists of links.

use crate::lattice::{Lattice, opposite};
use crate::links::{Copies, Cut, Cuts, Port};
use crate::obstacle::{Cover, Domain, cell_index, cells_of};
use crate::open::{Open, dot};
use crate::openings::open_faces;
use crate::populations::Grid;
use crate::real::Real;
use crate::setup::{Face, Setup};
use granular_core::{Dim, Vector};

/// What lies beyond the fluid.
pub(crate) struct Beyond<T> {
    pub(crate) copies: Copies<T>,
    pub(crate) obstacles: Vec<Cuts<T>>,
    pub(crate) open: Open,
}

/// What a cell next to another one is.
pub(crate) enum Neighbour {
    /// Fluid inside the domain.
    Fluid,
    /// Fluid on the other side of a periodic face.
    Wrapped([i64; 3]),
    /// Covered by an obstacle.
    Solid(usize),
    /// Beyond a wall.
    Wall([f64; 3]),
    /// Beyond a free-slip face: the axes that are mirrored.
    Mirror([bool; 3]),
    /// Beyond an open face.
    Open,
}

/// Builds the lists of a flow.
pub(crate) struct Builder<'a, L: Lattice<Q>, const Q: usize> {
    pub(crate) setup: &'a Setup<L::Dim>,
    pub(crate) domain: Domain<L::Dim>,
    /// Displacements of each obstacle and its periodic images.
    images: Vec<Vec<<L::Dim as Dim>::Vec>>,
    pub(crate) grid: &'a Grid,
    cover: &'a Cover,
}

/// The cell next to another one along a direction.
pub(crate) fn beyond<L: Lattice<Q>, const Q: usize>(cell: [i64; 3], direction: usize) -> [i64; 3] {
    std::array::from_fn(|axis| cell[axis] + i64::from(L::VELOCITIES[direction][axis]))
}

impl<'a, L: Lattice<Q>, const Q: usize> Builder<'a, L, Q> {
    pub(crate) fn new(setup: &'a Setup<L::Dim>, grid: &'a Grid, cover: &'a Cover) -> Self {
        let domain = Domain::of(setup);
        let images = setup.obstacles.iter().map(|obstacle| domain.images(obstacle, 2.0)).collect();
        Self { setup, domain, images, grid, cover }
    }

    pub(crate) fn build<T: Real>(&self) -> Beyond<T> {
        let open = open_faces::<L, Q>(self.setup, self.grid, self.cover);
        Beyond { copies: self.copies(), obstacles: self.obstacles(), open }
    }

    /// Links of cells at faces to what is no obstacle.
    pub(crate) fn copies<T: Real>(&self) -> Copies<T> {
        let mut copies = Copies::new();
        for cell in self.cells_at_faces().filter(|cell| self.is_fluid(*cell)) {
            (1..Q).for_each(|direction| self.copy(&mut copies, cell, direction));
        }
        copies
    }

    /// Links that obstacles cut.
    pub(crate) fn obstacles<T: Real>(&self) -> Vec<Cuts<T>> {
        (0..self.setup.obstacles.len())
            .map(|number| {
                let cuts: Vec<Cut> = (0..self.images[number].len())
                    .flat_map(|image| self.near(number, image).map(move |cell| (image, cell)))
                    .flat_map(|(image, cell)| (1..Q).map(move |direction| (image, cell, direction)))
                    .filter_map(|(image, cell, direction)| self.cut(cell, direction, number, image))
                    .collect();
                Cuts::new::<L, Q>(self.grid, &cuts)
            })
            .collect()
    }

    /// Fluid cells from which links may reach an image of an obstacle.
    fn near(&self, number: usize, image: usize) -> impl Iterator<Item = [usize; 3]> {
        let range = self.domain.near(&self.setup.obstacles[number], self.images[number][image], 2.0);
        cells_of(range).filter(|cell| self.is_fluid(*cell))
    }

    fn cells_at_faces(&self) -> impl Iterator<Item = [usize; 3]> {
        let (cells, axes) = (self.setup.cells, L::Dim::N);
        cells_of([[0; 3], [1, cells[1], cells[2]]]).flat_map(move |row| {
            let is_at_face = (1..axes).any(|axis| row[axis] == 0 || row[axis] + 1 == cells[axis]);
            let step = if is_at_face { 1 } else { cells[0] - 1 };
            (0..cells[0]).step_by(step).map(move |x| [x, row[1], row[2]])
        })
    }

    fn is_fluid(&self, cell: [usize; 3]) -> bool {
        self.cover.is_empty() || self.cover[cell_index(self.setup.cells, cell)] == 0
    }

    fn solid(&self, cell: [i64; 3]) -> Option<usize> {
        let cell = cell.map(|x| x as usize);
        let number = if self.cover.is_empty() { 0 } else { self.cover[cell_index(self.setup.cells, cell)] };
        (number as usize).checked_sub(1)
    }

    pub(crate) fn neighbour(&self, cell: [i64; 3]) -> Neighbour {
        let mut wrapped = cell;
        let (mut wall, mut mirror, mut is_open): (Option<[f64; 3]>, _, _) = (None, [false; 3], false);
        for axis in 0..L::Dim::N {
            let last = self.setup.cells[axis] as i64;
            let face = match cell[axis] {
                at if at < 0 => &self.setup.faces[axis][0],
                at if at >= last => &self.setup.faces[axis][1],
                _ => continue,
            };
            match face {
                Face::Periodic => wrapped[axis] = cell[axis].rem_euclid(last),
                Face::FreeSlip | Face::NavierSlip { .. } => mirror[axis] = true,
                Face::Velocity(..)
                | Face::Pressure(..)
                | Face::PressureAlong(..)
                | Face::Absorbing { .. } => is_open = true,
                // Its velocity is that where a link meets it: see `varying_wall`.
                Face::WallProfile(_) => wall = Some([0.0; 3]),
                // In a corner, the wall that moves less.
                Face::Wall(velocity) => {
                    let velocity = velocity.padded();
                    let speed = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>();
                    wall = Some(wall.filter(|other| speed(other) <= speed(&velocity)).unwrap_or(velocity));
                }
            }
        }
        match wall {
            _ if is_open => Neighbour::Open,
            Some(velocity) => Neighbour::Wall(velocity.map(|c| c / self.setup.lattice_speed())),
            None if mirror != [false; 3] => Neighbour::Mirror(mirror),
            None => match self.solid(wrapped) {
                Some(obstacle) => Neighbour::Solid(obstacle),
                None if wrapped == cell => Neighbour::Fluid,
                None => Neighbour::Wrapped(wrapped),
            },
        }
    }

    fn copy<T: Real>(&self, copies: &mut Copies<T>, cell: [usize; 3], direction: usize) {
        let cell = cell.map(|x| x as i64);
        let velocity = L::VELOCITIES[direction];
        let back = opposite(direction);
        let here = self.grid.place(cell);
        let to = Port { place: here, direction: back };
        let bounced = Port { place: here, direction };
        match self.neighbour(beyond::<L, Q>(cell, direction)) {
            Neighbour::Fluid | Neighbour::Open | Neighbour::Solid(_) => {}
            Neighbour::Wrapped(image) => {
                let from = Port { place: self.grid.place(image), direction: back };
                copies.push::<L, Q>(self.grid, to, from, 0.0);
            }
            Neighbour::Wall(wall) => {
                let wall = self.varying_wall(cell, direction).unwrap_or(wall);
                let added = -6.0 * L::WEIGHTS[direction] * dot(velocity, wall);
                copies.push::<L, Q>(self.grid, to, bounced, added);
            }
            Neighbour::Mirror(mirror) => {
                let from = self.mirrored(cell, direction, mirror).unwrap_or(bounced);
                if self.slip(copies, bounced, cell, from) {
                    return;
                }
                copies.push::<L, Q>(self.grid, to, from, 0.0);
            }
        }
    }

    /// Where comes from, at a free-slip face, what enters against `direction`; none when that cell is not fluid.
    fn mirrored(&self, cell: [i64; 3], direction: usize, mirror: [bool; 3]) -> Option<Port> {
        let velocity = L::VELOCITIES[direction];
        let along = |axis: usize| if mirror[axis] { 0 } else { velocity[axis] };
        let source: [i64; 3] = std::array::from_fn(|axis| cell[axis] + i64::from(along(axis)));
        let before: [i32; 3] =
            std::array::from_fn(|axis| if mirror[axis] { velocity[axis] } else { -velocity[axis] });
        let from = L::VELOCITIES.iter().position(|c| *c == before)?;
        match self.neighbour(source) {
            Neighbour::Fluid => Some(Port { place: self.grid.place(source), direction: from }),
            Neighbour::Wrapped(image) => Some(Port { place: self.grid.place(image), direction: from }),
            _ => None,
        }
    }

    /// The link of a cell along `direction` when this image of this obstacle cuts it.
    fn cut(&self, cell: [usize; 3], direction: usize, number: usize, image: usize) -> Option<Cut> {
        let cell = cell.map(|x| x as i64);
        let neighbour = beyond::<L, Q>(cell, direction);
        if !matches!(self.neighbour(neighbour), Neighbour::Solid(found) if found == number) {
            return None;
        }
        let (setup, obstacle, images) = (self.setup, &self.setup.obstacles[number], &self.images[number]);
        let (outside, inside) = (self.domain.centre(cell), self.domain.centre(neighbour));
        // Images that overlap share the cells near them: the first one has the link.
        if images.iter().position(|image| obstacle.shape.contains(inside - *image)) != Some(image) {
            return None;
        }
        let (outside, inside) = (outside - images[image], inside - images[image]);
        let q = obstacle.shape.crossing(outside, inside);
        let arm = outside + (inside - outside) * q - obstacle.shape.centre();
        let wall = obstacle.velocity_at(arm).padded().map(|c| c / setup.lattice_speed());
        let behind = beyond::<L, Q>(cell, opposite(direction));
        let has_cell_behind = matches!(self.neighbour(behind), Neighbour::Fluid);
        let motion = obstacle.wall.motion(q, has_cell_behind);
        Some(Cut {
            port: Port { place: self.grid.place(cell), direction },
            weights: obstacle.wall.weights(q, has_cell_behind),
            added: -6.0 * L::WEIGHTS[direction] * motion * dot(L::VELOCITIES[direction], wall),
            arm: arm.padded().map(|c| c / setup.spacing),
            velocity: wall,
        })
    }
}

impl<D: Dim> Setup<D> {
    /// Density over that at rest, minus one, at a pressure \[Pa\] over that at rest.
    pub(crate) fn density_excess(&self, pressure: f64) -> f64 {
        3.0 * pressure / (self.density * self.lattice_speed().powi(2))
    }
}
