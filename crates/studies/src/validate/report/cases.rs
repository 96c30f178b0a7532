//! Cases as sections of the page.

use super::links::Links;
use crate::validate::row::Row;
use crate::validate::table::{number, small};
use crate::validate::{Case, Tier};
use std::fmt::Write;

/// Notes that are longer stand below the table.
const SHORT: usize = 70;
const HEAD: &str = "| metric | evidence | measured | reference | error | tolerance | verdict | note |\n\
                    |---|---|--:|--:|--:|--:|---|---|\n";

/// What a case shows and is worth, its rows, and their notes.
pub(super) fn section(case: &Case, rows: &[Row], links: &Links) -> String {
    let name = case.name;
    let readme = granular_validation_data::readme(name).unwrap_or_default();
    let source = links.to(&format!("validation/{name}/README.md"));
    let source = source.map_or(String::new(), |link| format!(" ([source and set-up]({link}))"));
    let weakness = weakness(readme).map_or(String::new(), |text| format!("\n\nWeakness: {text}"));
    let mut text = format!("\n### {name}\n\n{}{source}.{weakness}\n\n{HEAD}", title(readme));
    let mut notes = Notes::default();
    for row in rows {
        text += &line(row, &mut notes);
    }
    notes.0.iter().enumerate().for_each(|(index, note)| {
        let before = if index == 0 { "\n" } else { "" };
        let _ = writeln!(text, "{before}{}. {}", index + 1, escaped(note));
    });
    text
}

/// Long notes in the order of their rows, each once.
#[derive(Default)]
struct Notes<'a>(Vec<&'a str>);

impl<'a> Notes<'a> {
    /// What stands in the cell of a note.
    fn cell(&mut self, note: &'a str) -> String {
        if note.chars().count() <= SHORT {
            return escaped(note);
        }
        let known = self.0.iter().position(|other| *other == note);
        let index = known.unwrap_or_else(|| {
            self.0.push(note);
            self.0.len() - 1
        });
        format!("see {}", index + 1)
    }
}

fn line<'a>(row: &'a Row, notes: &mut Notes<'a>) -> String {
    let (note, is_absolute) = row.remark();
    let absolute = if is_absolute { " abs." } else { "" };
    format!(
        "| {} | {} | {} | {} | {}{absolute} | {} | {} | {} |\n",
        escaped(&row.metric),
        row.tier.name(),
        plain(row.value),
        plain(row.reference),
        small(row.error),
        small(row.tolerance),
        verdict(row),
        notes.cell(note)
    )
}

/// A number as tables for people have it, but for zeros, which need no digits.
fn plain(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { number(value) }
}

/// The verdict, in bold where it is a failure.
pub(super) fn verdict(row: &Row) -> String {
    let word = row.verdict();
    if row.judged && !row.pass { format!("**{word}**") } else { word.to_owned() }
}

/// The tiers of evidence of some rows, each once.
pub(super) fn evidence(rows: &[Row]) -> String {
    let mut tiers: Vec<Tier> = Vec::new();
    for row in rows {
        if !tiers.contains(&row.tier) {
            tiers.push(row.tier);
        }
    }
    tiers.into_iter().map(Tier::name).collect::<Vec<_>>().join(", ")
}

/// Text that Markdown shows as it is.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for character in text.chars() {
        if matches!(character, '|' | '*' | '<' | '~' | '_' | '[' | ']' | '\\') {
            safe.push('\\');
        }
        safe.push(character);
    }
    safe
}

/// The heading of a README.
fn title(readme: &str) -> &str {
    readme.lines().find_map(|line| line.strip_prefix("# ")).unwrap_or_default()
}

/// What a README says after `Weakness:`, on one line.
pub(super) fn weakness(readme: &str) -> Option<String> {
    let mut lines = readme.lines().skip_while(|line| !line.starts_with("- Weakness:"));
    let first = lines.next()?.trim_start_matches("- Weakness:").trim();
    let rest = lines.take_while(|line| line.starts_with("  ")).map(str::trim);
    Some(std::iter::once(first).chain(rest).collect::<Vec<_>>().join(" "))
}
