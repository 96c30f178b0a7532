//! What a snapshot holds: grains, memories of contacts, and what changes between stages.

use crate::dem::Dem;
use crate::ledger::Losses;
use crate::material::MaterialId;
use crate::shaking;
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Linear, Section, SnapshotError};

/// Names in a snapshot.
const FREE_SPINS: &str = "spins without friction";
const LOAD_WORK: &str = "work of loads";

impl<D: Dim> Dem<D> {
    pub(crate) fn save_state(&self, to: &mut Section) {
        self.grains.save(to);
        self.pairs.save(&self.grains, &self.walls, to);
        to.put_one("steps", self.steps);
        to.put_one("last step taken", self.last_dt);
        to.put("gravity", &[self.gravity]);
        shaking::save(self.shaken.as_ref(), to);
        to.put("losses", &self.losses.to_array());
        if self.turns() && !self.pairs.tangential() {
            to.put_one(FREE_SPINS, 1_u8);
        }
        if self.grains.takes_loads {
            to.put_one(LOAD_WORK, self.load_work);
        }
        to.put("energy put in and at the start", &[self.injected, self.initial_energy.unwrap_or(0.0)]);
        if let Some(cell) = self.cell() {
            cell.save(to);
        }
        let open: Vec<u8> = self.walls.iter().map(|wall| u8::from(wall.open)).collect();
        to.put("open walls", &open);
        let friction: Vec<f64> =
            (0..self.materials.len()).map(|k| self.materials.get(MaterialId(k as u8)).friction).collect();
        to.put("friction", &friction);
        if self.keeps_time() {
            self.clock.save(to);
        }
        self.moving_walls.save(to);
        self.inlets.save(to);
    }

    /// Whether anything depends on the time.
    fn keeps_time(&self) -> bool {
        !self.moving_walls.is_empty() || !self.inlets.is_empty()
    }

    pub(crate) fn restore_state(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let friction: Vec<f64> = from.array_of("friction", self.materials.len())?;
        for (k, &value) in friction.iter().enumerate() {
            self.materials.set_friction(MaterialId(k as u8), value);
        }
        // Not asked of the friction: grains go on turning after it was taken away.
        let turning = !from.array::<D::Spin>("spin")?.is_empty();
        let freely = from.entries().any(|(name, _)| name == FREE_SPINS);
        self.take_materials(turning && !freely);
        if freely {
            self.let_turn();
        }
        self.grains.restore(from, !self.inlets.is_empty())?;
        let blocks = self.cut();
        self.pairs.resize(blocks);
        self.pairs.restore(from, &self.grains, &self.walls)?;
        if let Some(cell) = self.cell.as_deref_mut() {
            cell.restore(from)?;
        }
        self.steps = from.one("steps")?;
        self.last_dt = from.one("last step taken")?;
        // That step was checked when it was first taken: a run goes on as it would have.
        self.unchecked = self.last_dt == 0.0;
        self.gravity = from.array_of("gravity", 1)?[0];
        self.shaken = shaking::restore(from)?;
        let losses: Vec<f64> = from.array_of("losses", 5)?;
        self.losses = Losses::from_array(std::array::from_fn(|k| losses[k]));
        let energy: Vec<f64> = from.array_of("energy put in and at the start", 2)?;
        self.injected = energy[0];
        self.load_work = if self.grains.takes_loads { from.one(LOAD_WORK)? } else { 0.0 };
        check_entry(LOAD_WORK, self.load_work.is_finite())?;
        self.initial_energy = self.options.ledger.then_some(energy[1]);
        let open: Vec<u8> = from.array_of("open walls", self.walls.len())?;
        self.walls.iter_mut().zip(open).for_each(|(wall, open)| wall.open = open != 0);
        check_entry("friction", friction.iter().all(|mu| mu.is_finite() && *mu >= 0.0))?;
        check_entry("last step taken", self.last_dt.is_finite() && self.last_dt >= 0.0)?;
        check_entry("gravity", self.gravity.is_finite())?;
        check_entry("losses", losses.iter().all(|loss| loss.is_finite()))?;
        check_entry("energy put in and at the start", energy.iter().all(|e| e.is_finite()))?;
        if self.keeps_time() {
            self.clock.restore(from)?;
        }
        self.moving_walls.restore(from)?;
        self.moving_walls.place(self.clock.time());
        self.inlets.restore(from)?;
        self.list(0.0, None);
        Ok(())
    }
}
