//! What walls do to nodes.

use crate::grid::Grid;
use crate::layout::block_cells;
use crate::wall::{Condition, Wall};
use granular_core::shape::{Block, SolidShape};
use granular_core::walls::{MovingWalls, Pose};
use granular_core::{Dim, Linear, Shape, Vector};

/// Distance in cells at which a node counts as on a surface.
const ON_SURFACE: f64 = 1e-6;

/// A node that a wall acts on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<D: Dim> {
    /// The node within its block.
    pub(crate) node: u32,
    /// The wall.
    pub(crate) wall: u32,
    /// Unit vector out of the wall.
    normal: D::Vec,
    /// Whether the wall holds the node from both sides.
    both_sides: bool,
    /// Velocity of the wall there.
    pub(crate) velocity: D::Vec,
    /// Momentum that the wall gave to the node in the last step \[N s\].
    pub(crate) impulse: D::Vec,
    /// Energy lost there in the last step \[J\]: to friction, and to stopping.
    pub(crate) lost: [f64; 2],
    /// How much the wall had to slow the node down to keep it out, so far in this step.
    press: f64,
}

/// All nodes that walls act on, block by block.
#[derive(Clone, Debug)]
pub(crate) struct Touches<D: Dim> {
    /// Where those of each block begin, and the end of the last.
    pub(crate) starts: Vec<u32>,
    pub(crate) list: Vec<Touch<D>>,
    /// Version of the grid for which they were found; none when they must be found anew.
    found_for: Option<u64>,
}

impl<D: Dim> Touches<D> {
    pub(crate) fn new() -> Self {
        Self { starts: Vec::new(), list: Vec::new(), found_for: None }
    }

    /// Walls have changed.
    pub(crate) fn forget(&mut self) {
        self.found_for = None;
    }

    /// Finds them, if they may be others than before.
    pub(crate) fn find(&mut self, grid: &Grid<D>, walls: &[Wall<D>], moving: &MovingWalls<D>) {
        if self.found_for == Some(grid.version) && moving.is_empty() {
            return;
        }
        self.found_for = Some(grid.version);
        self.starts.clear();
        self.list.clear();
        let rests = Pose::default();
        for &block in grid.blocks() {
            self.starts.push(self.list.len() as u32);
            for node in 0..block_cells::<D>() {
                let at = grid.lattice.node(block, node);
                for (wall, description) in walls.iter().enumerate().filter(|(_, wall)| !wall.open) {
                    let pose = moving.poses.get(wall).unwrap_or(&rests);
                    let near = behind(&description.shape, pose.within_wall(at), grid.lattice.cell);
                    let Some((normal, both_sides)) = near else { continue };
                    self.list.push(Touch {
                        node: node as u32,
                        wall: wall as u32,
                        normal: pose.out_of_wall(normal),
                        both_sides,
                        velocity: pose.velocities(at).0,
                        impulse: D::Vec::ZERO,
                        lost: [0.0; 2],
                        press: 0.0,
                    });
                }
            }
        }
        self.starts.push(self.list.len() as u32);
    }
}

/// Whether a node is behind a surface or on it: the unit vector out of the wall, and whether it is held from both sides.
fn behind<D: Dim>(shape: &Shape<D>, at: D::Vec, cell: f64) -> Option<(D::Vec, bool)> {
    let on_surface = ON_SURFACE * cell;
    match *shape {
        Shape::Plane { point, normal } => ((at - point).dot(normal) <= on_surface).then_some((normal, false)),
        Shape::Block { low, high } if (0..D::N).all(|axis| low.component(axis) < high.component(axis)) => {
            let (distance, normal) = Block::<D> { low, high }.distance(at)?;
            (distance <= on_surface).then_some((normal, false))
        }
        _ => {
            // Half of the diagonal of a cell, so that no row of nodes slips through.
            let reach = 0.5 * (D::N as f64).sqrt() * cell;
            let (distance, normal) = shape.distance(at);
            if distance > reach {
                return None;
            }
            Some((if distance > on_surface { normal } else { normal_on(shape, at, cell) }, true))
        }
    }
}

/// Normal of a thin surface at a point on it, by the step along an axis that leads farthest away.
fn normal_on<D: Dim>(shape: &Shape<D>, at: D::Vec, cell: f64) -> D::Vec {
    let aside = (0..D::N).map(|axis| shape.distance(at + D::Vec::along(axis, 1e-3 * cell)));
    let farther = |a: (f64, D::Vec), b: (f64, D::Vec)| if b.0 > a.0 { b } else { a };
    aside.reduce(farther).map_or(D::Vec::ZERO, |(_, normal)| normal)
}

impl<D: Dim> Touch<D> {
    /// Nothing has happened yet in this step.
    pub(crate) fn rest(&mut self) {
        (self.press, self.impulse, self.lost) = (0.0, D::Vec::ZERO, [0.0; 2]);
    }

    /// Keeps a node out of the wall. Returns its new velocity.
    fn stop(&mut self, condition: Condition, velocity: D::Vec) -> D::Vec {
        let into = (velocity - self.velocity).dot(self.normal);
        match condition {
            Condition::Fixed => self.velocity,
            Condition::Frictional { .. } if into >= 0.0 && !self.both_sides => velocity,
            Condition::Slip | Condition::Frictional { .. } => {
                self.press += into.abs();
                velocity - self.normal * into
            }
        }
    }

    /// Slows a node that rubs. Returns its new velocity.
    fn rub(&self, condition: Condition, velocity: D::Vec) -> D::Vec {
        let Condition::Frictional { friction, static_friction } = condition else { return velocity };
        let relative = velocity - self.velocity;
        let along = relative - self.normal * relative.dot(self.normal);
        let speed = along.length();
        if speed <= static_friction * self.press {
            velocity - along
        } else {
            velocity - along * (friction * self.press / speed).min(1.0)
        }
    }

    /// Books a change of velocity, as one of the two losses.
    fn book(&mut self, mass: f64, before: D::Vec, after: D::Vec, loss: usize) {
        let impulse = (after - before) * mass;
        self.impulse += impulse;
        self.lost[loss] -= impulse.dot((before + after) * 0.5 - self.velocity);
    }
}

/// Lets walls act on a node of some mass: first all keep it out, then those with friction rub. Returns its new velocity.
pub(crate) fn meet<D: Dim>(
    touches: &mut [Touch<D>],
    walls: &[Wall<D>],
    mass: f64,
    velocity: D::Vec,
) -> D::Vec {
    let condition = |touch: &Touch<D>| walls[touch.wall as usize].condition;
    let mut now = velocity;
    // Walls that do not meet at right angles push a node into one another.
    let rounds = if touches.len() > 1 { 4 } else { 1 };
    for _ in 0..rounds {
        now = stop_all(touches, walls, mass, now);
    }
    for touch in &mut *touches {
        let after = touch.rub(condition(touch), now);
        touch.book(mass, now, after, 0);
        now = after;
    }
    if touches.len() > 1 { stop_all(touches, walls, mass, now) } else { now }
}

fn stop_all<D: Dim>(touches: &mut [Touch<D>], walls: &[Wall<D>], mass: f64, velocity: D::Vec) -> D::Vec {
    touches.iter_mut().fold(velocity, |before, touch| {
        let after = touch.stop(walls[touch.wall as usize].condition, before);
        touch.book(mass, before, after, 1);
        after
    })
}

/// Keeps a node out of walls without booking it.
pub(crate) fn keep_out<D: Dim>(touches: &[Touch<D>], walls: &[Wall<D>], velocity: D::Vec) -> D::Vec {
    touches.iter().fold(velocity, |before, touch| {
        let mut unbooked = *touch;
        unbooked.stop(walls[touch.wall as usize].condition, before)
    })
}
