//! The solvers of a simulation and the couplings between them.

use super::VisitSection;
use super::edge::{Edge, Typed};
use super::node::{Node, NodeKey};
use super::order::Group;
use crate::exchange::{Coupling, CouplingError};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Solver, StepError};

/// Solvers and couplings.
#[derive(Default)]
pub(super) struct Graph {
    pub(super) nodes: Vec<Node>,
    pub(super) edges: Vec<Box<dyn Edge>>,
    /// Solvers that couplings join, directly or through others.
    pub(super) groups: Vec<Group>,
}

impl Graph {
    pub(super) fn add(&mut self, name: String, solver: Box<dyn Solver>) {
        self.nodes.push(Node::new(name, solver));
        self.regroup();
    }

    pub(super) fn couple<Slow: Solver, Fast: Solver, Law: Coupling<Slow, Fast>>(
        &mut self,
        slow: NodeKey<Slow>,
        fast: NodeKey<Fast>,
        law: Law,
    ) -> Result<(), CouplingError> {
        let mut edge = Typed { slow, fast, law };
        let ends = edge.ends();
        self.check_order(edge.law.name(), ends)?;
        let (a, b) = edge.solvers(&mut self.nodes);
        edge.law.attach(a, b)?;
        self.edges.push(Box::new(edge));
        self.regroup();
        Ok(())
    }

    /// Takes `steps` steps of the simulation, one group after the other: they do not see each other.
    pub(super) fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        (0..self.groups.len()).try_for_each(|group| {
            let first = &mut self.nodes[self.groups[group].slow[0]];
            let count = steps * first.substeps;
            if self.groups[group].is_alone() { first.take(count) } else { self.long_steps(group, count) }
        })
    }

    /// Brings what solvers lend and show up to date.
    pub(super) fn publish(&mut self) {
        self.nodes.iter_mut().for_each(|node| node.solver.publish());
    }

    fn long_steps(&mut self, group: usize, count: u64) -> Result<(), StepError> {
        self.groups[group].members.iter().for_each(|&k| self.nodes[k].solver.publish());
        (0..count).try_for_each(|_| self.long_step(group))
    }

    /// One long step of coupled solvers: the slow ones, then those that follow them.
    fn long_step(&mut self, group: usize) -> Result<(), StepError> {
        for at in 0..self.groups[group].slow.len() {
            self.feed(self.groups[group].slow[at], 0)?;
        }
        for at in 0..self.groups[group].slow.len() {
            self.nodes[self.groups[group].slow[at]].take_and_publish(1)?;
        }
        for at in 0..self.groups[group].partners.len() {
            self.follow(self.groups[group].partners[at])?;
        }
        Ok(())
    }

    /// Takes the steps of a fast solver within the longer one that has just been taken, and within each of them those of
    /// the solvers that are fast to it.
    fn follow(&mut self, fast: usize) -> Result<(), StepError> {
        let count = self.nodes[fast].substeps;
        if !self.nodes[fast].one_by_one {
            self.feed(fast, 0)?;
            return self.nodes[fast].take_and_publish(count);
        }
        for step in 0..count {
            self.feed(fast, step)?;
            self.nodes[fast].take_and_publish(1)?;
            for at in 0..self.nodes[fast].partners.len() {
                self.follow(self.nodes[fast].partners[at])?;
            }
        }
        Ok(())
    }

    /// Builds the inputs of a solver anew, before its step of this number.
    fn feed(&mut self, node: usize, step: u64) -> Result<(), StepError> {
        let Self { nodes, edges, .. } = self;
        let count = nodes[node].substeps;
        nodes[node].solver.clear_inputs();
        let ending_on = |end: usize| move |edge: &&mut Box<dyn Edge>| edge.ends()[end] == node;
        edges.iter_mut().filter(ending_on(0)).try_for_each(|edge| edge.forward(nodes))?;
        edges.iter_mut().filter(ending_on(1)).try_for_each(|edge| edge.backward(nodes))?;
        let mut within = edges.iter_mut().filter(ending_on(1)).filter(|edge| edge.acts_within());
        within.try_for_each(|edge| edge.during(step, count, nodes))
    }

    /// Calls `visit` with the name of each section and what puts its entries.
    pub(super) fn each_section(&self, visit: &mut VisitSection<'_>) {
        for node in &self.nodes {
            visit(&self.section_of(node), &|section| node.solver.save(section));
        }
        for (k, edge) in self.edges.iter().enumerate() {
            visit(&section_of_edge(k, edge.law()), &|section| edge.save(section));
        }
    }

    pub(super) fn restore(&mut self, sections: &[Section]) -> Result<(), SnapshotError> {
        let names: Vec<String> = self.nodes.iter().map(|node| self.section_of(node)).collect();
        for (node, name) in self.nodes.iter_mut().zip(&names) {
            node.solver.restore(super::find_section(sections, name)?)?;
        }
        for (k, edge) in self.edges.iter_mut().enumerate() {
            edge.restore(super::find_section(sections, &section_of_edge(k, edge.law()))?)?;
        }
        Ok(())
    }

    /// `solver` for one alone, with its name among several.
    fn section_of(&self, node: &Node) -> String {
        if self.nodes.len() == 1 { "solver".to_owned() } else { format!("solver {}", node.name) }
    }
}

fn section_of_edge(number: usize, law: &str) -> String {
    format!("coupling {number} {law}")
}
