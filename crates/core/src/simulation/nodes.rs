//! The solvers of a simulation, the couplings between them, and how they share a long step.

use crate::exchange::{Coupling, CouplingError};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, Solver, StepError, StepRule};
use std::any::Any;
use std::marker::PhantomData;

/// Most steps of one solver within a step of another.
const MOST_SUBSTEPS: f64 = 100_000.0;
/// How well two steps that follow from the scene must fit one another.
const FIT: f64 = 1e-9;

/// A solver in a simulation, with its type.
pub struct NodeKey<S> {
    pub(super) index: usize,
    solver: PhantomData<fn() -> S>,
}

impl<S> NodeKey<S> {
    pub(super) fn new(index: usize) -> Self {
        Self { index, solver: PhantomData }
    }
}

impl<S> Clone for NodeKey<S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for NodeKey<S> {}

impl<S> std::fmt::Debug for NodeKey<S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "NodeKey({})", self.index)
    }
}

/// Which end of couplings a solver is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Free,
    Slow,
    Fast,
}

/// A solver with its share of the long step.
pub(super) struct Node {
    pub(super) name: String,
    pub(super) solver: Box<dyn Solver>,
    end: End,
    /// Longest step chosen for it \[s\].
    pub(super) chosen: Option<f64>,
    /// Steps within a long one, and how long each is \[s\].
    substeps: u64,
    dt: f64,
}

impl Node {
    pub(super) fn new(name: String, solver: Box<dyn Solver>) -> Self {
        Self { name, solver, end: End::Free, chosen: None, substeps: 1, dt: 0.0 }
    }

    /// Divides a long step \[s\].
    fn share(&mut self, long: f64) -> Result<(), StepError> {
        let mut limits = Limits::default();
        self.solver.limits(&mut limits);
        let limit = limits.recommended();
        let longest = self.chosen.or(limit.map(|limit| limit.dt)).unwrap_or(long);
        let exact = limit.filter(|limit| limit.rule == StepRule::Exactly);
        let ratio = long / longest;
        let refuse = |why: String| Err(StepError::Step { dt: long, why });
        if ratio > MOST_SUBSTEPS {
            let why = limit.map_or("its own choice", |limit| limit.name);
            return refuse(format!(
                "`{}` would take {ratio:.3e} steps of {longest:.3e} s ({why}) within it, more than {MOST_SUBSTEPS}",
                self.name
            ));
        }
        if let Some(exact) = exact {
            let whole = (long / exact.dt).round();
            if whole < 1.0 || (long / exact.dt - whole).abs() > FIT * whole {
                return refuse(format!(
                    "it is no whole number of steps of `{}`, which are {:e} s ({}: {})",
                    self.name, exact.dt, exact.name, exact.why
                ));
            }
            if self.end == End::Slow && whole > 1.0 {
                return refuse(format!(
                    "`{}` takes steps of {:e} s and is the slow end",
                    self.name, exact.dt
                ));
            }
            (self.substeps, self.dt) = (whole as u64, exact.dt);
            return Ok(());
        }
        let count = if self.end == End::Slow { 1.0 } else { (ratio * (1.0 - FIT)).ceil().max(1.0) };
        (self.substeps, self.dt) = (count as u64, long / count);
        Ok(())
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.solver.advance(self.dt, self.substeps)
    }
}

/// A coupling whose two solvers are known by their places.
trait Edge: Send {
    fn law(&self) -> &'static str;
    fn begin(&mut self, long_step: f64);
    fn forward(&mut self, nodes: &mut [Node]) -> Result<(), StepError>;
    fn backward(&mut self, nodes: &mut [Node]) -> Result<(), StepError>;
    fn limits(&self, nodes: &[Node], report: &mut Limits);
    fn save(&self, to: &mut Section);
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError>;
}

struct Typed<Slow, Fast, Law> {
    slow: NodeKey<Slow>,
    fast: NodeKey<Fast>,
    law: Law,
}

/// The solver behind a node; its type was known when the key was made.
pub(super) fn typed<S: Solver>(node: &Node) -> &S {
    let any: &dyn Any = node.solver.as_ref();
    any.downcast_ref().expect("a key is made with the type of its solver")
}

pub(super) fn typed_mut<S: Solver>(node: &mut Node) -> &mut S {
    let any: &mut dyn Any = node.solver.as_mut();
    any.downcast_mut().expect("a key is made with the type of its solver")
}

impl<Slow: Solver, Fast: Solver, Law> Typed<Slow, Fast, Law> {
    fn ends<'a>(&self, nodes: &'a mut [Node]) -> (&'a mut Slow, &'a mut Fast) {
        let [slow, fast] = nodes
            .get_disjoint_mut([self.slow.index, self.fast.index])
            .expect("the ends of a coupling are two nodes of this simulation");
        (typed_mut(slow), typed_mut(fast))
    }
}

impl<Slow: Solver, Fast: Solver, Law: Coupling<Slow, Fast>> Edge for Typed<Slow, Fast, Law> {
    fn law(&self) -> &'static str {
        self.law.name()
    }

    fn begin(&mut self, long_step: f64) {
        self.law.begin(long_step);
    }

    fn forward(&mut self, nodes: &mut [Node]) -> Result<(), StepError> {
        let (slow, fast) = self.ends(nodes);
        self.law.forward(fast, slow)
    }

    fn backward(&mut self, nodes: &mut [Node]) -> Result<(), StepError> {
        let (slow, fast) = self.ends(nodes);
        self.law.backward(slow, fast)
    }

    fn limits(&self, nodes: &[Node], report: &mut Limits) {
        self.law.limits(typed(&nodes[self.slow.index]), typed(&nodes[self.fast.index]), report);
    }

    fn save(&self, to: &mut Section) {
        self.law.save(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.law.restore(from)
    }
}

/// Solvers and couplings.
#[derive(Default)]
pub(super) struct Graph {
    pub(super) nodes: Vec<Node>,
    edges: Vec<Box<dyn Edge>>,
}

impl Graph {
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
        Ok(())
    }

    /// Divides a long step \[s\] among the solvers. One alone takes it whole.
    pub(super) fn share(&mut self, long: f64) -> Result<(), StepError> {
        self.edges.iter_mut().for_each(|edge| edge.begin(long));
        match &mut self.nodes[..] {
            [alone] => {
                (alone.substeps, alone.dt) = (1, long);
                Ok(())
            }
            nodes => nodes.iter_mut().try_for_each(|node| node.share(long)),
        }
    }

    /// Takes `steps` long steps.
    pub(super) fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        if let [alone] = &mut self.nodes[..] {
            return alone.solver.advance(alone.dt, steps);
        }
        (0..steps).try_for_each(|_| self.long_step())
    }

    fn long_step(&mut self) -> Result<(), StepError> {
        let Self { nodes, edges } = self;
        for node in nodes.iter_mut() {
            node.solver.publish();
            if node.end == End::Slow {
                node.solver.clear_inputs();
            }
        }
        edges.iter_mut().try_for_each(|edge| edge.forward(nodes))?;
        for node in nodes.iter_mut().filter(|node| node.end == End::Slow) {
            node.step()?;
            node.solver.publish();
        }
        for node in nodes.iter_mut().filter(|node| node.end == End::Fast) {
            node.solver.clear_inputs();
        }
        edges.iter_mut().try_for_each(|edge| edge.backward(nodes))?;
        nodes.iter_mut().filter(|node| node.end != End::Slow).try_for_each(Node::step)
    }

    /// Limits on the long step: of slow and uncoupled solvers and of couplings; and the bounds of all.
    pub(super) fn limits(&self, report: &mut Limits) {
        for node in &self.nodes {
            let mut own = Limits::default();
            node.solver.limits(&mut own);
            if node.end != End::Fast {
                report.steps.append(&mut own.steps);
            }
            report.bounds.append(&mut own.bounds);
            report.advice.append(&mut own.advice);
        }
        self.edges.iter().for_each(|edge| edge.limits(&self.nodes, report));
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

fn section_of_edge(number: usize, law: &str) -> String {
    format!("coupling {number} {law}")
}
