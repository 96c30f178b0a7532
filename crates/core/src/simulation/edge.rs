//! A coupling in a simulation.

use super::node::{Node, NodeKey};
use crate::exchange::Coupling;
use crate::field::{FieldSink, Shown};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, Solver, StepError};
use std::fmt;

/// A coupling whose two solvers are known by their numbers.
pub(super) trait Edge: Send {
    fn law(&self) -> &'static str;
    /// Numbers of the slow and of the fast solver.
    fn ends(&self) -> [usize; 2];
    fn begin(&mut self, long_step: f64);
    fn forward(&mut self, nodes: &mut [Node]) -> Result<(), StepError>;
    fn backward(&mut self, nodes: &mut [Node]) -> Result<(), StepError>;
    fn acts_within(&self) -> bool;
    fn during(&mut self, k: u64, n: u64, nodes: &mut [Node]) -> Result<(), StepError>;
    fn limits(&self, nodes: &[Node], report: &mut Limits);
    fn shown(&self) -> Vec<Shown>;
    fn show(&self, nodes: &[Node], sink: &mut dyn FieldSink);
    fn save(&self, to: &mut Section);
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError>;
}

/// A coupling as a simulation holds it: its name, its ends, and what it shows.
#[derive(Clone, Copy)]
pub struct CouplingView<'a> {
    pub(super) edge: &'a dyn Edge,
    pub(super) nodes: &'a [Node],
}

impl fmt::Debug for CouplingView<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (law, slow, fast) = (self.name(), self.slow(), self.fast());
        f.debug_struct("CouplingView").field("law", &law).field("slow", &slow).field("fast", &fast).finish()
    }
}

impl<'a> CouplingView<'a> {
    /// What the law is called.
    pub fn name(&self) -> &'static str {
        self.edge.law()
    }

    /// Name of the slow solver.
    pub fn slow(&self) -> &'a str {
        &self.nodes[self.edge.ends()[0]].name
    }

    /// Name of the fast solver, at whose places the fields live.
    pub fn fast(&self) -> &'a str {
        &self.nodes[self.edge.ends()[1]].name
    }

    /// Everything that [`CouplingView::show`] can show.
    pub fn shown(&self) -> Vec<Shown> {
        self.edge.shown()
    }

    /// Shows fields and numbers; computes only what the sink wants.
    pub fn show(&self, sink: &mut dyn FieldSink) {
        self.edge.show(self.nodes, sink);
    }
}

pub(super) struct Typed<Slow, Fast, Law> {
    pub(super) slow: NodeKey<Slow>,
    pub(super) fast: NodeKey<Fast>,
    pub(super) law: Law,
}

impl<Slow: Solver, Fast: Solver, Law> Typed<Slow, Fast, Law> {
    pub(super) fn solvers<'a>(&self, nodes: &'a mut [Node]) -> (&'a mut Slow, &'a mut Fast) {
        let [slow, fast] = nodes
            .get_disjoint_mut([self.slow.index, self.fast.index])
            .expect("the ends of a coupling are two nodes of this simulation");
        (slow.typed_mut(), fast.typed_mut())
    }
}

impl<Slow: Solver, Fast: Solver, Law: Coupling<Slow, Fast>> Edge for Typed<Slow, Fast, Law> {
    fn law(&self) -> &'static str {
        self.law.name()
    }

    fn ends(&self) -> [usize; 2] {
        [self.slow.index, self.fast.index]
    }

    fn begin(&mut self, long_step: f64) {
        self.law.begin(long_step);
    }

    fn forward(&mut self, nodes: &mut [Node]) -> Result<(), StepError> {
        let (slow, fast) = self.solvers(nodes);
        self.law.forward(fast, slow)
    }

    fn backward(&mut self, nodes: &mut [Node]) -> Result<(), StepError> {
        let (slow, fast) = self.solvers(nodes);
        self.law.backward(slow, fast)
    }

    fn acts_within(&self) -> bool {
        self.law.acts_within()
    }

    fn during(&mut self, k: u64, n: u64, nodes: &mut [Node]) -> Result<(), StepError> {
        let (slow, fast) = self.solvers(nodes);
        self.law.during(k, n, slow, fast)
    }

    fn limits(&self, nodes: &[Node], report: &mut Limits) {
        self.law.limits(nodes[self.slow.index].typed(), nodes[self.fast.index].typed(), report);
    }

    fn shown(&self) -> Vec<Shown> {
        self.law.shown()
    }

    fn show(&self, nodes: &[Node], sink: &mut dyn FieldSink) {
        self.law.show(nodes[self.slow.index].typed(), nodes[self.fast.index].typed(), sink);
    }

    fn save(&self, to: &mut Section) {
        self.law.save(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.law.restore(from)
    }
}
