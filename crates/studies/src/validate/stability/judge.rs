//! What a sweep found, judged against the limit that the solver reports.

use super::search::Found;
use super::{Outcome, Row};

/// A parameter that was swept from a mild to a hostile value.
pub(crate) struct Swept<'a> {
    pub(crate) case: String,
    pub(crate) parameter: &'static str,
    /// From mild to hostile.
    pub(crate) range: [f64; 2],
    /// A value as it is printed.
    pub(crate) shown: &'a dyn Fn(f64) -> f64,
}

impl Swept<'_> {
    /// `refuses`: the check refuses what is beyond the prediction.
    pub(crate) fn row(&self, found: &Found, predicted: Option<f64>, refuses: bool) -> Row {
        let (shown, [from, to]) = (self.shown, self.range);
        // Whether the observed limit is at least as hostile as the predicted one.
        let reaches = |value: f64| predicted.is_none_or(|p| if to > from { value >= p } else { value <= p });
        let is_safe = found.finished.is_some_and(reaches) || found.failed.is_none();
        let beyond = match &found.failed {
            None => format!("finishes to the end of the sweep, {}", brief(shown(to))),
            Some((value, why)) => format!("stopped at {}: {why}", brief(shown(*value))),
        };
        let (outcome, mut reason) = match (&found.failed, predicted) {
            (_, Some(predicted)) if refuses && is_safe => {
                let bound = brief(shown(predicted));
                let side = if to > from { "above" } else { "below" };
                (Outcome::Refused, format!("refused {side} {bound}; past the check, {beyond}"))
            }
            (None, _) => (Outcome::Finished, beyond),
            (Some(_), _) => (Outcome::Stopped, beyond),
        };
        let mut faults: Vec<String> = found
            .missed
            .iter()
            .map(|(value, why)| format!("guard silent at {}: {why}", brief(shown(*value))))
            .collect();
        if !is_safe {
            faults.push("it fails within the bounds that the solver reports".to_owned());
        }
        let fault = (!faults.is_empty()).then(|| faults.join("; "));
        if let Some(fault) = &fault {
            reason = format!("{fault}; {reason}");
        }
        Row {
            case: self.case.clone(),
            parameter: self.parameter,
            predicted_limit: predicted.map(shown),
            observed_limit: found.finished.map(shown),
            outcome,
            reason,
            fault,
            known: false,
        }
    }
}

/// At most five digits.
pub(crate) fn brief(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.5}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
