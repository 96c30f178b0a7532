//! The solvers of a simulation and the couplings between them.

use super::edge::{Edge, Typed};
use super::node::{End, Node, NodeKey};
use super::sharing::Group;
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
        if slow.index == fast.index {
            return Err(CouplingError::new(edge.law.name(), "both ends are one solver"));
        }
        let ends = [(slow.index, End::Slow), (fast.index, End::Fast)];
        let clash = ends.iter().find(|(index, end)| ![End::Free, *end].contains(&self.nodes[*index].end));
        if let Some((index, _)) = clash {
            let place = self.nodes[*index].name.clone();
            return Err(CouplingError::new(place, "a solver cannot be slow to one and fast to another"));
        }
        let (a, b) = edge.ends(&mut self.nodes);
        edge.law.attach(a, b)?;
        for (index, end) in ends {
            self.nodes[index].end = end;
        }
        self.edges.push(Box::new(edge));
        self.regroup();
        Ok(())
    }

    /// Takes `steps` steps of the simulation, one group after the other: they do not see each other.
    pub(super) fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        let Self { nodes, edges, groups } = self;
        groups.iter().try_for_each(|group| {
            if let Some(alone) = group.alone() {
                let Node { solver, dt, .. } = &mut nodes[alone];
                return solver.advance(*dt, steps * group.steps);
            }
            (0..steps * group.steps).try_for_each(|_| long_step(group, nodes, edges))
        })
    }

    pub(super) fn save(&self) -> Vec<Section> {
        let nodes = self.nodes.iter().map(|node| {
            let mut section = Section::new(self.section_of(node));
            node.solver.save(&mut section);
            section
        });
        let edges = self.edges.iter().enumerate().map(|(k, edge)| {
            let mut section = Section::new(section_of_edge(k, edge.law()));
            edge.save(&mut section);
            section
        });
        nodes.chain(edges).collect()
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

/// One long step of coupled solvers.
fn long_step(group: &Group, nodes: &mut [Node], edges: &mut [Box<dyn Edge>]) -> Result<(), StepError> {
    let Group { slow, fast, edges: laws, .. } = group;
    for &k in slow.iter().chain(fast) {
        nodes[k].solver.publish();
    }
    slow.iter().for_each(|&k| nodes[k].solver.clear_inputs());
    laws.iter().try_for_each(|&law| edges[law].forward(nodes))?;
    for &k in slow {
        nodes[k].step()?;
        nodes[k].solver.publish();
    }
    fast.iter().for_each(|&k| nodes[k].solver.clear_inputs());
    laws.iter().try_for_each(|&law| edges[law].backward(nodes))?;
    fast.iter().try_for_each(|&k| nodes[k].step())
}

fn section_of_edge(number: usize, law: &str) -> String {
    format!("coupling {number} {law}")
}
