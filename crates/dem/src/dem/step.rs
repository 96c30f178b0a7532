//! The step.

use super::{Dem, view_of};
use crate::pass::Trouble;
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
    pub(crate) fn sort_if_due(&mut self) {
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

    /// Steps without a periodic cell.
    pub(super) fn advance_in_the_open(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        // Between two steps of one call, the end of one and the start of the next share a pass.
        let mut opened = false;
        for remaining in (0..steps).rev() {
            if !opened {
                self.sort_if_due();
                self.exchange_if_due();
                motion::open_step(&mut self.grains, self.blocks, dt, &mut self.speeds);
            }
            opened = remaining > 0 && !self.sorts_after(1) && !self.looks_after(1);
            self.load_and_kick(dt, opened)?;
        }
        self.moving_walls.place(self.clock.time());
        Ok(())
    }

    /// One step between its two halves: lists, loads, kick.
    fn load_and_kick(&mut self, dt: f64, go_on: bool) -> Result<(), StepError> {
        let mut stride = motion::fastest(&self.speeds) * dt;
        if !self.moving_walls.is_empty() {
            stride = stride.max(self.moving_walls.fastest(dt) * dt);
            self.moving_walls.place_in_step(self.clock.time(), dt);
        }
        if !stride.is_finite() {
            return Err(self.not_finite());
        }
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
        let shaking = self.shake(dt);
        let before = shaking.filter(|_| self.options.ledger).map(|_| self.momentum());
        let (pairs, gravity) = (self.pairs.as_ref(), self.gravity + shaking.unwrap_or(D::Vec::ZERO));
        motion::close_step(&mut self.grains, pairs, self.blocks, gravity, dt, go_on, &mut self.speeds);
        if let (Some(shaking), Some(before)) = (shaking, before) {
            self.injected += 0.5 * dt * shaking.dot(before + self.momentum());
        }
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

    /// Tells walls how grains pushed them.
    pub(crate) fn move_walls(&mut self, dt: f64) {
        self.moving_walls.reactions.fill(Reaction::default());
        self.pairs.add_reactions(&mut self.moving_walls.reactions);
        self.moving_walls.take_reactions(dt, self.options.ledger);
    }

    /// Writes the loads of all contacts where the accelerations will be.
    fn push(&mut self, dt: f64, margin: f64) {
        let mut force = std::mem::take(&mut self.grains.acceleration);
        let mut torque = std::mem::take(&mut self.grains.spin_acceleration);
        let view = View {
            velocity: &self.grains.middle_velocity,
            spin: &self.grains.middle_spin,
            dt,
            predicts: self.pairs.predicts(),
            margin,
            ..view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt)
        };
        self.pairs.push(&view, self.options.ledger, &mut force, &mut torque);
        (self.grains.acceleration, self.grains.spin_acceleration) = (force, torque);
    }

    pub(crate) fn not_finite(&self) -> StepError {
        let grains = &self.grains;
        let at =
            lists::all_finite::<D>(&grains.position).or_else(|| lists::all_finite::<D>(&grains.velocity));
        let id = at.map_or(0, |index| u64::from(grains.id[index]));
        StepError::NotFinite { solver: "dem", quantity: "motion", id, step: self.steps }
    }

    pub(crate) fn too_deep(&self, trouble: Trouble) -> StepError {
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
