//! How solvers share a step: groups of coupled solvers, and the steps of each.

use super::graph::Graph;
use super::node::{End, FIT, exactly};
use crate::solver::{Limits, StepError, StepLimit, StepRule};

/// Solvers that couplings join, directly or through others; a free solver is a group of its own. Groups do not see each
/// other, so each has its own long step.
pub(super) struct Group {
    /// Those that take the long step whole: slow ends, or the free solver.
    pub(super) slow: Vec<usize>,
    /// Those that take several steps within it.
    pub(super) fast: Vec<usize>,
    /// The laws between them.
    pub(super) edges: Vec<usize>,
    /// Long steps within one of the simulation.
    pub(super) steps: u64,
}

impl Group {
    /// The free solver, if it is one.
    pub(super) fn alone(&self) -> Option<usize> {
        self.edges.is_empty().then(|| self.slow[0])
    }
}

impl Graph {
    /// Finds the groups, in the order of their first solvers.
    pub(super) fn regroup(&mut self) {
        let mut first: Vec<usize> = (0..self.nodes.len()).collect();
        for edge in &self.edges {
            let [a, b] = edge.places().map(|place| first[place]);
            first.iter_mut().filter(|group| **group == a.max(b)).for_each(|group| *group = a.min(b));
        }
        let members = |group: usize, is_fast: bool| {
            let those = |&k: &usize| first[k] == group && (self.nodes[k].end == End::Fast) == is_fast;
            (0..self.nodes.len()).filter(those).collect()
        };
        let of = |group: usize| Group {
            slow: members(group, false),
            fast: members(group, true),
            edges: (0..self.edges.len()).filter(|&law| first[self.edges[law].places()[0]] == group).collect(),
            steps: 1,
        };
        self.groups = (0..self.nodes.len()).filter(|&k| first[k] == k).map(of).collect();
    }

    /// Divides a step \[s\] of the simulation among its solvers. One alone takes it whole, and so do the slow solvers of a
    /// single group; of several groups each has its own long step, a whole part of that step.
    pub(super) fn share(&mut self, step: f64) -> Result<(), StepError> {
        if self.nodes.len() == 1 {
            self.nodes[0].dt = step;
            return Ok(());
        }
        (0..self.groups.len()).try_for_each(|group| self.share_in_group(group, step))
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
        for k in self.groups[group].fast.clone() {
            (self.nodes[k].substeps, self.nodes[k].dt) = self.nodes[k].divide(long, &self.limits_of(k))?;
        }
        for &law in &self.groups[group].edges {
            self.edges[law].begin(long);
        }
        self.groups[group].steps = long_steps;
        Ok(())
    }

    /// Limits of a solver and of the laws whose slow end it is.
    fn limits_of(&self, k: usize) -> Limits {
        let mut limits = Limits::default();
        self.nodes[k].solver.limits(&mut limits);
        for edge in self.edges.iter().filter(|edge| edge.places()[0] == k) {
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
