//! What solvers lend one another, and the laws that couple them.
//!
//! A [`Quantity`] is a key: it names what is exchanged, with unit, sign and frame in its documentation.
//! A solver [`Provides`] some and [`Accepts`] others; a [`Coupling`] is written against these traits and so
//! serves every pair of solvers that has them. A pair that does not fit is not compiled:
//!
//! ```compile_fail
//! # use granular_core::exchange::Provides;
//! # use granular_core::quantity::GrainMotion;
//! # use granular_core::D2;
//! struct Fluid;
//! fn needs_grains(_: &impl Provides<GrainMotion<D2>>) {}
//! needs_grains(&Fluid); // `Fluid` does not provide `GrainMotion<D2>`
//! ```

use crate::field::{FieldSink, Shown};
use crate::snapshot::{Section, SnapshotError};
use crate::solver::{Limits, StepError};
use std::fmt;

/// Something that one solver lends another, by the way in which it is seen.
pub trait Quantity: 'static {
    /// Name, for messages.
    const NAME: &'static str;
    /// Unit, or units of its parts.
    const UNIT: &'static str;
    /// How it is read; borrows what the solver holds.
    type View<'a>: Copy;
    /// How it is written; borrows what the solver holds.
    type ViewMut<'a>;
}

/// A solver that lends a quantity.
#[diagnostic::on_unimplemented(message = "`{Self}` does not provide `{Q}`")]
pub trait Provides<Q: Quantity> {
    /// The quantity as it stands.
    fn view(&self) -> Q::View<'_>;
}

/// A solver that takes a quantity. What it takes is an input: it only reads it.
///
/// Inputs follow the solver: when it re-sorts, adds, removes or exchanges the items that an input belongs to while the input
/// is held, it moves the input along.
#[diagnostic::on_unimplemented(message = "`{Self}` does not accept `{Q}`")]
pub trait Accepts<Q: Quantity> {
    /// Makes room for the quantity, as zeros. A law that writes it calls this in [`Coupling::attach`]; a solver that nobody
    /// writes to holds nothing and does no work for it. More than one law may call it.
    fn enable(&mut self) {}
    /// Where to put the quantity, once [`Accepts::enable`] has been called.
    fn view_mut(&mut self) -> Q::ViewMut<'_>;
}

/// A law between a slow solver, which takes long steps, and a fast one, which takes several within each of them.
///
/// In each long step the laws go forward, the slow solver steps, the laws go backward, and the fast solver steps. A solver
/// may be slow to one and fast to another: each of its steps is then a long step for the solvers that are fast to it.
///
/// Inputs are built anew for each call of [`Solver::advance`](crate::Solver::advance): they are cleared, and then every law
/// that ends on the solver adds to them, so that several laws may feed one solver. For a fast solver that takes its steps one
/// at a time, since something happens within them, `backward` is therefore called before each of them, with the slow solver
/// unchanged: it adds the same again. What counts once per long step is booked in `forward`.
///
/// A law owns its scratch and its saved state.
pub trait Coupling<Slow, Fast>: Send + 'static {
    /// What the law is called.
    fn name(&self) -> &'static str;
    /// Called once: switches on what the law writes ([`Accepts::enable`]), checks sizes.
    ///
    /// # Errors
    /// When the solvers do not fit one another.
    fn attach(&mut self, slow: &mut Slow, fast: &mut Fast) -> Result<(), CouplingError>;
    /// Called with the length of the long step \[s\] before the first one, and again whenever it may have changed.
    fn begin(&mut self, long_step: f64) {
        let _ = long_step;
    }
    /// Before the slow step.
    ///
    /// # Errors
    /// When the state of the fast solver makes no sense to the slow one.
    fn forward(&mut self, fast: &Fast, slow: &mut Slow) -> Result<(), StepError>;
    /// After the slow step, before steps of the fast solver. Loads are means over the slow step.
    ///
    /// # Errors
    /// When the state of the slow solver makes no sense to the fast one.
    fn backward(&mut self, slow: &Slow, fast: &mut Fast) -> Result<(), StepError> {
        let _ = (slow, fast);
        Ok(())
    }
    /// Whether the law acts within the long step: the fast solver then takes its steps one at a time, and
    /// [`Coupling::during`] is called before each.
    fn acts_within(&self) -> bool {
        false
    }
    /// Before step `k` of the `n` steps that the fast solver takes within one of the slow solver, from 0 to n - 1, after
    /// `backward`: for loads that follow the fast solver, and for means over its steps, which a law sums up here. What it
    /// adds to inputs holds for this one step. (With several slow solvers, `n` counts within the step of the one that has the
    /// shortest.)
    ///
    /// # Errors
    /// When the state of the solvers makes no sense to the law.
    fn during(&mut self, k: u64, n: u64, slow: &Slow, fast: &mut Fast) -> Result<(), StepError> {
        let _ = (k, n, slow, fast);
        Ok(())
    }
    /// Limits that the law sets on the long step.
    fn limits(&self, slow: &Slow, fast: &Fast, report: &mut Limits) {
        let _ = (slow, fast, report);
    }
    /// Everything that [`Coupling::show`] can show. Fields have one value per item of a place of the fast solver.
    fn shown(&self) -> Vec<Shown> {
        Vec::new()
    }
    /// Shows fields and numbers, such as what was exchanged or the work done; computes only what the sink wants.
    fn show(&self, slow: &Slow, fast: &Fast, sink: &mut dyn FieldSink) {
        let _ = (slow, fast, sink);
    }
    /// Adds the state of the law to a section.
    fn save(&self, to: &mut Section) {
        let _ = to;
    }
    /// Takes the state from a section.
    ///
    /// # Errors
    /// When an entry is missing or does not fit.
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let _ = from;
        Ok(())
    }
}

/// Why two solvers could not be coupled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CouplingError {
    /// The law or node.
    pub place: String,
    /// What does not fit, with what would.
    pub reason: String,
}

impl CouplingError {
    /// At a place, for a reason.
    pub fn new(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { place: place.into(), reason: reason.into() }
    }
}

impl fmt::Display for CouplingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.reason)
    }
}

impl std::error::Error for CouplingError {}
