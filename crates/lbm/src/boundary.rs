//! From faces and obstacles to lists of links.

use crate::lattice::{Lattice, opposite};
use crate::links::{Copies, Cut, Cuts, Port};
use crate::obstacle::{Cover, Domain, Range, cell_index, cells_of};
use crate::open::{Open, dot};
use crate::openings::open_faces;
use crate::populations::Grid;
use crate::real::Real;
use crate::setup::{Face, Setup};
use granular_core::shape::SolidShape;
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

/// A cell seen along a link.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    pub(crate) cell: [i64; 3],
    /// Axes along which it is a mirror image that is seen.
    pub(crate) mirror: [bool; 3],
}

/// The cell of which the one next to a cell along a direction is the mirror image.
fn reflected<L: Lattice<Q>, const Q: usize>(cell: [i64; 3], direction: usize, mirror: [bool; 3]) -> [i64; 3] {
    let next = beyond::<L, Q>(cell, direction);
    std::array::from_fn(|axis| if mirror[axis] { cell[axis] } else { next[axis] })
}

/// The direction that is seen in a mirror.
pub(crate) fn mirrored<L: Lattice<Q>, const Q: usize>(direction: usize, mirror: [bool; 3]) -> usize {
    if mirror == [false; 3] {
        return direction;
    }
    let velocity = L::VELOCITIES[direction];
    let seen = std::array::from_fn(|axis| if mirror[axis] { -velocity[axis] } else { velocity[axis] });
    L::VELOCITIES.iter().position(|c| *c == seen).expect("lattices have all mirror images of a velocity")
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
        (0..self.setup.obstacles.len()).map(|number| self.cuts_of(number)).collect()
    }

    /// Links that one obstacle cuts.
    pub(crate) fn cuts_of<T: Real>(&self, number: usize) -> Cuts<T> {
        let cuts: Vec<Cut> = (0..self.images[number].len())
            .flat_map(|image| self.near(number, image).map(move |cell| (image, cell)))
            .flat_map(|(image, cell)| (1..Q).map(move |direction| (image, cell, direction)))
            .filter_map(|(image, cell, direction)| self.cut(cell, direction, number, image))
            .collect();
        let mut cuts = Cuts::new::<L, Q>(self.grid, &cuts);
        set_velocity::<L, T, Q>(&mut cuts, self.setup, number);
        cuts
    }

    /// Whether links of an obstacle may reach cells of boxes, or see them behind their own.
    pub(crate) fn comes_near(&self, number: usize, ranges: &[Range]) -> bool {
        self.images[number].iter().any(|image| {
            let [low, high] = self.domain.near(&self.setup.obstacles[number], *image, 2.0);
            let overlaps =
                |[from, to]: &Range| (0..3).all(|axis| low[axis] < to[axis] && from[axis] < high[axis]);
            ranges.iter().any(overlaps)
        })
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
                // In a corner neither moves across the edge: see `sliding`.
                Face::Wall(velocity) => wall = Some(velocity.padded()),
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

    /// The fluid cell that lies beyond another one along a direction, through periodic faces and in mirrors too.
    pub(crate) fn seen(&self, cell: [i64; 3], direction: usize) -> Option<Seen> {
        let beside = beyond::<L, Q>(cell, direction);
        match self.neighbour(beside) {
            Neighbour::Fluid => Some(Seen { cell: beside, mirror: [false; 3] }),
            Neighbour::Wrapped(cell) => Some(Seen { cell, mirror: [false; 3] }),
            Neighbour::Mirror(mirror) => match self.neighbour(reflected::<L, Q>(cell, direction, mirror)) {
                Neighbour::Fluid => Some(Seen { cell: reflected::<L, Q>(cell, direction, mirror), mirror }),
                Neighbour::Wrapped(cell) => Some(Seen { cell, mirror }),
                _ => None,
            },
            _ => None,
        }
    }

    /// Where the population left that reaches a cell from beyond along `direction`, against it.
    fn sent(&self, cell: [i64; 3], direction: usize) -> Option<Port> {
        let Seen { cell, mirror } = self.seen(cell, direction)?;
        let direction = mirrored::<L, Q>(opposite(direction), mirror);
        Some(Port { place: self.grid.place(cell), direction })
    }

    fn copy<T: Real>(&self, copies: &mut Copies<T>, cell: [usize; 3], direction: usize) {
        let cell = cell.map(|x| x as i64);
        let here = self.grid.place(cell);
        let to = Port { place: here, direction: opposite(direction) };
        let bounced = Port { place: here, direction };
        match self.neighbour(beyond::<L, Q>(cell, direction)) {
            Neighbour::Fluid | Neighbour::Open | Neighbour::Solid(_) => {}
            Neighbour::Wrapped(_) | Neighbour::Mirror(_) => {
                // In a mirror there may be an obstacle: that is a cut.
                if let Some(from) = self.sent(cell, direction)
                    && !self.slip(copies, bounced, cell, from)
                {
                    copies.push::<L, Q>(self.grid, to, from, 0.0);
                }
            }
            Neighbour::Wall(wall) => {
                let wall = self.sliding(cell, direction, self.varying_wall(cell, direction).unwrap_or(wall));
                let added = -6.0 * L::WEIGHTS[direction] * dot(L::VELOCITIES[direction], wall);
                copies.push::<L, Q>(self.grid, to, bounced, added);
            }
        }
    }

    /// Velocity of a wall where a link meets it. Beside what is no fluid a wall cannot push fluid on: there, across the
    /// edge, it moves as what bounds it. All links along a wall then sum to no mass.
    fn sliding(&self, cell: [i64; 3], direction: usize, mut wall: [f64; 3]) -> [f64; 3] {
        let velocity = L::VELOCITIES[direction];
        for axis in (0..L::Dim::N).filter(|axis| velocity[*axis] != 0) {
            let mut beside = cell;
            beside[axis] += i64::from(velocity[axis]);
            wall[axis] = match self.neighbour(beside) {
                Neighbour::Fluid | Neighbour::Wrapped(_) | Neighbour::Open => wall[axis],
                Neighbour::Wall(_) | Neighbour::Mirror(_) => 0.0,
                Neighbour::Solid(number) => {
                    let obstacle = &self.setup.obstacles[number];
                    let ends = [cell, beyond::<L, Q>(cell, direction)].map(|cell| self.domain.centre(cell));
                    let point = (ends[0] + ends[1]) * 0.5;
                    let arm = point - self.domain.nearest_image(obstacle, point);
                    obstacle.velocity_at(arm).component(axis) / self.setup.lattice_speed()
                }
            };
        }
        wall
    }

    /// The obstacle that a link meets, the cell that it covers there, and along which axes it is seen in a mirror.
    fn met(&self, cell: [i64; 3], direction: usize) -> Option<(usize, Seen)> {
        let beside = beyond::<L, Q>(cell, direction);
        let (cell, mirror) = match self.neighbour(beside) {
            Neighbour::Mirror(mirror) => (reflected::<L, Q>(cell, direction, mirror), mirror),
            _ => (beside, [false; 3]),
        };
        match self.neighbour(cell) {
            Neighbour::Solid(number) => Some((number, Seen { cell, mirror })),
            _ => None,
        }
    }

    /// The link of a cell along `direction` when this image of this obstacle cuts it.
    fn cut(&self, cell: [usize; 3], direction: usize, number: usize, image: usize) -> Option<Cut> {
        let cell = cell.map(|x| x as i64);
        let (_, solid) = self.met(cell, direction).filter(|(found, _)| *found == number)?;
        let (obstacle, images) = (&self.setup.obstacles[number], &self.images[number]);
        let inside = self.domain.centre(solid.cell);
        // Images that overlap share the cells near them: the first one has the link.
        if images.iter().position(|image| obstacle.shape.contains(inside - *image)) != Some(image) {
            return None;
        }
        let outside = self.domain.centre(cell) - images[image];
        let beside = self.domain.centre(beyond::<L, Q>(cell, direction)) - images[image];
        let Meeting { q, arm, in_mirror } =
            meeting(&*obstacle.shape, [outside, beside, inside - images[image]]);
        let towards = if in_mirror { mirrored::<L, Q>(direction, solid.mirror) } else { direction };
        let behind = self.sent(cell, opposite(direction));
        Some(Cut {
            port: Port { place: self.grid.place(cell), direction },
            behind,
            towards,
            weights: obstacle.wall.weights(q, behind.is_some()),
            motion: obstacle.wall.motion(q, behind.is_some()),
            arm: arm.padded().map(|c| c / self.setup.spacing),
        })
    }
}

/// Lets the links of an obstacle move as the setup says.
pub(crate) fn set_velocity<L: Lattice<Q>, T: Real, const Q: usize>(
    cuts: &mut Cuts<T>,
    setup: &Setup<L::Dim>,
    number: usize,
) {
    let (obstacle, speed) = (&setup.obstacles[number], setup.lattice_speed());
    cuts.set_velocity::<L, Q>(|arm| {
        let arm = arm.map(|c| c * setup.spacing);
        let arm = Vector::from_slice(&arm[..L::Dim::N]).expect("one component per axis");
        obstacle.velocity_at(arm).padded().map(|c| c / speed)
    });
}

/// Where a link meets a surface.
struct Meeting<V> {
    /// Share of the way to the cell that is covered.
    q: f64,
    /// From the centre of the shape \[m\].
    arm: V,
    /// Whether it is met beyond the mirror.
    in_mirror: bool,
}

/// Where a link from the centre of a cell towards that of its neighbour meets a shape that covers a third centre: that of the neighbour
/// or, where the link ends in a mirror, of its image. Mirrors lie half-way.
fn meeting<D: Dim>(shape: &dyn SolidShape<D>, [outside, beside, inside]: [D::Vec; 3]) -> Meeting<D::Vec> {
    let on = |from: D::Vec, to: D::Vec| {
        let share = shape.crossing(from, to);
        // From the centre on, so that a shift changes no bit.
        (share, (from - shape.centre()) + (to - from) * share)
    };
    if beside == inside {
        let (q, arm) = on(outside, inside);
        return Meeting { q, arm, in_mirror: false };
    }
    let middle = (outside + beside) * 0.5;
    if shape.contains(middle) {
        let (share, arm) = on(outside, middle);
        Meeting { q: 0.5 * share, arm, in_mirror: false }
    } else {
        let (share, arm) = on(middle, inside);
        Meeting { q: 0.5 + 0.5 * share, arm, in_mirror: true }
    }
}

impl<D: Dim> Setup<D> {
    /// Density over that at rest, minus one, at a pressure \[Pa\] over that at rest.
    pub(crate) fn density_excess(&self, pressure: f64) -> f64 {
        3.0 * pressure / (self.density * self.lattice_speed().powi(2))
    }
}
