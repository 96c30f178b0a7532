//! Grains that come and go while a simulation runs.
//!
//! Both happen between steps, at fixed counts of steps, so that a split or a restart changes nothing. Places and
//! sizes are drawn from the seed and the number of the grain, never from a stream: there is no random state.

use crate::material::MaterialId;
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Linear, Section, SnapshotError, Vector};

mod exchange;
mod room;

/// Steps between two looks at what inlets and outlets have to do.
pub const STEPS_PER_LOOK: u64 = 100;

/// A place where grains are put in, at a rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Inlet<D: Dim> {
    /// Name.
    pub name: String,
    /// Lower corner of the box in which whole grains are placed \[m\].
    pub low: D::Vec,
    /// Upper corner \[m\].
    pub high: D::Vec,
    /// Grains per time \[1/s\].
    pub rate: f64,
    /// Grains in all, those that do not fit included.
    pub number: u64,
    /// Radii, each as likely as any other \[m\].
    pub radii: Vec<f64>,
    /// Velocity at which they come \[m/s\].
    pub velocity: D::Vec,
    /// Material.
    pub material: MaterialId,
    /// Random seed.
    pub seed: u64,
    /// Whether it runs from the start.
    pub runs: bool,
}

/// Where grains are taken out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outlet<D: Dim> {
    /// Where the centre is beyond a plane, on the side to which the normal points.
    Beyond {
        /// A point of the plane \[m\].
        point: D::Vec,
        /// Normal, of any length.
        normal: D::Vec,
    },
    /// Where the centre is outside a box.
    Outside {
        /// Lower corner \[m\].
        low: D::Vec,
        /// Upper corner \[m\].
        high: D::Vec,
    },
}

impl<D: Dim> Outlet<D> {
    pub(super) fn takes(&self, at: D::Vec) -> bool {
        match *self {
            Self::Beyond { point, normal } => (at - point).dot(normal) > 0.0,
            Self::Outside { low, high } => at.max(low).min(high) != at,
        }
    }
}

/// Grains that came and went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchanged {
    /// Grains put in.
    pub inserted: u64,
    /// Grains that were due but did not fit in.
    pub not_placed: u64,
    /// Grains taken out.
    pub removed: u64,
    /// Mass put in \[kg; kg/m in the plane\].
    pub mass_inserted: f64,
    /// Mass taken out \[kg; kg/m in the plane\].
    pub mass_removed: f64,
    /// Energy that came with grains, less what left with them \[J\]; zero unless the ledger is kept.
    pub energy: f64,
}

/// An inlet and what it has done.
#[derive(Clone, Debug)]
pub(super) struct Source<D: Dim> {
    pub(super) inlet: Inlet<D>,
    /// Time for which it ran before it was last started \[s\].
    pub(super) before: f64,
    /// When it was last started \[s\]; not a number while it does not run.
    pub(super) since: f64,
    /// Grains that were due so far.
    pub(super) tried: u64,
}

impl<D: Dim> Source<D> {
    pub(super) fn elapsed(&self, time: f64) -> f64 {
        if self.since.is_nan() { self.before } else { self.before + (time - self.since) }
    }

    /// Grains that are due now.
    pub(super) fn due(&self, time: f64) -> u64 {
        let all = (self.inlet.rate * self.elapsed(time)).floor() as u64;
        all.min(self.inlet.number).saturating_sub(self.tried)
    }
}

/// Where grains come and go; nothing in most scenes.
#[derive(Clone, Debug, Default)]
pub(crate) struct InletsAndOutlets<D: Dim> {
    pub(super) sources: Vec<Source<D>>,
    pub(super) outlets: Vec<Outlet<D>>,
    pub(super) next_id: u32,
    pub(super) done: Exchanged,
}

impl<D: Dim> InletsAndOutlets<D> {
    pub(crate) fn new(grains: usize) -> Self {
        Self { sources: Vec::new(), outlets: Vec::new(), next_id: grains as u32, done: Exchanged::default() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.sources.is_empty() && self.outlets.is_empty()
    }

    /// Whether an inlet has grains left, now or when it is started.
    pub(crate) fn brings_grains(&self) -> bool {
        self.sources.iter().any(|source| source.tried < source.inlet.number)
    }

    /// Inlets and outlets.
    pub(crate) fn doors(&self) -> usize {
        self.sources.len() + self.outlets.len()
    }

    pub(crate) fn has_outlets(&self) -> bool {
        !self.outlets.is_empty()
    }

    pub(crate) fn inlets(&self) -> impl Iterator<Item = &Inlet<D>> {
        self.sources.iter().map(|source| &source.inlet)
    }

    pub(crate) fn save(&self, to: &mut Section) {
        if self.is_empty() {
            return;
        }
        let clocks: Vec<[f64; 3]> = self
            .sources
            .iter()
            .map(|source| {
                let runs = !source.since.is_nan();
                [f64::from(u8::from(runs)), source.before, if runs { source.since } else { 0.0 }]
            })
            .collect();
        let tried: Vec<u64> = self.sources.iter().map(|source| source.tried).collect();
        let Exchanged { inserted, not_placed, removed, mass_inserted, mass_removed, energy } = self.done;
        to.put("clocks of inlets", &clocks);
        to.put("grains due", &tried);
        to.put_one("next identifier", self.next_id);
        to.put("grains exchanged", &[inserted, not_placed, removed]);
        to.put("mass and energy exchanged", &[mass_inserted, mass_removed, energy]);
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        if self.is_empty() {
            return Ok(());
        }
        let clocks: Vec<[f64; 3]> = from.array_of("clocks of inlets", self.sources.len())?;
        check_entry("clocks of inlets", clocks.iter().flatten().all(|value| value.is_finite()))?;
        let tried: Vec<u64> = from.array_of("grains due", self.sources.len())?;
        for ((source, [runs, before, since]), tried) in self.sources.iter_mut().zip(clocks).zip(tried) {
            (source.before, source.tried) = (before, tried);
            source.since = if runs == 0.0 { f64::NAN } else { since };
        }
        self.next_id = from.one("next identifier")?;
        let counts: Vec<u64> = from.array_of("grains exchanged", 3)?;
        let sums: Vec<f64> = from.array_of("mass and energy exchanged", 3)?;
        check_entry("mass and energy exchanged", sums.iter().all(|sum| sum.is_finite()))?;
        self.done = Exchanged {
            inserted: counts[0],
            not_placed: counts[1],
            removed: counts[2],
            mass_inserted: sums[0],
            mass_removed: sums[1],
            energy: sums[2],
        };
        Ok(())
    }
}
