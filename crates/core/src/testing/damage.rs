//! Sections that lack something or hold what is not finite.

use super::contract::{Breach, Contract, state_of};
use crate::snapshot::{Section, SnapshotError};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Steps within which a number that is not finite must be met.
const SOON: u64 = 10;

impl Contract {
    /// A section with an entry missing, cut, doubled or one byte off is refused with an error;
    /// when it is missing, the error names it. Nothing panics.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn damage(&self) -> Result<(), Breach> {
        const WHY: &str = "a damaged section is refused";
        let saved = self.saved(WHY)?;
        self.must_refuse(&Section::new("solver"), WHY, "an empty section")?;
        for (name, bytes) in saved.entries() {
            let error = self.must_refuse(&with(&saved, name, None), WHY, &format!("no `{name}`"))?;
            if !error.to_string().contains(name) {
                return Err(Breach::new(WHY, format!("without `{name}` the message is `{error}`")));
            }
            if self.any_length.contains(&name) {
                continue;
            }
            let mut longer = bytes.to_vec();
            longer.push(0);
            let wrong = [
                bytes[..bytes.len() / 2].to_vec(),
                bytes[..bytes.len().saturating_sub(1)].to_vec(),
                Vec::new(),
                bytes.repeat(2),
                longer,
            ];
            for bytes_now in wrong.into_iter().filter(|wrong| wrong != bytes) {
                let case = format!("`{name}` of {} instead of {} bytes", bytes_now.len(), bytes.len());
                self.must_refuse(&with(&saved, name, Some(bytes_now)), WHY, &case)?;
            }
        }
        Ok(())
    }

    /// NaN in place of the first value of an entry is refused when it is restored, or reported
    /// as an error within ten steps.
    ///
    /// Tried for every entry whose words read as numbers of a size that occurs (zero or 1e-200 to
    /// 1e200, not all zero): counts and indices read as far smaller. The bits also make NaN of a
    /// number in single precision. [`Contract::not_numbers`] leaves entries out.
    ///
    /// # Errors
    /// When the promise is not kept, or no entry looks like numbers.
    pub fn not_finite(&self) -> Result<(), Breach> {
        const WHY: &str = "what is not finite is reported";
        let saved = self.saved(WHY)?;
        let mut tried = 0;
        for (name, bytes) in saved.entries() {
            if !looks_like_numbers(bytes) || self.not_numbers.contains(&name) {
                continue;
            }
            tried += 1;
            let mut poisoned = bytes.to_vec();
            poisoned[..8].copy_from_slice(&f64::NAN.to_le_bytes());
            let mut solver = (self.build)();
            let section = with(&saved, name, Some(poisoned));
            let noticed =
                solver.restore(&section).is_err() || (0..SOON).any(|_| solver.step(self.dt).is_err());
            if !noticed {
                return Err(Breach::new(WHY, format!("NaN in `{name}` went unnoticed for {SOON} steps")));
            }
        }
        if tried == 0 {
            return Err(Breach::new(WHY, "no entry of the section looks like numbers"));
        }
        Ok(())
    }

    fn saved(&self, why: &'static str) -> Result<Section, Breach> {
        let mut solver = (self.build)();
        self.go(solver.as_mut(), self.steps, why)?;
        Ok(state_of(solver.as_ref()))
    }

    fn must_refuse(&self, section: &Section, why: &'static str, case: &str) -> Result<SnapshotError, Breach> {
        let mut solver = (self.build)();
        match catch_unwind(AssertUnwindSafe(|| solver.restore(section))) {
            Ok(Err(error)) => Ok(error),
            Ok(Ok(())) => Err(Breach::new(why, format!("{case} was accepted"))),
            Err(_) => Err(Breach::new(why, format!("{case} made it panic"))),
        }
    }
}

/// The section with other bytes in one entry, or without it.
fn with(section: &Section, name: &str, bytes: Option<Vec<u8>>) -> Section {
    let mut changed = Section::new(section.name());
    for (other, old) in section.entries() {
        if other != name {
            changed.put_bytes(other, old.to_vec());
        } else if let Some(bytes) = &bytes {
            changed.put_bytes(other, bytes.clone());
        }
    }
    changed
}

fn looks_like_numbers(bytes: &[u8]) -> bool {
    if bytes.is_empty() || !bytes.len().is_multiple_of(8) {
        return false;
    }
    let mut all_zero = true;
    bytes.chunks_exact(8).all(|word| {
        let value = f64::from_le_bytes(word.try_into().expect("chunks have eight bytes"));
        all_zero &= value == 0.0;
        value == 0.0 || (1e-200..1e200).contains(&value.abs())
    }) && !all_zero
}
