//! The step.

use super::{Dem, view_of};
use crate::pass::Trouble;
use crate::periodic::{PeriodicCell, motion as cell_motion};
use crate::setup::ContactModel;
use crate::view::View;
use crate::{lists, motion, softness};
use granular_core::walls::Reaction;
use granular_core::{Dim, Linear, StepError};

/// Steps between re-sorting grains in memory. Tied to the count of steps, so that a restart
/// sorts at the same places.
const SORT_EVERY: u64 = 5000;
/// Below this number sorting does not pay.
const SORT_FROM: usize = 512;

impl<D: Dim> Dem<D> {
    /// Sorts grains in memory when the count of steps says so.
    fn sort_if_due(&mut self) {
        if self.sorts_after(0) {
            let (_, largest) = self.grains.radius_range();
            let order = self.grains.sort(2.0 * largest);
            self.list(0.0, Some(&order));
        }
    }

    /// Whether grains will be sorted when so many more steps are taken.
    fn sorts_after(&self, steps: u64) -> bool {
        (self.steps + steps).is_multiple_of(SORT_EVERY) && self.len() >= SORT_FROM
    }

    /// Takes steps, in a periodic cell or without one.
    pub(super) fn take_steps(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        // Between two steps of one call, the end of one and the start of the next may share a pass.
        let mut opened = false;
        for remaining in (0..steps).rev() {
            if !opened {
                self.sort_if_due();
                self.exchange_if_due();
                self.tend_cell();
                self.open_step(dt);
            }
            opened = remaining > 0 && self.runs_on();
            self.load_and_kick(dt, opened)?;
        }
        self.moving_walls.place(self.clock.time());
        Ok(())
    }

    /// Whether nothing is to be done between the next step and the one after it.
    fn runs_on(&self) -> bool {
        self.cell.is_none() && !self.sorts_after(1) && !self.looks_after(1)
    }

    /// First half of a step: drift, and predict the velocity at the middle.
    fn open_step(&mut self, dt: f64) {
        match self.cell.as_deref_mut() {
            Some(cell) => {
                let steps = [self.last_dt, dt];
                cell_motion::open_step(&mut self.grains, cell, self.blocks, steps, &mut self.speeds);
            }
            None => motion::open_step(&mut self.grains, self.blocks, dt, &mut self.speeds),
        }
    }

    /// One step between its two halves: lists, loads, kick.
    fn load_and_kick(&mut self, dt: f64, go_on: bool) -> Result<(), StepError> {
        let stride = self.stride(dt)?;
        self.travel += stride;
        // Much too long a list costs more than another one.
        if 2.0 * self.travel + stride > self.reach || self.reach > 4.0 * self.reach_for(stride) {
            self.list(stride, None);
        }
        self.push(dt, stride);
        self.last_dt = dt;
        if !self.moving_walls.is_empty() {
            self.move_walls(dt);
        }
        self.kick(dt, go_on);
        self.steps += 1;
        self.clock.step();
        let (losses, trouble) = self.pairs.outcome();
        self.losses += losses;
        if !self.losses.total().is_finite() {
            let (solver, quantity, step) = ("dem", "losses of energy", self.steps);
            return Err(StepError::NotFinite { solver, quantity, id: 0, step });
        }
        trouble.map_or(Ok(()), |trouble| Err(self.too_deep(trouble)))
    }

    /// Bound on how far any two surfaces approach in half a step \[m\]; walls are put where they are in its middle.
    fn stride(&mut self, dt: f64) -> Result<f64, StepError> {
        let mut own = motion::fastest(&self.speeds) * dt;
        if !self.moving_walls.is_empty() {
            own = own.max(self.moving_walls.fastest(dt) * dt);
            self.moving_walls.place_in_step(self.clock.time(), dt);
        }
        let stride = own + self.stride_of_flow(dt);
        let whole = self.cell().is_none_or(|cell| cell.edges().is_finite());
        if !(stride.is_finite() && whole) {
            return Err(self.not_finite());
        }
        self.drift_in_cell(own, stride)?;
        Ok(stride)
    }

    /// Kick and second half of the drift; the work of shaking and of loads of others is booked.
    fn kick(&mut self, dt: f64, go_on: bool) {
        let loaded = self.grains.takes_loads;
        let power = if loaded && self.options.ledger { self.power_of_loads() } else { 0.0 };
        if loaded {
            self.add_loads();
        }
        let shaking = self.shake(dt);
        let before = shaking.filter(|_| self.options.ledger).map(|_| self.momentum());
        let field = shaking.map_or(self.gravity, |shaking| self.gravity + shaking);
        if self.cell().is_some_and(PeriodicCell::deforms) {
            self.close_in_cell(dt, field);
        } else {
            let pairs = self.pairs.as_ref();
            motion::close_step(&mut self.grains, pairs, self.blocks, field, (dt, go_on), &mut self.speeds);
        }
        if let (Some(shaking), Some(before)) = (shaking, before) {
            self.injected += 0.5 * dt * shaking.dot(before + self.momentum());
        }
        if loaded && self.options.ledger {
            self.load_work += 0.5 * dt * (power + self.power_of_loads());
        }
    }

    /// Tells walls how grains pushed them.
    fn move_walls(&mut self, dt: f64) {
        self.moving_walls.reactions.fill(Reaction::default());
        self.pairs.add_reactions(&mut self.moving_walls.reactions);
        self.moving_walls.take_reactions(dt, self.options.ledger);
    }

    /// Writes the loads of all contacts where the accelerations will be.
    fn push(&mut self, dt: f64, margin: f64) {
        let mut force = std::mem::take(&mut self.grains.acceleration);
        let mut torque = std::mem::take(&mut self.grains.spin_acceleration);
        let seen = view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt);
        let (cell, law_reach) = (self.cell.as_deref(), self.pairs.reach());
        // In a cell that deforms, velocities are told in the laboratory.
        let started = cell.map(|cell| cell.start_velocity.as_slice()).filter(|list| !list.is_empty());
        let view = View {
            velocity: &self.grains.middle_velocity,
            spin: &self.grains.middle_spin,
            start_velocity: started.unwrap_or(seen.start_velocity),
            dt,
            predicts: self.pairs.predicts(),
            margin: margin + law_reach,
            law_reach,
            cell,
            ..seen
        };
        self.pairs.push(&view, self.options.ledger, &mut force, &mut torque);
        (self.grains.acceleration, self.grains.spin_acceleration) = (force, torque);
    }

    fn not_finite(&self) -> StepError {
        let grains = &self.grains;
        let at =
            lists::all_finite::<D>(&grains.position).or_else(|| lists::all_finite::<D>(&grains.velocity));
        let id = at.map_or(0, |index| u64::from(grains.id[index]));
        StepError::NotFinite { solver: "dem", quantity: "motion", id, step: self.steps }
    }

    fn too_deep(&self, trouble: Trouble) -> StepError {
        let id = self.grains.id[trouble.first as usize];
        let (share, allowed) = (trouble.overlap / trouble.radius, crate::view::DEEPEST);
        // As if this was the hardest impact; it may be harder still a step later.
        let stiffer = match self.options.contact {
            ContactModel::Linear => {
                let factor = softness::softer_than(share / allowed, softness::LINEAR);
                format!("raise the normal stiffness at least {factor}-fold")
            }
            ContactModel::Hertz => {
                let factor = softness::softer_than(share / allowed, softness::HERTZ);
                format!("raise Young's modulus at least {factor}-fold")
            }
        };
        StepError::TooStiff {
            what: format!("overlap over radius at grain {id} in step {}", self.steps),
            value: share,
            allowed,
            hint: format!("{stiffer}, or lower the speed of the grains"),
        }
    }
}
