//! What a snapshot holds: particles in their order, the blocks that they were sorted by, and what changes between stages.

use crate::layout::BlockAt;
use crate::ledger::Losses;
use crate::mpm::Mpm;
use crate::wall::Condition;
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Linear, Section, SnapshotError};

/// Names in a snapshot.
const BLOCKS: &str = "blocks";
const STARTS: &str = "starts of blocks";
const SORTED: &str = "travel and speed";
const LOSSES: &str = "losses";
const WALLS: &str = "friction of walls";

fn memory_of(group: usize) -> String {
    format!("memory of body {group}")
}

impl<D: Dim> Mpm<D> {
    pub(crate) fn save_state(&self, to: &mut Section) {
        self.particles.save(to);
        for (k, group) in self.groups.iter().enumerate() {
            group.body.save(&memory_of(k), to);
        }
        let homes = self.grid.homes();
        to.put_each(BLOCKS, homes.len(), |put| {
            homes.iter().for_each(|block| put(block.map(i32::cast_unsigned)));
        });
        let starts = self.groups.iter().map(|group| group.starts.len()).sum();
        to.put_each(STARTS, starts, |put| {
            self.groups.iter().for_each(|group| group.starts.iter().for_each(|&start| put(start)));
        });
        to.put(SORTED, &[self.travel, self.fastest]);
        to.put_each("looseness", self.groups.len(), |put| {
            self.groups.iter().for_each(|group| put(group.looseness));
        });
        to.put(LOSSES, &self.losses.to_array());
        to.put_one("energy put in", self.injected);
        to.put_one("steps", self.steps);
        to.put("gravity", &[self.gravity]);
        to.put_one("local damping", self.options.local_damping);
        to.put_each("open walls", self.walls.len(), |put| {
            self.walls.iter().for_each(|wall| put(u8::from(wall.open)));
        });
        to.put_each(WALLS, self.walls.len(), |put| {
            self.walls.iter().for_each(|wall| put(numbers_of(wall.condition)));
        });
        to.put("forces on walls", &self.wall_forces);
        self.contacts.save(to);
        self.clock.save(to);
        self.moving.save(to);
    }

    pub(crate) fn restore_state(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.particles.restore(from)?;
        for (k, group) in self.groups.iter_mut().enumerate() {
            group.body.restore(&memory_of(k), from)?;
        }
        self.restore_blocks(from)?;
        let numbers = |name: &str, count: usize| -> Result<Vec<f64>, SnapshotError> {
            let values: Vec<f64> = from.array_of(name, count)?;
            check_entry(name, values.iter().all(|value| value.is_finite()))?;
            Ok(values)
        };
        let sorted = numbers(SORTED, 2)?;
        (self.travel, self.fastest) = (sorted[0], sorted[1]);
        let looseness = numbers("looseness", self.groups.len())?;
        for (group, looseness) in self.groups.iter_mut().zip(looseness) {
            group.looseness = looseness;
        }
        let losses = numbers(LOSSES, 9)?;
        self.losses = Losses::from_array(std::array::from_fn(|k| losses[k]));
        self.injected = numbers("energy put in", 1)?[0];
        self.options.local_damping = numbers("local damping", 1)?[0];
        self.steps = from.one("steps")?;
        self.gravity = from.array_of("gravity", 1)?[0];
        check_entry("gravity", self.gravity.is_finite())?;
        let open: Vec<u8> = from.array_of("open walls", self.walls.len())?;
        let conditions: Vec<[f64; 3]> = from.array_of(WALLS, self.walls.len())?;
        check_entry(WALLS, conditions.iter().flatten().all(|value| value.is_finite()))?;
        for ((wall, open), condition) in self.walls.iter_mut().zip(open).zip(conditions) {
            (wall.open, wall.condition) = (open != 0, condition_of(condition));
        }
        self.wall_forces = from.array_of("forces on walls", self.walls.len())?;
        check_entry("forces on walls", self.wall_forces.iter().all(|force| force.is_finite()))?;
        self.contacts.restore(from)?;
        self.clock.restore(from)?;
        self.moving.restore(from)?;
        self.moving.place(self.clock.time());
        self.touches.forget();
        self.node_places.take();
        Ok(())
    }

    /// Blocks as particles were last sorted by them.
    fn restore_blocks(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let blocks: Vec<[u32; 3]> = from.array(BLOCKS)?;
        let blocks: Vec<BlockAt> = blocks.into_iter().map(|block| block.map(u32::cast_signed)).collect();
        check_entry(BLOCKS, blocks.is_sorted_by(|a, b| a < b))?;
        let length = blocks.len() + 1;
        let starts: Vec<u32> = from.array_of(STARTS, self.groups.len() * length)?;
        for (group, starts) in self.groups.iter_mut().zip(starts.chunks_exact(length)) {
            let ends = (group.starts[0], group.starts.last().copied());
            check_entry(STARTS, starts.is_sorted() && (starts[0], starts.last().copied()) == ends)?;
            group.starts.clear();
            group.starts.extend_from_slice(starts);
        }
        self.grid.settle(&blocks);
        Ok(())
    }
}

/// A condition as numbers: its kind and two coefficients.
fn numbers_of(condition: Condition) -> [f64; 3] {
    match condition {
        Condition::Fixed => [0.0; 3],
        Condition::Slip => [1.0, 0.0, 0.0],
        Condition::Absorbing { compression_speed, shear_speed } => [3.0, compression_speed, shear_speed],
        Condition::Frictional { friction, static_friction } => [2.0, friction, static_friction],
    }
}

fn condition_of([kind, first, second]: [f64; 3]) -> Condition {
    match kind as u8 {
        0 => Condition::Fixed,
        1 => Condition::Slip,
        2 => Condition::Frictional { friction: first, static_friction: second },
        _ => Condition::Absorbing { compression_speed: first, shear_speed: second },
    }
}
