//! Shaking: an acceleration that all grains feel beside gravity, as on a table that is shaken and seen from it.

use crate::material::SetupError;
use core::f64::consts::TAU;
use granular_core::snapshot::check_entry;
use granular_core::{Dim, Linear, Section, SnapshotError};

/// Name in a snapshot.
const NUMBERS: &str = "shaking";

/// An oscillating acceleration whose frequency goes from one value to another, again and again.
///
/// $a(t) = A \sin(2 \pi (f_0 t + (f_1 - f_0) t^2 / 2T))$ for $t$ from 0 to $T$, then from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaking<D: Dim> {
    /// Largest acceleration $A$ \[m/s^2\].
    pub acceleration: D::Vec,
    /// Frequency $f_0$ at the start of a pass \[Hz\].
    pub from: f64,
    /// Frequency $f_1$ at its end \[Hz\].
    pub to: f64,
    /// Duration $T$ of a pass \[s\].
    pub pass: f64,
}

impl<D: Dim> Shaking<D> {
    /// The acceleration at a time since the start of the shaking \[s\].
    pub fn at(&self, time: f64) -> D::Vec {
        let t = time % self.pass;
        let turns = self.from * t + 0.5 * (self.to - self.from) * t * t / self.pass;
        self.acceleration * (TAU * turns).sin()
    }

    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let positive = |what: &str, value: f64| {
            let fits = value > 0.0 && value.is_finite();
            if fits { Ok(()) } else { Err(SetupError::new(what, value, "positive and finite")) }
        };
        positive("frequency of shaking", self.from)?;
        positive("frequency of shaking", self.to)?;
        positive("pass of shaking", self.pass)?;
        if self.acceleration.is_finite() {
            return Ok(());
        }
        Err(SetupError::new("acceleration of shaking", f64::NAN, "finite"))
    }
}

/// A shaking and its age.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shaken<D: Dim> {
    pub(crate) shaking: Shaking<D>,
    /// Time since its start \[s\]: a sum of steps, so that it does not matter how they are split into calls.
    pub(crate) age: f64,
}

/// Saves a shaking that goes on; a scene without one saves nothing.
pub(crate) fn save<D: Dim>(shaken: Option<&Shaken<D>>, to: &mut Section) {
    if let Some(Shaken { shaking, age }) = shaken {
        to.put("acceleration of shaking", &[shaking.acceleration]);
        to.put(NUMBERS, &[shaking.from, shaking.to, shaking.pass, *age]);
    }
}

pub(crate) fn restore<D: Dim>(from: &Section) -> Result<Option<Shaken<D>>, SnapshotError> {
    if !from.entries().any(|(name, _)| name == NUMBERS) {
        return Ok(None);
    }
    let acceleration = from.array_of("acceleration of shaking", 1)?[0];
    let numbers: Vec<f64> = from.array_of(NUMBERS, 4)?;
    let shaking = Shaking { acceleration, from: numbers[0], to: numbers[1], pass: numbers[2] };
    check_entry(NUMBERS, shaking.check().is_ok() && numbers[3].is_finite() && numbers[3] >= 0.0)?;
    Ok(Some(Shaken { shaking, age: numbers[3] }))
}
