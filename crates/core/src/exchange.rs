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

/// A law between a solver with long steps and one with short steps, which takes several within one of the other.
///
/// In each long step: all laws go forward, the slow solvers step, all laws go backward, the fast solvers step.
/// A law owns its scratch and its saved state; laws add to inputs, so that two may feed one solver.
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
    /// After the slow step. Loads are means over it, held until replaced.
    ///
    /// # Errors
    /// When the state of the slow solver makes no sense to the fast one.
    fn backward(&mut self, slow: &Slow, fast: &mut Fast) -> Result<(), StepError> {
        let _ = (slow, fast);
        Ok(())
    }
    /// Limits that the law sets on the long step.
    fn limits(&self, slow: &Slow, fast: &Fast, report: &mut Limits) {
        let _ = (slow, fast, report);
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
