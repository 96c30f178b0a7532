//! The contract that every solver keeps.

use crate::field::{FieldSink, Location, Shown, ShownAs};
use crate::snapshot::{Section, SnapshotError};
use std::any::Any;
use std::fmt;

/// A method that advances its own state in time.
///
/// Object-safe, with virtual calls per step and never per particle. State lives in the solver;
/// scratch is private, rebuilt when needed, and never saved.
pub trait Solver: Any + Send {
    /// What the solver is, in a word or two.
    fn name(&self) -> &'static str;
    /// Number and name of what a step works on, such as 3000 "grain".
    fn size(&self) -> (usize, &'static str);
    /// Limits on the step and bounds on numbers; feeds the check and the run loop.
    fn limits(&self, report: &mut Limits);
    /// The limits on the step that must not be exceeded ([`StepRule::Exactly`] and [`StepRule::AtMost`]), as they stand now;
    /// others do not count. A simulation asks for them every 100 of its steps, so they should cost little beside so many. By
    /// default they are those of [`Solver::limits`].
    fn hard_limits(&self, report: &mut Limits) {
        self.limits(report);
    }
    /// Whether a simulation of this solver alone should ask for [`Solver::hard_limits`], at the start of a segment and while
    /// steps are taken. Not where [`Solver::advance`] itself refuses a step that is too long. Among several solvers all are
    /// asked.
    fn hard_limits_may_change(&self) -> bool {
        true
    }
    /// Advances by `steps` steps of exactly `dt` \[s\]. Steps may be fused: the bits are those
    /// of one at a time.
    ///
    /// # Errors
    /// When the state stops making sense; it is then for inspection only.
    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError>;
    /// Advances by one step.
    ///
    /// # Errors
    /// As [`Solver::advance`].
    fn step(&mut self, dt: f64) -> Result<(), StepError> {
        self.advance(dt, 1)
    }
    /// Brings what the solver lends, shows and saves up to date on the host; nothing to do on a CPU. A simulation calls it
    /// before laws see the solver, before observers look that are due, and at the end of each of its own calls, after which
    /// it may be saved: not after each step. A solver that nothing has changed since has nothing to do.
    fn publish(&mut self) {}
    /// Zeroes what couplings add to; only the simulation calls this.
    fn clear_inputs(&mut self) {}
    /// Where the fields live: one place or more, each with a name of its own. A material point method has its particles and
    /// the nodes of its grid. The first place is that of what [`Solver::size`] counts.
    fn places(&self) -> Vec<(&'static str, Location<'_>)>;
    /// The first place.
    ///
    /// # Panics
    /// When the solver has none.
    fn location(&self) -> Location<'_> {
        self.place("").expect("a solver has at least one place")
    }
    /// The place of this name, or the first one for an empty name.
    fn place(&self, name: &str) -> Option<Location<'_>> {
        let mut places = self.places().into_iter();
        places.find(|(other, _)| name.is_empty() || *other == name).map(|(_, location)| location)
    }
    /// All fields and links that live at the place of this name, and all numbers: what belongs in a file of that place.
    fn shown_at(&self, place: &str) -> Vec<Shown> {
        let is_first = self.places().first().is_some_and(|(first, _)| *first == place) || place.is_empty();
        let lives_there = |shown: &Shown| match shown.kind {
            ShownAs::Number => true,
            ShownAs::Field | ShownAs::Link => shown.place == place || (is_first && shown.place.is_empty()),
        };
        self.shown().into_iter().filter(lives_there).collect()
    }
    /// Everything that [`Solver::show`] can show.
    fn shown(&self) -> Vec<Shown>;
    /// Shows fields and numbers; computes only what the sink wants.
    fn show(&self, sink: &mut dyn FieldSink);
    /// Adds the state to a section.
    fn save(&self, to: &mut Section);
    /// Takes the state from a section.
    ///
    /// # Errors
    /// When an entry is missing or does not fit.
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError>;
    /// Memory in use \[bytes\].
    fn memory(&self) -> Memory;
}

/// What a solver holds in memory, and what it left out because the scene does not need it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Bytes of state and scratch together.
    pub bytes: usize,
    /// Bytes per grain, particle, cell or node of arrays that grow with their number.
    pub bytes_per_item: usize,
    /// Features that cost nothing here, and why.
    pub left_out: Vec<String>,
}

/// How a limit on the step is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepRule {
    /// The step follows from other choices and cannot be chosen.
    Exactly,
    /// Beyond it the scheme is unstable: a larger step is refused.
    AtMost,
    /// What the accuracy asks for: taken unless the scene chooses a step.
    Recommended,
}

/// One limit on the step.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepLimit {
    /// Whose limit it is: the name of the solver in its simulation, or of the law. Empty before a simulation fills it in.
    pub solver: String,
    /// Name, unique in the report.
    pub name: &'static str,
    /// The step \[s\].
    pub dt: f64,
    /// How it is meant.
    pub rule: StepRule,
    /// Where it comes from, with the numbers that made it.
    pub why: String,
}

impl StepLimit {
    /// A step \[s\] that cannot be chosen.
    pub fn exactly(name: &'static str, dt: f64, why: impl Into<String>) -> Self {
        Self::new(StepRule::Exactly, name, dt, why.into())
    }

    /// A step \[s\] beyond which the scheme is unstable.
    pub fn at_most(name: &'static str, dt: f64, why: impl Into<String>) -> Self {
        Self::new(StepRule::AtMost, name, dt, why.into())
    }

    /// A step \[s\] that is taken unless another is chosen.
    pub fn recommended(name: &'static str, dt: f64, why: impl Into<String>) -> Self {
        Self::new(StepRule::Recommended, name, dt, why.into())
    }

    fn new(rule: StepRule, name: &'static str, dt: f64, why: String) -> Self {
        Self { solver: String::new(), name, dt, rule, why }
    }
}

/// A number other than the step that must stay below a bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// Name, unique in the report.
    pub name: &'static str,
    /// The value in this scene.
    pub value: f64,
    /// The largest value allowed.
    pub allowed: f64,
    /// Unit of both.
    pub unit: &'static str,
    /// Whether a value above the bound refuses the run or only warns.
    pub refuses: bool,
    /// What the number means and what to change.
    pub why: String,
}

impl Bound {
    /// Whether the value keeps the bound.
    pub fn holds(&self) -> bool {
        self.value <= self.allowed
    }
}

/// Collects limits and bounds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// Limits on the step.
    pub steps: Vec<StepLimit>,
    /// Bounds on other numbers.
    pub bounds: Vec<Bound>,
    /// What else is worth knowing before the first step, a sentence each.
    pub advice: Vec<String>,
}

impl Limits {
    /// The smallest step among those that must not be exceeded.
    pub fn largest_allowed(&self) -> Option<&StepLimit> {
        self.smallest(|rule| rule != StepRule::Recommended)
    }

    /// The step to take when the scene does not choose one.
    pub fn recommended(&self) -> Option<&StepLimit> {
        self.smallest(|_| true)
    }

    fn smallest(&self, wanted: impl Fn(StepRule) -> bool) -> Option<&StepLimit> {
        self.steps.iter().filter(|limit| wanted(limit.rule)).min_by(|a, b| a.dt.total_cmp(&b.dt))
    }
}

/// Why a solver could not go on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// A quantity is no longer a finite number.
    NotFinite {
        /// Solver.
        solver: &'static str,
        /// Quantity.
        quantity: &'static str,
        /// Stable identifier of the grain, particle or cell.
        id: u64,
        /// Steps taken before.
        step: u64,
    },
    /// Something moves or presses harder than the scheme can resolve.
    TooStiff {
        /// What was met.
        what: String,
        /// The value met.
        value: f64,
        /// The value allowed.
        allowed: f64,
        /// What to change.
        hint: String,
    },
    /// Something left the domain.
    LeftDomain {
        /// Stable identifier.
        id: u64,
        /// Where \[m\].
        position: [f64; 3],
    },
    /// The step asked for cannot be taken.
    Step {
        /// The step \[s\].
        dt: f64,
        /// Why not.
        why: String,
    },
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { solver, quantity, id, step } => {
                write!(f, "{solver}: the {quantity} of number {id} is not finite after step {step}")
            }
            Self::TooStiff { what, value, allowed, hint } => {
                write!(f, "{what}: {value:.4} where at most {allowed:.4} makes sense; {hint}")
            }
            Self::LeftDomain { id, position: [x, y, z] } => {
                write!(f, "number {id} left the domain at ({x:.6}, {y:.6}, {z:.6}) m")
            }
            Self::Step { dt, why } => write!(f, "a step of {dt:e} s cannot be taken: {why}"),
        }
    }
}

impl std::error::Error for StepError {}

/// Refuses a step that no solver can take.
///
/// # Errors
/// When `dt` is not a positive finite number.
pub fn check_step(dt: f64) -> Result<(), StepError> {
    if dt.is_finite() && dt > 0.0 {
        return Ok(());
    }
    Err(StepError::Step { dt, why: "it must be positive and finite".to_owned() })
}
