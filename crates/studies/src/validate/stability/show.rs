//! Limits as a table for people.

use super::judge::brief;
use super::watch::MISNAMED;
use super::{Outcome, Row};
use std::fmt::Write;

/// Longest reason that is printed on a line.
const REASON: usize = 114;

/// Predicted beside observed limits, one block a case.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    for block in rows.chunk_by(|a, b| a.case == b.case) {
        let _ = writeln!(text, "{:<42} {:>10} {:>10}  outcome", block[0].case, "predicted", "observed");
        for row in block {
            let number = |value: Option<f64>| value.map_or("none".to_owned(), brief);
            let (predicted, observed) = (number(row.predicted_limit), number(row.observed_limit));
            let outcome = match row.outcome {
                Outcome::Finished => "finished",
                Outcome::Refused => "refused",
                Outcome::Stopped => "stopped",
            };
            let mark = match (&row.fault, row.known) {
                (Some(_), _) => "  FAILED",
                (None, true) => "  known to fail",
                (None, false) => "",
            };
            let _ = writeln!(text, "  {:<40} {predicted:>10} {observed:>10}  {outcome}{mark}", row.parameter);
            let reason: String = row.reason.chars().take(REASON).collect();
            let _ = writeln!(text, "      {reason}");
        }
        text.push('\n');
    }
    let failed = rows.iter().filter(|row| row.fault.is_some()).count();
    let misnamed = rows.iter().filter(|row| row.reason.contains(MISNAMED)).count();
    if misnamed > 0 {
        let said = "limits where the guard stopped in time, but named a cell whose density makes sense";
        let _ = writeln!(text, "{misnamed} {said}");
    }
    let known = rows.iter().filter(|row| row.known).count();
    if known > 0 {
        let _ = writeln!(text, "{known} limits within which runs are known to fail, as `check` says");
    }
    let _ = writeln!(
        text,
        "{} limits: {failed} where a guard was silent or a run failed within its bounds",
        rows.len()
    );
    text
}
