//! The promise on limits.

use super::contract::{Breach, Contract};
use crate::solver::{Limits, StepRule};
use std::collections::HashSet;

impl Contract {
    /// Limits on the step are positive and finite, no value is NaN, names are unique and reasons
    /// given, at the start and later; and the step of this test keeps them. Those that must not be
    /// exceeded are the same when asked for alone.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn limits(&self) -> Result<(), Breach> {
        const WHY: &str = "limits are positive, finite and named once";
        let mut solver = (self.build)();
        for _ in 0..2 {
            let mut report = Limits::default();
            solver.limits(&mut report);
            if let Some(found) = fault_in(&report, self.dt) {
                return Err(Breach::new(WHY, found));
            }
            let mut alone = Limits::default();
            solver.hard_limits(&mut alone);
            let [among_all, alone] = [report, alone].map(hard);
            if alone != among_all {
                return Err(Breach::new(
                    WHY,
                    format!("hard limits are {alone:?} alone and {among_all:?} among all"),
                ));
            }
            self.go(solver.as_mut(), self.steps, WHY)?;
        }
        Ok(())
    }
}

/// What must not be exceeded.
fn hard(report: Limits) -> Vec<(&'static str, StepRule, f64)> {
    let hard = report.steps.into_iter().filter(|limit| limit.rule != StepRule::Recommended);
    hard.map(|limit| (limit.name, limit.rule, limit.dt)).collect()
}

fn fault_in(report: &Limits, dt: f64) -> Option<String> {
    let mut names = HashSet::new();
    for limit in &report.steps {
        if !(limit.dt.is_finite() && limit.dt > 0.0) {
            return Some(format!("limit `{}` is {} s", limit.name, limit.dt));
        }
        if limit.why.is_empty() || !names.insert(limit.name) {
            return Some(format!("limit `{}` has no reason or stands there twice", limit.name));
        }
    }
    for bound in &report.bounds {
        if bound.value.is_nan() || bound.allowed.is_nan() {
            return Some(format!("bound `{}` has {} of {}", bound.name, bound.value, bound.allowed));
        }
        if bound.why.is_empty() || !names.insert(bound.name) {
            return Some(format!("bound `{}` has no reason or stands there twice", bound.name));
        }
    }
    let allowed = report.largest_allowed().filter(|limit| limit.dt < dt)?;
    Some(format!("the test takes steps of {dt} s, but `{}` allows {} s", allowed.name, allowed.dt))
}
