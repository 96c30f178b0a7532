//! How solvers share a step: how many each takes within a longer one.

use super::graph::Graph;
use super::node::{FIT, exactly};
use super::order::Group;
use crate::solver::{Limits, StepError, StepLimit, StepRule};

impl Graph {
    /// Divides a step \[s\] of the simulation among its solvers. One alone takes it whole, and so do the slow solvers of a
    /// single group; of several groups each has its own long step, a whole part of that step.
    pub(super) fn share(&mut self, step: f64) -> Result<(), StepError> {
        if self.nodes.len() == 1 {
            self.nodes[0].dt = step;
            return Ok(());
        }
        (0..self.groups.len()).try_for_each(|group| self.share_in_group(group, step))?;
        let Self { nodes, edges, .. } = self;
        edges.iter_mut().for_each(|edge| edge.begin(nodes[edge.ends()[0]].dt));
        Ok(())
    }

    fn share_in_group(&mut self, group: usize, step: f64) -> Result<(), StepError> {
        let mut long_steps = 1;
        if self.groups.len() > 1 {
            for &k in &self.groups[group].slow {
                long_steps = long_steps.max(self.nodes[k].divide(step, &self.limits_of(k))?.0);
            }
        }
        let long = step / long_steps as f64;
        for k in self.groups[group].slow.clone() {
            (self.nodes[k].substeps, self.nodes[k].dt) = (1, self.nodes[k].whole(long, &self.limits_of(k))?);
        }
        self.groups[group].steps = long_steps;
        let partners = self.groups[group].partners.clone();
        partners.into_iter().try_for_each(|fast| self.share_with(fast, long))
    }

    /// Divides a longer step \[s\] for a fast solver, and its own steps for those that are fast to it.
    fn share_with(&mut self, fast: usize, long: f64) -> Result<(), StepError> {
        let (substeps, dt) = self.nodes[fast].divide(long, &self.limits_of(fast))?;
        (self.nodes[fast].substeps, self.nodes[fast].dt) = (substeps, dt);
        let partners = self.nodes[fast].partners.clone();
        partners.into_iter().try_for_each(|partner| self.share_with(partner, dt))
    }

    /// Limits of a solver and of the laws whose slow end it is.
    fn limits_of(&self, k: usize) -> Limits {
        let mut limits = Limits::default();
        self.nodes[k].solver.limits(&mut limits);
        for edge in self.edges.iter().filter(|edge| edge.ends()[0] == k) {
            edge.limits(&self.nodes, &mut limits);
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
        (dt < step * (1.0 - FIT)).then_some(StepLimit {
            name: "whole steps",
            dt,
            rule: StepRule::Recommended,
            why,
        })
    }
}
