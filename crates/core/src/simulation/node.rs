//! A solver in a simulation, and how many steps it takes within a longer one.

use crate::solver::{Limits, Solver, StepError, StepLimit, StepRule};
use std::any::Any;
use std::marker::PhantomData;

/// Most steps of one solver within a step of another.
const MOST_SUBSTEPS: f64 = 100_000.0;
/// How well steps must fit one another.
pub(super) const FIT: f64 = 1e-9;

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

/// A solver with its share of a longer step.
pub(super) struct Node {
    pub(super) name: String,
    pub(super) solver: Box<dyn Solver>,
    /// Longest step chosen for it \[s\].
    pub(super) chosen: Option<f64>,
    /// Steps within the longer one, and how long each is \[s\]. For those that take the long step of their group whole, the
    /// longer one is the step of the simulation.
    pub(super) substeps: u64,
    pub(super) dt: f64,
    /// The solvers that take their steps within each of its own.
    pub(super) partners: Vec<usize>,
    /// Whether something happens within the longer step, so that it takes its steps one at a time.
    pub(super) one_by_one: bool,
}

impl Node {
    pub(super) fn new(name: String, solver: Box<dyn Solver>) -> Self {
        Self { name, solver, chosen: None, substeps: 1, dt: 0.0, partners: Vec::new(), one_by_one: false }
    }

    /// The solver behind the node; its type was known when the key was made.
    pub(super) fn typed<S: Solver>(&self) -> &S {
        let any: &dyn Any = self.solver.as_ref();
        any.downcast_ref().expect("a key is made with the type of its solver")
    }

    pub(super) fn typed_mut<S: Solver>(&mut self) -> &mut S {
        let any: &mut dyn Any = self.solver.as_mut();
        any.downcast_mut().expect("a key is made with the type of its solver")
    }

    pub(super) fn take(&mut self, steps: u64) -> Result<(), StepError> {
        self.solver.advance(self.dt, steps)
    }

    /// Takes steps whose outcome couplings look at.
    pub(super) fn take_and_publish(&mut self, steps: u64) -> Result<(), StepError> {
        self.take(steps)?;
        self.solver.publish();
        Ok(())
    }

    /// Longest step \[s\] that it takes when nothing else shortens it: the one chosen for it, or the one that its limits
    /// recommend.
    pub(super) fn longest(&self, limits: &Limits) -> Option<f64> {
        let allowed = limits.largest_allowed().map_or(f64::INFINITY, |limit| limit.dt);
        let chosen = self.chosen.map(|chosen| chosen.min(allowed));
        chosen.or_else(|| limits.recommended().map(|limit| limit.dt))
    }

    /// Number, at least so many, and length \[s\] of its equal steps within a `long` one \[s\].
    pub(super) fn divide(&self, long: f64, limits: &Limits, least: u64) -> Result<(u64, f64), StepError> {
        if let Some(exact) = exactly(limits) {
            let whole = (long / exact.dt).round();
            if whole < 1.0 || (long / exact.dt - whole).abs() > FIT * whole {
                return refuse(
                    long,
                    format!("it is not a whole number of steps of {}", self.exact_steps(exact)),
                );
            }
            return self.few_enough(long, whole, exact.dt, limits);
        }
        let longest = self.longest(limits).unwrap_or(long);
        let count = (long / longest * (1.0 - FIT)).ceil().max(least as f64);
        self.few_enough(long, count, long / count, limits)
    }

    fn few_enough(&self, long: f64, count: f64, dt: f64, limits: &Limits) -> Result<(u64, f64), StepError> {
        if count <= MOST_SUBSTEPS {
            return Ok((count as u64, dt));
        }
        let why = limits.recommended().map_or("its own choice", |limit| limit.name);
        let why = format!(
            "`{}` would take {count:.3e} steps of {dt:.3e} s ({why}) within it, more than {MOST_SUBSTEPS}",
            self.name
        );
        refuse(long, why)
    }

    /// Length \[s\] of its one step within a long one of so many seconds, which differ by round-off at most.
    pub(super) fn whole(&self, long: f64, limits: &Limits) -> Result<f64, StepError> {
        match exactly(limits) {
            Some(exact) if (long - exact.dt).abs() > FIT * exact.dt => {
                refuse(long, format!("it must be that of {}", self.exact_steps(exact)))
            }
            Some(exact) => Ok(exact.dt),
            None => self.check_allowed(long, limits).map(|()| long),
        }
    }

    /// Refuses a step \[s\] beyond a limit that must not be exceeded.
    pub(super) fn check_allowed(&self, dt: f64, limits: &Limits) -> Result<(), StepError> {
        match limits.largest_allowed() {
            Some(limit) if dt > limit.dt * (1.0 + FIT) => {
                let StepLimit { solver, name, dt: allowed, why, .. } = limit;
                refuse(
                    dt,
                    format!(
                        "`{solver}` allows at most {allowed:e} s now ({name}: {why}); take a shorter step"
                    ),
                )
            }
            _ => Ok(()),
        }
    }

    /// "`name`, which are so long (reason)".
    pub(super) fn exact_steps(&self, exact: &StepLimit) -> String {
        format!("`{}`, which are {:e} s ({}: {})", self.name, exact.dt, exact.name, exact.why)
    }
}

/// The limit that leaves no choice.
pub(super) fn exactly(limits: &Limits) -> Option<&StepLimit> {
    limits.steps.iter().find(|limit| limit.rule == StepRule::Exactly)
}

pub(super) fn refuse<T>(dt: f64, why: String) -> Result<T, StepError> {
    Err(StepError::Step { dt, why })
}
