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
    /// Momentum that the wall gave to the node in the last step \[N s\]: by friction, by keeping it out, and by
    /// absorbing waves.
    impulses: [D::Vec; 3],
    /// Energy lost there in the last step \[J\], by the same.
    pub(crate) lost: [f64; 3],
    /// How much the wall had to slow the node down to keep it out, so far in this step.
    press: f64,
    /// Whether the wall keeps the node out in this step.
    is_pressed: bool,
    /// Whether the node sticks to the wall in this step.
    sticks: bool,
}

/// All nodes that walls act on, block by block.
#[derive(Clone, Debug)]
pub(crate) struct Touches<D: Dim> {
    /// Where those of each block begin, and the end of the last; a block has them once for every field.
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
            let first = self.list.len();
            self.starts.push(first as u32);
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
                        impulses: [D::Vec::ZERO; 3],
                        lost: [0.0; 3],
                        press: 0.0,
                        is_pressed: false,
                        sticks: false,
                    });
                }
            }
            let of_one_field = first..self.list.len();
            (1..grid.fields).for_each(|_| self.list.extend_from_within(of_one_field.clone()));
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
        (self.press, self.impulses, self.lost) = (0.0, [D::Vec::ZERO; 3], [0.0; 3]);
        (self.is_pressed, self.sticks) = (false, false);
    }

    /// The velocity without what moves against the wall, or with it.
    fn along(&self, velocity: D::Vec) -> D::Vec {
        velocity - self.normal * self.outward(velocity)
    }

    /// How fast something moves out of the wall.
    fn outward(&self, velocity: D::Vec) -> f64 {
        (velocity - self.velocity).dot(self.normal)
    }

    /// Whether the node may leave the wall.
    fn lets_go(&self, condition: Condition) -> bool {
        matches!(condition, Condition::Frictional { .. }) && !self.both_sides
    }

    /// Keeps a velocity out of the wall.
    fn keep_out(&self, condition: Condition, velocity: D::Vec) -> D::Vec {
        match condition {
            Condition::Fixed => self.velocity,
            Condition::Absorbing { .. } => velocity,
            _ if self.lets_go(condition) && self.outward(velocity) >= 0.0 => velocity,
            _ => self.along(velocity),
        }
    }

    /// Notes whether the wall acts on a node that would have this velocity.
    fn note(&mut self, condition: Condition, velocity: D::Vec) {
        self.is_pressed = !self.lets_go(condition) || self.outward(velocity) < 0.0;
    }

    /// A velocity with what the wall does to the node in this step.
    fn hold(&self, condition: Condition, velocity: D::Vec) -> D::Vec {
        match condition {
            Condition::Fixed => self.velocity,
            Condition::Absorbing { .. } => velocity,
            _ if self.sticks => self.velocity,
            _ if self.is_pressed => self.along(velocity),
            _ => self.keep_out(condition, velocity),
        }
    }

    /// Stops a node that moves into the wall. Returns its new velocity.
    fn stop(&mut self, condition: Condition, velocity: D::Vec) -> D::Vec {
        let after = self.keep_out(condition, velocity);
        self.press += (after - velocity).dot(self.normal).abs();
        after
    }

    /// Slows a node that rubs. Returns its new velocity.
    fn rub(&mut self, condition: Condition, velocity: D::Vec) -> D::Vec {
        let Condition::Frictional { friction, static_friction } = condition else { return velocity };
        let relative = velocity - self.velocity;
        let along = relative - self.normal * relative.dot(self.normal);
        let speed = along.length();
        self.sticks = self.is_pressed && speed <= static_friction * self.press;
        if self.sticks {
            velocity - along
        } else if speed > 0.0 {
            velocity - along * (friction * self.press / speed).min(1.0)
        } else {
            velocity
        }
    }

    /// Momentum that the wall gave to the node in the last step \[N s\].
    pub(crate) fn impulse(&self) -> D::Vec {
        self.impulses[0] + self.impulses[1] + self.impulses[2]
    }

    /// Books the work of a step in which the node went from one velocity to another: that of each push on the mean of both. What
    /// presses on a wall at rest and stays there loses nothing.
    fn book(&mut self, before: D::Vec, after: D::Vec) {
        let mean = (before + after) * 0.5 - self.velocity;
        self.lost = self.impulses.map(|impulse| -impulse.dot(mean));
        // A node behind the wall with next to no mass flies off in the step, but particles feel no more than its momentum.
        self.lost[2] = -self.impulses[2].dot(before - self.velocity);
    }
}

/// Walls at one node.
pub(crate) struct Meeting<'a, D: Dim> {
    pub(crate) touches: &'a mut [Touch<D>],
    pub(crate) walls: &'a [Wall<D>],
    pub(crate) mass: f64,
    /// Step over the edge of a cell \[s/m\].
    pub(crate) dt_per_cell: f64,
}

impl<D: Dim> Meeting<'_, D> {
    fn condition(walls: &[Wall<D>], touch: &Touch<D>) -> Condition {
        walls[touch.wall as usize].condition
    }

    /// Whether more walls than one act: those that do not meet at right angles push a node into one another.
    fn rounds(&self) -> usize {
        if self.touches.len() > 1 { 4 } else { 1 }
    }

    /// Lets walls act on a node with a mean velocity and a change of it by forces: first all keep it out, then those with
    /// friction rub. Returns its velocity before and after.
    ///
    /// What the nodes beside a wall have of the particles before it is no motion into the wall, or out of one that presses: it is
    /// left out without a push, and particles feel the wall by their stresses.
    pub(crate) fn act(&mut self, mean: D::Vec, change: D::Vec) -> (D::Vec, D::Vec) {
        self.touches.iter_mut().for_each(Touch::rest);
        if self.touches.is_empty() {
            return (mean, mean + change);
        }
        let out = self.fold(mean, |touch, condition, now| touch.keep_out(condition, now));
        let before = self.fold(out, |touch, condition, now| {
            touch.note(condition, now + change);
            touch.hold(condition, now)
        });
        let absorbed = self.absorb(before, before + change);
        let stopped = self.stop(absorbed);
        let rubbed = self.rub(stopped);
        // Friction of one wall may push into another.
        let after = if self.touches.len() > 1 { self.stop(rubbed) } else { rubbed };
        self.touches.iter_mut().for_each(|touch| touch.book(before, after));
        (before, after)
    }

    /// A velocity with what walls have done to the node in this step.
    pub(crate) fn hold(&mut self, velocity: D::Vec) -> D::Vec {
        self.fold(velocity, |touch, condition, now| touch.hold(condition, now))
    }

    fn fold(
        &mut self,
        velocity: D::Vec,
        mut change: impl FnMut(&mut Touch<D>, Condition, D::Vec) -> D::Vec,
    ) -> D::Vec {
        let mut now = velocity;
        for _ in 0..self.rounds() {
            for touch in &mut *self.touches {
                now = change(touch, Self::condition(self.walls, touch), now);
            }
        }
        now
    }

    fn stop(&mut self, velocity: D::Vec) -> D::Vec {
        let mass = self.mass;
        self.fold(velocity, |touch, condition, before| {
            let after = touch.stop(condition, before);
            touch.impulses[1] += (after - before) * mass;
            after
        })
    }

    /// Dashpots `rho c` on the surface that a node on a wall stands for, `2 m / (rho h)`, which act on its mean velocity over the step.
    fn absorb(&mut self, before: D::Vec, after: D::Vec) -> D::Vec {
        let mut now = after;
        for touch in &mut *self.touches {
            let Condition::Absorbing { compression_speed, shear_speed } = Self::condition(self.walls, touch)
            else {
                continue;
            };
            let [early, late] = [before, now].map(|velocity| velocity - touch.velocity);
            let damped = |early: D::Vec, late: D::Vec, speed: f64| {
                let half = speed * self.dt_per_cell;
                (late - early * half) * (1.0 / (1.0 + half))
            };
            let normal = |velocity: D::Vec| touch.normal * velocity.dot(touch.normal);
            let slowed = damped(normal(early), normal(late), compression_speed)
                + damped(early - normal(early), late - normal(late), shear_speed)
                + touch.velocity;
            touch.impulses[2] += (slowed - now) * self.mass;
            now = slowed;
        }
        now
    }

    fn rub(&mut self, velocity: D::Vec) -> D::Vec {
        let mut now = velocity;
        for touch in &mut *self.touches {
            let after = touch.rub(Self::condition(self.walls, touch), now);
            touch.impulses[0] += (after - now) * self.mass;
            now = after;
        }
        now
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    /// Dashpots on the mean velocity over the step: `(v' - v) h = -c dt (v' + v)`, for each kind of wave its own, beside a wall that moves.
    #[test]
    fn absorbing_walls_slow_both_kinds_of_waves() {
        let absorbing = Condition::Absorbing { compression_speed: 3.0, shear_speed: 1.0 };
        let wall = Wall::<D2>::plane("wall", DVec2::ZERO, DVec2::X, absorbing).unwrap();
        let mut touch = Touch::<D2> {
            node: 0,
            wall: 0,
            normal: DVec2::X,
            both_sides: false,
            velocity: DVec2::new(0.5, 0.0),
            impulses: [DVec2::ZERO; 3],
            lost: [0.0; 3],
            press: 0.0,
            is_pressed: false,
            sticks: false,
        };
        let touches = std::slice::from_mut(&mut touch);
        let mut meeting = Meeting { touches, walls: &[wall], mass: 2.0, dt_per_cell: 0.1 };
        let (before, after) = meeting.act(DVec2::new(1.5, 1.0), DVec2::ZERO);
        assert_eq!(before, DVec2::new(1.5, 1.0));
        assert!((after - DVec2::new(0.5 + 0.7 / 1.3, 0.9 / 1.1)).length() < 1e-15, "{after}");
        assert!((touch.impulse() - (after - before) * 2.0).length() < 1e-15);
        assert!(touch.lost[2] > 0.0 && touch.lost[..2] == [0.0; 2]);
    }
}
