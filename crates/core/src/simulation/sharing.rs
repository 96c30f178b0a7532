//! How solvers share a step: how many each takes within a longer one.

use super::graph::Graph;
use super::node::{FIT, exactly};
use super::order::Group;
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, StepError, StepLimit, StepRule};

impl Graph {
    /// Divides a step \[s\] of the simulation among its solvers at the start of a segment. One alone takes it whole, and so
    /// do the slow solvers of a single group; of several groups each has its own long step, a whole part of that step.
    /// In a simulation that `has_begun`, one alone whose limit has fallen below the step since takes several steps within it.
    pub(super) fn share(&mut self, step: f64, has_begun: bool) -> Result<(), StepError> {
        if let [alone] = &mut self.nodes[..] {
            (alone.substeps, alone.dt) = (1, step);
            if !alone.solver.hard_limits_may_change() {
                return Ok(());
            }
            let limits = self.hard_limits_of(0);
            return if has_begun {
                self.share_alone(step, &limits)
            } else {
                self.nodes[0].check_allowed(step, &limits)
            };
        }
        self.nodes.iter_mut().for_each(|node| node.substeps = 1);
        let limits: Vec<Limits> = (0..self.nodes.len()).map(|k| self.limits_of(k)).collect();
        self.share_by(step, &limits)
    }

    /// Divides it anew within a segment by the limits that must not be exceeded: solvers whose limits have fallen below their
    /// steps take more of them than before, none takes fewer.
    pub(super) fn share_again(&mut self, step: f64) -> Result<(), StepError> {
        let limits: Vec<Limits> = (0..self.nodes.len()).map(|k| self.hard_limits_of(k)).collect();
        match &limits[..] {
            [alone] => self.share_alone(step, alone),
            _ => self.share_by(step, &limits),
        }
    }

    fn share_alone(&mut self, step: f64, limits: &Limits) -> Result<(), StepError> {
        let alone = &mut self.nodes[0];
        if exactly(limits).is_some()
            || alone.dt <= limits.largest_allowed().map_or(f64::INFINITY, |limit| limit.dt)
        {
            return alone.check_allowed(alone.dt, limits);
        }
        (alone.substeps, alone.dt) = alone.divide(step, limits, alone.substeps)?;
        Ok(())
    }

    fn share_by(&mut self, step: f64, limits: &[Limits]) -> Result<(), StepError> {
        (0..self.groups.len()).try_for_each(|group| self.share_in_group(group, step, limits))?;
        self.begin_laws();
        Ok(())
    }

    fn share_in_group(&mut self, group: usize, step: f64, limits: &[Limits]) -> Result<(), StepError> {
        let slow = self.groups[group].slow.clone();
        let mut long_steps = 1;
        if self.groups.len() > 1 {
            for &k in &slow {
                let (steps, _) = self.nodes[k].divide(step, &limits[k], self.nodes[k].substeps)?;
                long_steps = long_steps.max(steps);
            }
        }
        let long = step / long_steps as f64;
        for k in slow {
            let dt = self.nodes[k].whole(long, &limits[k])?;
            (self.nodes[k].substeps, self.nodes[k].dt) = (long_steps, dt);
        }
        let partners = self.groups[group].partners.clone();
        partners.into_iter().try_for_each(|fast| self.share_with(fast, long, limits))
    }

    /// Divides a longer step \[s\] for a fast solver, and its own steps for those that are fast to it.
    fn share_with(&mut self, fast: usize, long: f64, limits: &[Limits]) -> Result<(), StepError> {
        let (substeps, dt) = self.nodes[fast].divide(long, &limits[fast], self.nodes[fast].substeps)?;
        (self.nodes[fast].substeps, self.nodes[fast].dt) = (substeps, dt);
        let partners = self.nodes[fast].partners.clone();
        partners.into_iter().try_for_each(|partner| self.share_with(partner, dt, limits))
    }

    fn begin_laws(&mut self) {
        let Self { nodes, edges, .. } = self;
        edges.iter_mut().for_each(|edge| edge.begin(nodes[edge.ends()[0]].dt));
    }

    /// Whether there is anything to ask again for within a segment.
    pub(super) fn limits_may_change(&self) -> bool {
        !self.edges.is_empty() || self.nodes.iter().any(|node| node.solver.hard_limits_may_change())
    }

    /// Saves how steps are shared, which depends on the state when limits were last asked for. Nothing where every solver
    /// takes each step \[s\] of the simulation whole.
    pub(super) fn save_shares(&self, clock: &mut Section, step: f64) {
        if self.nodes.iter().any(|node| (node.substeps, node.dt) != (1, step)) {
            let shares: Vec<(u64, f64)> = self.nodes.iter().map(|node| (node.substeps, node.dt)).collect();
            clock.put("steps of solvers", &shares);
        }
    }

    /// Takes up how steps are shared.
    pub(super) fn restore_shares(&mut self, clock: &Section, step: f64) -> Result<(), SnapshotError> {
        const ENTRY: &str = "steps of solvers";
        let is_saved = clock.entries().any(|(name, _)| name == ENTRY);
        let count = self.nodes.len();
        let shares = if is_saved { clock.array_of(ENTRY, count)? } else { vec![(1, step); count] };
        if let Some((count, dt)) =
            shares.iter().find(|(count, dt)| *count == 0 || !(dt.is_finite() && *dt >= 0.0))
        {
            let found = format!("{count} steps of {dt} s");
            return Err(SnapshotError::Damaged { place: format!("clock/{ENTRY}"), found });
        }
        for (node, share) in self.nodes.iter_mut().zip(shares) {
            (node.substeps, node.dt) = share;
        }
        self.begin_laws();
        Ok(())
    }

    /// Limits of a solver on its step that must not be exceeded, and those of the laws whose slow end it is.
    fn hard_limits_of(&self, k: usize) -> Limits {
        let mut limits = Limits::default();
        self.nodes[k].solver.hard_limits(&mut limits);
        let mut limits = self.with_laws(k, limits);
        limits.steps.retain(|limit| limit.rule != StepRule::Recommended);
        limits
    }

    /// All limits, bounds and advice of a solver and of the laws whose slow end it is.
    fn limits_of(&self, k: usize) -> Limits {
        let mut limits = Limits::default();
        self.nodes[k].solver.limits(&mut limits);
        self.with_laws(k, limits)
    }

    /// Names the solver of its limits, and adds those of laws with theirs.
    fn with_laws(&self, k: usize, mut limits: Limits) -> Limits {
        let name = |limits: &mut Limits, from: usize, name: &str| {
            limits.steps[from..].iter_mut().for_each(|limit| name.clone_into(&mut limit.solver));
        };
        name(&mut limits, 0, &self.nodes[k].name);
        for edge in self.edges.iter().filter(|edge| edge.ends()[0] == k) {
            let from = limits.steps.len();
            edge.limits(&self.nodes, &mut limits);
            name(&mut limits, from, edge.law());
        }
        limits
    }

    /// Limits on the step of the simulation, which are those of the slow solvers in the group with the longest steps: all
    /// others take several within it. Bounds and advice are those of all.
    pub(super) fn limits(&self, report: &mut Limits) {
        let all: Vec<Limits> = (0..self.nodes.len()).map(|k| self.limits_of(k)).collect();
        let mut longest: Option<(f64, &Group)> = None;
        for group in &self.groups {
            let steps = group.slow.iter().filter_map(|&k| self.nodes[k].longest(&all[k]));
            let Some(step) = steps.min_by(f64::total_cmp) else { continue };
            if longest.is_none_or(|(most, _)| step > most) {
                longest = Some((step, group));
            }
        }
        if let Some((step, group)) = longest {
            report.steps.extend(group.slow.iter().flat_map(|&k| all[k].steps.iter().cloned()));
            report.steps.extend(self.whole_steps(step, group, &all));
        }
        for own in all {
            report.bounds.extend(own.bounds);
            report.advice.extend(own.advice);
        }
    }

    /// A step \[s\] that may be chosen is best a whole number of those that may not.
    fn whole_steps(&self, step: f64, group: &Group, all: &[Limits]) -> Option<StepLimit> {
        if group.slow.iter().any(|&k| exactly(&all[k]).is_some()) {
            return None;
        }
        let exact = |k: usize| exactly(&all[k]).map(|exact| (&self.nodes[k], exact));
        let within = (0..self.nodes.len()).filter_map(exact).filter(|(_, exact)| exact.dt <= step);
        let (node, exact) = within.max_by(|a, b| a.1.dt.total_cmp(&b.1.dt))?;
        let dt = (step / exact.dt * (1.0 + FIT)).floor() * exact.dt;
        let why = format!("a whole number of steps of {}", node.exact_steps(exact));
        let limit = StepLimit { solver: node.name.clone(), ..StepLimit::recommended("whole steps", dt, why) };
        (dt < step * (1.0 - FIT)).then_some(limit)
    }
}
