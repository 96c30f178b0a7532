//! What lies below grains: a scene without a floor is found before it is run, and a run whose grains are all gone ends.

use crate::dem::Dem;
use crate::walls::Wall;
use granular_core::Shape;
use granular_core::shape::corners;
use granular_core::{Dim, Linear, Vector};

/// Grains under gravity that nothing can catch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falling<D: Dim> {
    /// Unit vector along gravity.
    pub down: D::Vec,
    /// Grains with no wall below them.
    pub grains: usize,
    /// How far the highest point of all grains is along gravity, from the origin \[m\].
    pub highest: f64,
}

impl<D: Dim> Dem<D> {
    /// Corners of a box \[m\] around all grains, walls with an end, and the points by which planes are given; none without any.
    pub fn bounds(&self) -> Option<(D::Vec, D::Vec)> {
        let of_grain = |(&position, &radius): (&D::Vec, &f64)| {
            (position - D::Vec::splat(radius), position + D::Vec::splat(radius))
        };
        let of_wall = |wall: &Wall<D>| {
            wall.shape.bounds().unwrap_or_else(|| (wall.shape.reference(), wall.shape.reference()))
        };
        let grains = self.grains.position.iter().zip(&self.grains.radius).map(of_grain);
        grains.chain(self.walls.iter().map(of_wall)).reduce(|(a, b), (low, high)| (a.min(low), b.max(high)))
    }

    /// Whether something catches any grain that falls along a gravity \[m/s^2\]: a plane that faces up, or a wall that moves,
    /// which may be anywhere. In a periodic cell every wall is below some image.
    pub fn catches_all(&self, gravity: D::Vec, gates: Gates) -> bool {
        self.walls.iter().filter(|wall| gates.count(wall)).any(|wall| match wall.shape {
            _ if wall.motion.is_some() => true,
            Shape::Plane { normal, .. } => normal.dot(gravity) < -1e-9 * gravity.length(),
            _ => self.cell().is_some(),
        })
    }

    /// How the grains fall along a gravity \[m/s^2\]; none without gravity or grains. Walls are taken by the boxes around
    /// them, so a funnel is below what stands in it.
    pub fn falling(&self, gravity: D::Vec, gates: Gates) -> Option<Falling<D>> {
        let strength = gravity.length();
        if strength.is_nan() || strength <= 0.0 || self.is_empty() {
            return None;
        }
        let down = gravity * (1.0 / strength);
        let walls = self.walls.iter().filter(|wall| gates.count(wall));
        let below: Vec<Beneath<D>> = walls.filter_map(|wall| Beneath::of(wall, down)).collect();
        let place = |index: usize| (self.grains.position[index], self.grains.radius[index]);
        let caught = |index: usize| below.iter().any(|wall| wall.is_below(place(index)));
        let all = 0..self.len();
        let grains =
            if self.catches_all(gravity, gates) { 0 } else { all.clone().filter(|&i| !caught(i)).count() };
        let depth = |index: usize| place(index).0.dot(down) - place(index).1;
        let highest = all.map(depth).fold(f64::INFINITY, f64::min);
        Some(Falling { down, grains, highest })
    }

    /// Whether grains may still come in through an inlet.
    pub fn brings_grains(&self) -> bool {
        self.inlets.brings_grains()
    }

    /// Whether grains that leave some region are taken out.
    pub fn has_outlets(&self) -> bool {
        self.inlets.has_outlets()
    }
}

/// Whether walls that are open catch grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gates {
    /// As if they were shut: they are until some stage opens them.
    Shut,
    /// They are as they are.
    AsTheyAre,
}

impl Gates {
    fn count<D: Dim>(self, wall: &Wall<D>) -> bool {
        self == Self::Shut || !wall.open
    }
}

/// The bounds of a wall, as they look along gravity.
struct Beneath<D: Dim> {
    across: Vec<(D::Vec, [f64; 2])>,
    down: D::Vec,
    deepest: f64,
}

impl<D: Dim> Beneath<D> {
    /// None for planes.
    fn of(wall: &Wall<D>, down: D::Vec) -> Option<Self> {
        let (low, high) = wall.shape.bounds()?;
        let range = |way: D::Vec| {
            let along = corners::<D>(low, high).map(move |corner| corner.dot(way));
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let across = level_directions::<D>(down).into_iter().map(|way| (way, range(way))).collect();
        Some(Self { across, down, deepest: range(down)[1] })
    }

    fn is_below(&self, (position, radius): (D::Vec, f64)) -> bool {
        let meets = |(way, [low, high]): &(D::Vec, [f64; 2])| {
            let at = position.dot(*way);
            at + radius >= *low && at - radius <= *high
        };
        self.deepest >= position.dot(self.down) - radius && self.across.iter().all(meets)
    }
}

/// Unit vectors at right angles to `down`.
fn level_directions<D: Dim>(down: D::Vec) -> Vec<D::Vec> {
    let mut found: Vec<D::Vec> = Vec::new();
    // The axis along which `down` points most gives none of its own.
    let steepest = (0..D::N).max_by(|&a, &b| down.component(a).abs().total_cmp(&down.component(b).abs()));
    for axis in (0..D::N).filter(|axis| Some(*axis) != steepest) {
        let mut way = D::Vec::along(axis, 1.0);
        for known in found.iter().chain([&down]) {
            way -= *known * way.dot(*known);
        }
        found.push(way * (1.0 / way.length()));
    }
    found
}
