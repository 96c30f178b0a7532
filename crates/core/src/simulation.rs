//! Solvers with a clock, and the loop that runs them between outputs.

mod clock;
mod decision;
mod edge;
mod graph;
mod node;
mod order;
mod run;
mod sharing;
#[cfg(test)]
mod tests;

pub use clock::Clock;
pub use edge::CouplingView;
pub use node::NodeKey;
pub use run::{Ending, RunError};

use crate::blocks::inside_pool;
use crate::exchange::{Coupling, CouplingError};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, Solver, StepError, check_step};
use graph::Graph;
use std::fmt;

/// Solvers with a clock, and the couplings between them.
///
/// Solvers that couplings join share a long step: those that are the slow end of a [`Coupling`] take it whole, the
/// others in equal steps, as many as their own limits ask for. Solvers that nothing joins do not shorten each other's
/// steps: the step of the simulation, after which its clock goes on and observers may look, is the longest of them, and
/// the others take several within it. The first solver is the one that observers look at.
pub struct Simulation {
    graph: Graph,
    clock: Clock,
}

impl fmt::Debug for Simulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.graph.nodes.iter().map(|node| node.solver.name()).collect();
        f.debug_struct("Simulation").field("solvers", &names).field("clock", &self.clock).finish()
    }
}

/// What takes the name of a section and a function that puts its entries.
pub type VisitSection<'a> = dyn FnMut(&str, &dyn Fn(&mut Section)) + 'a;

/// Steps of a segment after which limits are asked for again. By their count, so that the bits are the same however a run is
/// cut into calls, and after a restart.
const ASKED_EVERY: u64 = 100;

impl Simulation {
    /// A simulation of one solver at time zero.
    pub fn new(solver: Box<dyn Solver>) -> Self {
        Self::named("solver", solver)
    }

    /// The same with a name for the solver, so that others can be coupled to it; [`Simulation::find`] gives its key.
    pub fn named(name: impl Into<String>, solver: Box<dyn Solver>) -> Self {
        let clock = Clock { start: 0.0, dt: 0.0, steps_in_segment: 0, step: 0 };
        let mut simulation = Self { graph: Graph::default(), clock };
        simulation.graph.add(name.into(), solver);
        simulation
    }

    /// Adds a solver.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn add<S: Solver>(
        &mut self,
        name: impl Into<String>,
        solver: S,
    ) -> Result<NodeKey<S>, CouplingError> {
        let name = name.into();
        if self.graph.nodes.iter().any(|node| node.name == name) {
            return Err(CouplingError::new(name, "a solver of this name is there already"));
        }
        self.graph.add(name, Box::new(solver));
        Ok(NodeKey::new(self.graph.nodes.len() - 1))
    }

    /// The solver of this name; none when there is none or it is of another type.
    pub fn find<S: Solver>(&self, name: &str) -> Option<NodeKey<S>> {
        let index = self.graph.nodes.iter().position(|node| node.name == name)?;
        let any: &dyn std::any::Any = self.graph.nodes[index].solver.as_ref();
        any.is::<S>().then(|| NodeKey::new(index))
    }

    /// Couples two solvers by a law.
    ///
    /// # Errors
    /// When they do not fit, when couplings form a ring in which each solver is slow to the next, or when a solver is fast
    /// to two that take steps of their own beside each other.
    pub fn couple<Slow: Solver, Fast: Solver>(
        &mut self,
        slow: NodeKey<Slow>,
        fast: NodeKey<Fast>,
        law: impl Coupling<Slow, Fast>,
    ) -> Result<(), CouplingError> {
        self.graph.couple(slow, fast, law)
    }

    /// The clock.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// The first solver.
    pub fn solver(&self) -> &dyn Solver {
        self.graph.nodes[0].solver.as_ref()
    }

    /// The first solver, to change it between segments.
    pub fn solver_mut(&mut self) -> &mut dyn Solver {
        self.graph.nodes[0].solver.as_mut()
    }

    /// A solver by its key.
    pub fn get<S: Solver>(&self, key: NodeKey<S>) -> &S {
        self.graph.nodes[key.index].typed()
    }

    /// A solver by its key, to change it between segments.
    pub fn get_mut<S: Solver>(&mut self, key: NodeKey<S>) -> &mut S {
        self.graph.nodes[key.index].typed_mut()
    }

    /// Names of all solvers with what they are.
    pub fn solvers(&self) -> impl Iterator<Item = (&str, &dyn Solver)> {
        self.graph.nodes.iter().map(|node| (node.name.as_str(), node.solver.as_ref()))
    }

    /// All couplings, in the order in which they were made; each shows numbers and fields as solvers do.
    pub fn couplings(&self) -> impl Iterator<Item = CouplingView<'_>> {
        let nodes = &self.graph.nodes[..];
        self.graph.edges.iter().map(move |edge| CouplingView { edge: edge.as_ref(), nodes })
    }

    /// Sets the longest step \[s\] of a solver that takes several within that of the simulation; from the next segment on.
    /// It takes shorter ones where a limit that must not be exceeded asks for them.
    pub fn choose_step<S: Solver>(&mut self, key: NodeKey<S>, dt: f64) {
        self.graph.nodes[key.index].chosen = Some(dt);
    }

    /// Limits on the step of the simulation, and all bounds. Solvers that take several steps within it do not limit it.
    pub fn limits(&self, report: &mut Limits) {
        self.graph.limits(report);
    }

    /// Starts a segment with its own step \[s\]; time goes on from where it is.
    ///
    /// # Errors
    /// When `dt` is not a positive finite number, is beyond a limit that must not be exceeded, or solvers cannot share it.
    pub fn begin_segment(&mut self, dt: f64) -> Result<(), StepError> {
        check_step(dt)?;
        self.graph.share(dt, self.clock.step > 0)?;
        self.clock = Clock { start: self.clock.time(), dt, steps_in_segment: 0, step: self.clock.step };
        // Solvers may have been changed before.
        self.graph.publish();
        Ok(())
    }

    /// Takes `steps` steps of the present segment without observers. Limits are asked for again every 100 of them.
    ///
    /// # Errors
    /// When a solver fails, or the step is now beyond a limit that must not be exceeded and cannot be divided.
    pub fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        let outcome = self.take(steps);
        self.graph.publish();
        outcome
    }

    /// Takes steps that nobody outside of the simulation has a look at yet.
    fn take(&mut self, steps: u64) -> Result<(), StepError> {
        let mut left = steps;
        while left > 0 {
            let taken = self.clock.steps_in_segment;
            let mut count = left;
            if self.graph.limits_may_change() {
                if taken > 0 && taken.is_multiple_of(ASKED_EVERY) {
                    self.graph.share_again(self.clock.dt)?;
                }
                count = count.min(ASKED_EVERY - taken % ASKED_EVERY);
            }
            // Solvers alone know better whether they have work for more threads than one.
            if self.graph.edges.is_empty() {
                self.graph.advance(count)?;
            } else {
                inside_pool(|| self.graph.advance(count))?;
            }
            self.clock.steps_in_segment += count;
            self.clock.step += count;
            left -= count;
        }
        Ok(())
    }

    /// The sections of clock, solvers and couplings: all that decides how the run goes on. A copy of the whole state; see
    /// [`Simulation::each_section`] for what needs none.
    pub fn save(&self) -> Vec<Section> {
        let mut sections = Vec::new();
        self.each_section(&mut |name, fill| {
            let mut section = Section::new(name);
            fill(&mut section);
            sections.push(section);
        });
        sections
    }

    /// Calls `visit` with the name of each section of [`Simulation::save`], in order, and with a function that puts its
    /// entries into a section, which may be one that [passes them on](Section::passing_on).
    pub fn each_section(&self, visit: &mut VisitSection<'_>) {
        visit("clock", &|clock| {
            clock.put("start and dt", &[self.clock.start, self.clock.dt]);
            clock.put("steps in segment and run", &[self.clock.steps_in_segment, self.clock.step]);
            self.graph.save_shares(clock, self.clock.dt);
        });
        self.graph.each_section(visit);
    }

    /// Restores clock, solvers and couplings.
    ///
    /// # Errors
    /// When a section is missing or does not fit.
    pub fn restore(&mut self, sections: &[Section]) -> Result<(), SnapshotError> {
        let clock = find_section(sections, "clock")?;
        let times: Vec<f64> = clock.array_of("start and dt", 2)?;
        let steps: Vec<u64> = clock.array_of("steps in segment and run", 2)?;
        self.graph.restore(sections)?;
        self.graph.restore_shares(clock, times[1])?;
        self.graph.publish();
        self.clock = Clock { start: times[0], dt: times[1], steps_in_segment: steps[0], step: steps[1] };
        Ok(())
    }
}

/// The section of this name.
///
/// # Errors
/// When there is none.
pub fn find_section<'a>(sections: &'a [Section], name: &str) -> Result<&'a Section, SnapshotError> {
    let found = sections.iter().find(|section| section.name() == name);
    found.ok_or_else(|| SnapshotError::Missing { place: name.to_owned() })
}
