//! From faces and obstacles to lists of links.

use crate::lattice::{Lattice, opposite};
use crate::links::{Copies, Cut, Cuts, Port};
use crate::open::{Open, dot};
use crate::openings::open_faces;
use crate::populations::Grid;
use crate::real::Real;
use crate::setup::{Face, Obstacle, Setup, SetupError};
use granular_core::{Dim, Vector};

/// Number of the obstacle that covers a cell, from 1; 0 is fluid. Empty without obstacles.
pub(crate) type Cover = Vec<u16>;

/// What lies beyond the fluid.
pub(crate) struct Beyond<T> {
    pub(crate) copies: Copies<T>,
    pub(crate) obstacles: Vec<Cuts<T>>,
    pub(crate) open: Open,
}

/// What a cell next to another one is.
enum Neighbour {
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
    setup: &'a Setup<L::Dim>,
    grid: &'a Grid,
    cover: &'a Cover,
}

/// Index of a cell among all of the domain.
pub(crate) fn cell_index([nx, ny, _]: [usize; 3], [x, y, z]: [usize; 3]) -> usize {
    (z * ny + y) * nx + x
}

/// Centre of a cell \[m\]; coordinates may lie beyond the domain.
pub(crate) fn centre_of<D: Dim>(setup: &Setup<D>, cell: [i64; 3]) -> D::Vec {
    let mut centre = setup.origin;
    for (axis, &at) in cell.iter().enumerate().take(D::N) {
        centre += D::Vec::along(axis, (at as f64 + 0.5) * setup.spacing);
    }
    centre
}

/// All cells of a box, x fastest.
pub(crate) fn cells_of(low: [usize; 3], high: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (low[2]..high[2])
        .flat_map(move |z| (low[1]..high[1]).flat_map(move |y| (low[0]..high[0]).map(move |x| [x, y, z])))
}

/// Cells of a box around an obstacle, `margin` cells wider, cut to the domain.
fn near<D: Dim>(setup: &Setup<D>, obstacle: &Obstacle<D>, margin: f64) -> [[usize; 3]; 2] {
    let (low, high) = obstacle.shape.bounds();
    let mut ranges = [[0; 3], setup.cells];
    for axis in 0..D::N {
        let at = |corner: D::Vec| (corner.component(axis) - setup.origin.component(axis)) / setup.spacing;
        let last = setup.cells[axis] as f64;
        ranges[0][axis] = (at(low) - 1.0 - margin).floor().clamp(0.0, last) as usize;
        ranges[1][axis] = (at(high) + 1.0 + margin).ceil().clamp(0.0, last) as usize;
    }
    ranges
}

/// Marks the cells whose centres obstacles contain; the first obstacle keeps a cell.
pub(crate) fn cover<D: Dim>(setup: &Setup<D>) -> Result<Cover, SetupError> {
    if setup.obstacles.is_empty() {
        return Ok(Vec::new());
    }
    let mut cover = vec![0; setup.cells.iter().product()];
    for (number, obstacle) in setup.obstacles.iter().enumerate() {
        let number = u16::try_from(number + 1).map_err(|_| {
            SetupError::new("obstacles", format!("{} bodies", setup.obstacles.len()), "at most 65535")
        })?;
        let [low, high] = near(setup, obstacle, 0.0);
        for cell in cells_of(low, high) {
            let at = cell_index(setup.cells, cell);
            if cover[at] == 0 && obstacle.shape.contains(centre_of(setup, cell.map(|x| x as i64))) {
                cover[at] = number;
            }
        }
    }
    if cover.iter().all(|number| *number != 0) {
        return Err(SetupError::new(
            "fluid",
            "covered by obstacles everywhere".to_owned(),
            "some cells free",
        ));
    }
    Ok(cover)
}

impl<'a, L: Lattice<Q>, const Q: usize> Builder<'a, L, Q> {
    pub(crate) fn new(setup: &'a Setup<L::Dim>, grid: &'a Grid, cover: &'a Cover) -> Self {
        Self { setup, grid, cover }
    }

    pub(crate) fn build<T: Real>(&self) -> Beyond<T> {
        let mut copies = Copies::new();
        let mut cuts = vec![Vec::new(); self.setup.obstacles.len()];
        for cell in self.candidates() {
            if !self.is_fluid(cell) {
                continue;
            }
            for direction in 1..Q {
                self.link(&mut copies, &mut cuts, cell, direction);
            }
        }
        let obstacles = cuts.iter().map(|cuts| Cuts::new::<L, Q>(self.grid, cuts)).collect();
        Beyond { copies, obstacles, open: open_faces::<L, Q>(self.setup, self.grid, self.cover) }
    }

    /// Cells that may have a neighbour beyond the fluid: those at faces, then those near obstacles.
    fn candidates(&self) -> Vec<[usize; 3]> {
        let cells = self.setup.cells;
        let axes = L::Dim::N;
        let is_at_face =
            move |cell: [usize; 3]| (0..axes).any(|axis| cell[axis] == 0 || cell[axis] + 1 == cells[axis]);
        let mut found = Vec::new();
        for row in cells_of([0; 3], [1, cells[1], cells[2]]) {
            if (1..axes).any(|axis| row[axis] == 0 || row[axis] + 1 == cells[axis]) {
                found.extend((0..cells[0]).map(|x| [x, row[1], row[2]]));
            } else {
                found.extend([row, [cells[0] - 1, row[1], row[2]]]);
            }
        }
        let mut listed = vec![false; self.cover.len()];
        for obstacle in &self.setup.obstacles {
            let [low, high] = near(self.setup, obstacle, 2.0);
            for cell in cells_of(low, high) {
                let at = cell_index(cells, cell);
                if !listed[at] && !is_at_face(cell) {
                    listed[at] = true;
                    found.push(cell);
                }
            }
        }
        found
    }

    fn is_fluid(&self, cell: [usize; 3]) -> bool {
        self.cover.is_empty() || self.cover[cell_index(self.setup.cells, cell)] == 0
    }

    fn solid(&self, cell: [i64; 3]) -> Option<usize> {
        let cell = cell.map(|x| x as usize);
        let number = if self.cover.is_empty() { 0 } else { self.cover[cell_index(self.setup.cells, cell)] };
        (number as usize).checked_sub(1)
    }

    fn neighbour(&self, cell: [i64; 3]) -> Neighbour {
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
                Face::FreeSlip => mirror[axis] = true,
                Face::Velocity(..)
                | Face::Pressure(..)
                | Face::PressureAlong(..)
                | Face::Absorbing { .. } => is_open = true,
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

    fn link<T: Real>(
        &self,
        copies: &mut Copies<T>,
        cuts: &mut [Vec<Cut>],
        cell: [usize; 3],
        direction: usize,
    ) {
        let cell = cell.map(|x| x as i64);
        let velocity = L::VELOCITIES[direction];
        let beyond: [i64; 3] = std::array::from_fn(|axis| cell[axis] + i64::from(velocity[axis]));
        let back = opposite(direction);
        let here = self.grid.place(cell);
        let to = Port { place: here, direction: back };
        let bounced = Port { place: here, direction };
        match self.neighbour(beyond) {
            Neighbour::Fluid | Neighbour::Open => {}
            Neighbour::Wrapped(image) => {
                let from = Port { place: self.grid.place(image), direction: back };
                copies.push::<L, Q>(self.grid, to, from, 0.0);
            }
            Neighbour::Wall(wall) => {
                let added = -6.0 * L::WEIGHTS[direction] * dot(velocity, wall);
                copies.push::<L, Q>(self.grid, to, bounced, added);
            }
            Neighbour::Mirror(mirror) => {
                let from = self.mirrored(cell, direction, mirror).unwrap_or(bounced);
                copies.push::<L, Q>(self.grid, to, from, 0.0);
            }
            Neighbour::Solid(obstacle) => cuts[obstacle].push(self.cut(cell, direction, obstacle)),
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

    fn cut(&self, cell: [i64; 3], direction: usize, number: usize) -> Cut {
        let setup = self.setup;
        let obstacle = &setup.obstacles[number];
        let velocity = L::VELOCITIES[direction];
        // The obstacle may be met through a periodic face: look from its side.
        let beyond: [i64; 3] = std::array::from_fn(|axis| {
            let at = cell[axis] + i64::from(velocity[axis]);
            at.rem_euclid(setup.cells[axis] as i64)
        });
        let outside = std::array::from_fn(|axis| beyond[axis] - i64::from(velocity[axis]));
        let (outside, inside) = (centre_of(setup, outside), centre_of(setup, beyond));
        let q = obstacle.shape.crossing(outside, inside);
        let arm = outside + (inside - outside) * q - obstacle.shape.centre();
        let wall = obstacle.velocity + <L::Dim as Dim>::turn(obstacle.spin, arm);
        let wall = wall.padded().map(|c| c / setup.lattice_speed());
        let behind: [i64; 3] = std::array::from_fn(|axis| cell[axis] - i64::from(velocity[axis]));
        let has_cell_behind = matches!(self.neighbour(behind), Neighbour::Fluid);
        let motion = obstacle.wall.motion(q, has_cell_behind);
        Cut {
            port: Port { place: self.grid.place(cell), direction },
            weights: obstacle.wall.weights(q, has_cell_behind),
            added: -6.0 * L::WEIGHTS[direction] * motion * dot(velocity, wall),
            arm: arm.padded().map(|c| c / setup.spacing),
            velocity: wall,
        }
    }
}

impl<D: Dim> Setup<D> {
    /// Density over that at rest, minus one, at a pressure \[Pa\] over that at rest.
    pub(crate) fn density_excess(&self, pressure: f64) -> f64 {
        3.0 * pressure / (self.density * self.lattice_speed().powi(2))
    }
}
