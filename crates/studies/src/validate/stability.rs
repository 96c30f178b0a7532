//! Where a solver fails, beside where it says that it will.
//!
//! Each sweep makes a flow that starts at full speed, or a sample of grains, more hostile, value by value, until a run no longer finishes, and
//! closes in on the limit by bisection. The prediction is the solver's own report of
//! [limits](granular_core::Solver::limits); it is one of the values tried. Two things must hold, or the study fails:
//!
//! - every blow-up is noticed by the guard of the solver, and named, within ten steps of the first field that makes no
//!   sense;
//! - a run that keeps all bounds finishes.
//!
//! ```
//! use granular_studies::validate::stability::{Request, limits, verdict};
//! let request = Request::default().choose("operator", &["regularised"]).choose("flow", &["cavity"]);
//! let rows = limits("lbm", &request)?;
//! verdict(&rows)?;
//! # Ok::<(), granular_driver::failure::Failure>(())
//! ```

pub(crate) mod judge;
pub(crate) mod search;
mod show;
pub(crate) mod watch;

pub use show::table;

use super::Effort;
use crate::METHODS;
use granular_driver::failure::Failure;
use serde::Serialize;
use std::collections::BTreeMap;

/// A study of the limits of a method.
#[derive(Clone, Copy, Debug)]
pub struct Stability {
    /// What may be chosen among; all of it by default.
    pub choices: &'static [Choice],
    pub(crate) run: fn(&Request) -> Result<Vec<Row>, Failure>,
}

/// What a study may be narrowed down to.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Name of its flag, in the singular.
    pub flag: &'static str,
    /// What is chosen, such as "Collision operators".
    pub about: &'static str,
    /// Names to choose among.
    pub names: &'static [&'static str],
}

/// What to study.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// How fine.
    pub effort: Effort,
    /// Chosen names by the flag of their [`Choice`]; all when there are none.
    pub chosen: BTreeMap<String, Vec<String>>,
}

impl Request {
    /// The same with these names chosen for a flag.
    pub fn choose(mut self, flag: &str, names: &[&str]) -> Self {
        self.chosen.insert(flag.to_owned(), names.iter().map(|name| (*name).to_owned()).collect());
        self
    }

    /// Whether a name is among those chosen.
    pub(crate) fn wants(&self, flag: &str, name: &str) -> bool {
        let chosen = self.chosen.get(flag).map_or(&[][..], Vec::as_slice);
        chosen.is_empty() || chosen.iter().any(|other| other == name)
    }

    /// Flags for which something is chosen.
    fn flags(&self) -> impl Iterator<Item = (&str, &[String])> {
        let flags = self.chosen.iter().map(|(flag, names)| (flag.as_str(), names.as_slice()));
        flags.filter(|(_, names)| !names.is_empty())
    }
}

/// What lies beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Nothing: the sweep finished at its hostile end.
    Finished,
    /// The check refuses what is beyond the predicted limit, before the run would fail.
    Refused,
    /// The guard stops the run.
    Stopped,
}

/// One limit: predicted and observed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Flow and scheme.
    pub case: String,
    /// What was swept, and what was held.
    pub parameter: &'static str,
    /// The limit that the solver reports; none where it knows of none.
    pub predicted_limit: Option<f64>,
    /// Most hostile value that finished, whatever the check says of it; none when nothing did.
    pub observed_limit: Option<f64>,
    /// What lies beyond.
    pub outcome: Outcome,
    /// Why.
    pub reason: String,
    /// What makes the study fail: a guard that was silent, or a failure within the bounds.
    #[serde(skip)]
    pub fault: Option<String>,
    /// Whether a run fails within the bounds, as the documentation of the method and `check` say it does: the study does not fail
    /// by it, and counts it on its own.
    pub known: bool,
}

/// Sweeps a method to its limits.
///
/// # Errors
/// When no method of this name has such a study, it has no such choice, or what is swept cannot be set up.
pub fn limits(method: &str, request: &Request) -> Result<Vec<Row>, Failure> {
    let known = METHODS.iter().find(|known| known.name == method).and_then(|known| known.stability);
    let study = known.ok_or_else(|| Failure::Io(format!("no limits of `{method}` are studied")))?;
    for (flag, names) in request.flags() {
        let choice = study.choices.iter().find(|choice| choice.flag == flag);
        choice.ok_or_else(|| elsewhere(flag, method))?.check(names)?;
    }
    (study.run)(request)
}

impl Choice {
    fn check(&self, names: &[String]) -> Result<(), Failure> {
        let Self { flag, names: known, .. } = self;
        match names.iter().find(|name| !known.contains(&name.as_str())) {
            None => Ok(()),
            Some(name) => {
                Err(Failure::Io(format!("no {flag} is called `{name}`; known: {}", known.join(", "))))
            }
        }
    }
}

/// Says whose flag it is, with all that belong to the same method.
fn elsewhere(flag: &str, method: &str) -> Failure {
    let flags = |study: &Stability| study.choices.iter().map(|choice| choice.flag).collect::<Vec<_>>();
    let owner = METHODS.iter().find_map(|method| {
        let flags = method.stability.as_ref().map(flags)?;
        flags.contains(&flag).then_some((method.name, flags))
    });
    Failure::Io(match owner {
        None => format!("no study has a choice of `{flag}`"),
        Some((owner, flags)) => {
            let verb = if flags.len() > 1 { "are" } else { "is" };
            let flags: Vec<String> = flags.iter().map(|flag| format!("--{flag}")).collect();
            format!("{} {verb} of `{owner}`; leave them out for `{method}`", flags.join(" and "))
        }
    })
}

/// What a study comes to.
///
/// # Errors
/// When a guard was silent, or a run failed within the bounds.
pub fn verdict(rows: &[Row]) -> Result<(), Failure> {
    let faults: Vec<String> = rows
        .iter()
        .filter_map(|row| row.fault.as_ref().map(|fault| format!("{}, {}: {fault}", row.case, row.parameter)))
        .collect();
    if faults.is_empty() {
        return Ok(());
    }
    Err(Failure::Invalid(format!("{} of {} limits failed: {}", faults.len(), rows.len(), faults.join("\n"))))
}
