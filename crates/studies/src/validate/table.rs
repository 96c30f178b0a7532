//! Rows as a table for people, within 120 characters.

use super::row::Row;
use super::tally::Tally;
use std::fmt::Write;

const WIDTH: usize = 116;

/// Rows as an aligned table: measured beside reference, one block a case.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    for block in rows.chunk_by(|a, b| (a.case, a.solver, a.tier) == (b.case, b.solver, b.tier)) {
        let first = &block[0];
        let heading = format!("{} ({}, {})", first.case, first.solver, first.tier.name());
        let _ = writeln!(
            text,
            "{heading:<52} {:>12} {:>12} {:>9} {:>9}  {:<6} {:>6}",
            "measured", "reference", "error", "allowed", "", "s"
        );
        for row in block {
            // A long name has a line of its own.
            let mut name = row.metric.as_str();
            if name.chars().count() > 50 {
                let _ = writeln!(text, "  {name}");
                name = "";
            }
            let _ = writeln!(
                text,
                "  {:<50} {:>12} {:>12} {:>9} {:>9}  {:<6} {:>6.2}",
                name,
                number(row.value),
                number(row.reference),
                small(row.error),
                small(row.tolerance),
                row.verdict(),
                row.seconds
            );
        }
        let mut said = "";
        let notable = |row: &&Row| !row.note.is_empty() && (!row.gate || !row.pass || row.note.len() > 40);
        for row in block.iter().filter(notable) {
            // Rows that share a note say it once.
            if row.note != said {
                text += &wrapped(&format!("{}: {}", row.metric, row.note));
            }
            said = &row.note;
        }
        text.push('\n');
    }
    let Tally { required, passed, claims, met, small } = Tally::of(rows);
    let seconds: f64 = rows.iter().map(|row| row.seconds).sum();
    let _ = writeln!(
        text,
        "{passed} of {required} required rows passed, {met} of {claims} claims met, {seconds:.1} s"
    );
    if small > 0 {
        let _ = writeln!(
            text,
            "{small} claims were measured on too few grains to be judged (small); --full runs as many as they take"
        );
    }
    text
}

/// Six digits, without an exponent where that reads well.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e5).contains(&size) {
        let digits = if size >= 1.0 { 5 - (size.log10().floor() as usize).min(5) } else { 6 };
        return format!("{value:.digits$}");
    }
    format!("{value:.4e}")
}

/// Two digits with an exponent.
pub(super) fn small(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// A note, indented and broken between words.
fn wrapped(note: &str) -> String {
    let (mut text, mut line) = (String::new(), String::from("    *"));
    for word in note.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            text += &line;
            text.push('\n');
            line = "     ".to_owned();
        }
        line.push(' ');
        line += word;
    }
    text + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validate::Tier;
    use crate::validate::{Measure, Rows};

    #[test]
    fn no_line_is_too_long_and_the_verdict_is_said() {
        let mut rows = Rows::new("a_case", "dem");
        let note = "a reason that is long enough to be broken over several lines ".repeat(4);
        rows.add(Measure::relative(Tier::Thesis, "run-out", 1.0, 2.0, 0.1).claim().note(note));
        rows.add(Measure::absolute(Tier::ClosedForm, "angle", 1e-9, 0.0, 1e-3));
        let text = table(&rows.finish());
        assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
        assert!(text.contains("differs") && text.contains("pass") && text.contains("1 of 1 required"));
        assert!(text.contains("0 of 1 claims met") && !text.contains("too few"));
    }

    #[test]
    fn a_claim_is_judged_at_a_size_that_can_bear_it_only() {
        let mut rows = Rows::new("a_case", "dem");
        let claim = || Measure::relative(Tier::Thesis, "run-out", 1.0, 2.0, 0.1).claim();
        rows.claims_need(80, 1000);
        rows.add(claim());
        rows.add(Measure::absolute(Tier::Conservation, "energy", 1.0, 0.0, 0.1));
        rows.claims_need(1000, 1000);
        rows.add(claim());
        let rows = rows.finish();
        assert_eq!(rows.iter().map(|row| row.judged).collect::<Vec<_>>(), [false, true, true]);
        let text = table(&rows);
        // What is required is so at any size.
        assert!(text.contains("0 of 1 required rows passed, 0 of 1 claims met"), "{text}");
        assert!(
            text.contains("1 claims were measured on too few grains") && text.contains("small"),
            "{text}"
        );
    }

    #[test]
    fn numbers_keep_their_digits() {
        assert_eq!(number(0.0924896), "0.092490");
        assert_eq!(number(18.4349), "18.4349");
        assert_eq!(number(1e-9), "1.0000e-9");
        assert_eq!(number(0.0), "0.000000");
    }
}
