//! Walls that are thinner than a cell: they hold the nodes beside them whichever side material is on, so that material on one side would
//! feel, and carry, what is on the other. Such are refused.

use crate::mpm::Mpm;
use granular_core::walls::Pose;
use granular_core::{Dim, Linear, SetupError, Shape, StepError, Vector};
use std::collections::BTreeMap;

/// Cells within which both sides share nodes with a wall.
const NEAR: f64 = 1.0;
/// Cosine of the angle between the directions of two sides.
const OPPOSITE: f64 = -0.5;

/// A wall with material on both sides, and a particle there.
struct Found<'a> {
    wall: &'a str,
    id: u32,
}

fn is_thin<D: Dim>(shape: &Shape<D>, cell: f64) -> bool {
    match *shape {
        Shape::Plane { .. } => false,
        Shape::Block { low, high } => {
            let least = 0.999 * cell;
            (0..D::N).any(|axis| high.component(axis) - low.component(axis) < least)
        }
        _ => true,
    }
}

impl<D: Dim> Mpm<D> {
    /// Refuses material on both sides of a thin wall.
    pub(crate) fn check_thin_walls(&self) -> Result<(), SetupError> {
        self.between().map_or(Ok(()), |Found { wall, id }| {
            let allowed = "1: a wall that is thinner than a cell holds both of its sides; make it a block, two cells thick";
            let error = SetupError::new("sides with material", 2.0, allowed);
            Err(error.of(format_args!("wall `{wall}`, near particle {id}")))
        })
    }

    /// The same in a run.
    pub(crate) fn watch_thin_walls(&self) -> Result<(), StepError> {
        self.between().map_or(Ok(()), |Found { wall, id }| {
            Err(StepError::TooStiff {
                what: format!("sides of wall `{wall}` with material, near particle {id}"),
                value: 2.0,
                allowed: 1.0,
                hint: "a wall that is thinner than a cell holds both of its sides: make it a block, two cells thick"
                    .to_owned(),
            })
        })
    }

    fn between(&self) -> Option<Found<'_>> {
        let cell = self.grid.lattice.cell;
        let thin = |&(_, wall): &(usize, &crate::Wall<D>)| !wall.open && is_thin(&wall.shape, cell);
        self.walls.iter().enumerate().filter(thin).find_map(|(k, wall)| {
            let pose = self.moving.poses.get(k).copied().unwrap_or_default();
            let id = self.both_sides_of(&wall.shape, &pose)?;
            Some(Found { wall: &wall.name, id })
        })
    }

    /// A particle near a surface that has another on the opposite side.
    fn both_sides_of(&self, shape: &Shape<D>, pose: &Pose<D>) -> Option<u32> {
        let cell = self.grid.lattice.cell;
        let mut sides: BTreeMap<[i64; 3], D::Vec> = BTreeMap::new();
        for (&position, &id) in self.particles.position.iter().zip(&self.particles.id) {
            let at = pose.within_wall(position);
            let (distance, normal) = shape.distance(at);
            if distance > NEAR * cell || normal == D::Vec::ZERO {
                continue;
            }
            let foot = at - normal * distance;
            let along = |axis: usize, step: f64| {
                if axis < D::N { ((foot.component(axis) / cell).floor() + step) as i64 } else { 0 }
            };
            // The other side of a plate may be in the next cell.
            let around = (0..3_usize.pow(D::N as u32)).map(|k| -> [i64; 3] {
                std::array::from_fn(|axis| along(axis, (k / 3_usize.pow(axis as u32) % 3) as f64 - 1.0))
            });
            let opposite = |key: [i64; 3]| sides.get(&key).is_some_and(|other| other.dot(normal) < OPPOSITE);
            if around.into_iter().any(opposite) {
                return Some(id);
            }
            sides.entry(std::array::from_fn(|axis| along(axis, 0.0))).or_insert(normal);
        }
        None
    }
}
