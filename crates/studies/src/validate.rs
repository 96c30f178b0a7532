//! Validation: cases with known answers, and how near this program comes.
//!
//! A [`Case`] gives [`Row`]s, each a measured number beside its reference. A row that gates must
//! pass; one that does not is a claim of the literature, printed with its verdict and the reason
//! for a difference. Sources, set-ups and weaknesses are in `validation/<case>/README.md`. The cases are those of all
//! [methods](crate::METHODS).
//!
//! ```
//! use granular_studies::validate::{Effort, find};
//! let rows = find(Some("grading"))?[0].run(Effort::Quick);
//! assert!(rows.iter().all(|row| row.pass));
//! # Ok::<(), granular_driver::failure::Failure>(())
//! ```

pub(crate) mod reference;
pub mod report;
mod row;
pub mod stability;
pub(crate) mod stages;
mod table;
mod tally;

pub(crate) use row::{Measure, Rows};
pub use row::{Row, Tier};
pub use table::table;

use crate::METHODS;
pub use granular_driver::Effort;
use granular_driver::failure::Failure;
use granular_driver::problems::nearest;

/// A validation case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name, also that of its folder in `validation/`.
    pub name: &'static str,
    /// What it shows, in a line.
    pub about: &'static str,
    /// Method that it belongs to.
    pub method: &'static str,
    pub(crate) run: fn(&mut Rows, Effort) -> Result<(), Failure>,
}

/// The cases of a method as `CASES`: name, what it shows, and the function that measures its rows. Each is a test, which runs
/// its quick form.
macro_rules! cases {
    ($method:literal; $($name:ident: $about:literal => $run:path;)+) => {
        pub(super) const CASES: &[$crate::validate::Case] = &[$($crate::validate::Case {
            name: stringify!($name),
            about: $about,
            method: $method,
            run: $run,
        },)+];

        #[cfg(test)]
        mod validation {
            $(#[test]
            fn $name() {
                $crate::validate::tests::passes(stringify!($name));
            })+
        }
    };
}
pub(crate) use cases;

/// All cases, method by method.
pub fn all() -> impl Iterator<Item = Case> {
    METHODS.iter().flat_map(|method| method.cases).copied()
}

impl Case {
    /// Runs the case. A solver that gives up is a row that fails.
    pub fn run(&self, effort: Effort) -> Vec<Row> {
        let mut rows = Rows::new(self.name, self.method);
        if let Err(failure) = (self.run)(&mut rows, effort) {
            let stopped = Measure::absolute(Tier::Identity, "the case runs to its end", f64::NAN, 0.0, 0.0);
            rows.add(stopped.note(failure.to_string()));
        }
        rows.finish()
    }
}

/// The cases whose name contains `filter`; all without one.
///
/// # Errors
/// When there is none.
pub fn find(filter: Option<&str>) -> Result<Vec<Case>, Failure> {
    let wanted = filter.unwrap_or_default();
    let found: Vec<Case> = all().filter(|case| case.name.contains(wanted)).collect();
    if found.is_empty() {
        let names: Vec<&str> = all().map(|case| case.name).collect();
        let known = names.join(", ");
        let hint = nearest(wanted, names);
        let hint = if hint.is_empty() { hint } else { format!("{hint} ") };
        return Err(Failure::Io(format!("no validation case is called `{wanted}`; {hint}known: {known}")));
    }
    Ok(found)
}

/// What a run of cases comes to.
///
/// # Errors
/// When a gating row failed.
pub fn verdict(rows: &[Row]) -> Result<(), Failure> {
    let failed: Vec<String> = rows
        .iter()
        .filter(|row| row.gate && !row.pass)
        .map(|row| format!("{}: {}", row.case, row.metric))
        .collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::Invalid(format!("{} of {} rows failed: {}", failed.len(), rows.len(), failed.join("; "))))
}

#[cfg(test)]
pub(crate) mod tests;
