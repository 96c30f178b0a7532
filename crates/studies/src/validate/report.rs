//! What was measured as a page in Markdown: [`docs/validation.md`](Report) is one.
//!
//! The page has the tables, grouped by method and case, and what the README of a case says of its weakness. It has no date, so that
//! two runs of one commit on one machine differ in times alone.

mod cases;
mod links;

use super::row::Row;
use super::tally::Tally;
use super::{Case, Effort, all};
use crate::METHODS;
use granular_driver::failure::Failure;
use granular_driver::folder;
use links::Links;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A page to be written.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Form of the cases.
    pub effort: Effort,
    /// What the names of the cases contain.
    pub filter: Option<&'a str>,
    /// File that the page is written to.
    pub path: &'a Path,
    /// What was measured.
    pub rows: &'a [Row],
}

/// Whether a page can be written to this file, as far as can be told before it is; the file stays as it is.
///
/// # Errors
/// When its folder does not exist or takes no file, or it is a folder itself.
pub fn can_write(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::io(path.display(), "a file is expected, and it is a folder"));
    }
    let mut trial = path.as_os_str().to_owned();
    trial.push(".tmp");
    let tried = fs::File::create(&trial).and_then(|_| fs::remove_file(&trial));
    tried.map_err(|error| Failure::io(path.display(), format!("it cannot be written: {error}")))
}

impl Report<'_> {
    /// Writes the page: at any moment the file holds the old or the new page, and never a part.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self) -> Result<(), Failure> {
        let page = self.page();
        granular_io::write_atomically(self.path, |file| file.write_all(page.as_bytes()))?;
        Ok(())
    }

    /// The page.
    pub fn page(&self) -> String {
        let links = Links::from(self.path);
        let mut text = self.origin();
        text += &Self::legend(&links);
        text += &self.overview();
        text += &self.disagreements();
        for method in METHODS {
            let blocks: Vec<(Case, &[Row])> =
                self.blocks().filter(|(case, _)| case.method == method.name).collect();
            if !blocks.is_empty() {
                let _ = writeln!(text, "\n## {} (`{}`)", method.about, method.name);
            }
            for (case, rows) in blocks {
                text += &cases::section(&case, rows, &links);
            }
        }
        text
    }

    /// The rows of each case.
    fn blocks(&self) -> impl Iterator<Item = (Case, &[Row])> {
        let blocks = self.rows.chunk_by(|a, b| a.case == b.case);
        blocks.filter_map(|rows| Some((all().find(|case| case.name == rows[0].case)?, rows)))
    }

    /// Where the numbers come from.
    fn origin(&self) -> String {
        let facts = folder::provenance();
        let fact = |name: &str| facts[name].as_str().unwrap_or("unknown").to_owned();
        let form = match self.effort {
            Effort::Full => "complete",
            Effort::Quick => {
                "quick, with small samples, seconds a case; claims that take more grains than were run are not judged (*small*), \
                 and `--full` runs as many as they take"
            }
        };
        let only = |filter| format!("\n- Cases: those whose name contains `{filter}`");
        format!(
            "# What is measured\n\nWritten by the command below; not edited by hand.\n\n- Command: `{}`\n\
             - Program: version {}, commit `{}`\n- Machine: {}, {}, {} threads\n- Form: {form}{}\n",
            self.command(),
            fact("version"),
            fact("commit"),
            fact("cpu"),
            fact("target"),
            facts["threads"],
            self.filter.map_or(String::new(), only),
        )
    }

    /// How to read the numbers.
    fn legend(links: &Links) -> String {
        let guide = links.to("docs/evidence.md").map_or(String::new(), |link| {
            format!(" [What the numbers are worth]({link}) has more, with what is not validated.")
        });
        format!(
            "\nEach row is a number that was measured beside what it should be. The error is the distance from the reference, over \
             the reference unless it says *abs.* or the note says otherwise. A row passes where its error is at most its tolerance. \
             **Required** rows *pass*, or the validation has **FAILED**. **Claims** of the literature are *met*, or the result \
             *differs*, which fails nothing.{guide}\n"
        )
    }

    /// The command that writes this page.
    fn command(&self) -> String {
        let filter = self.filter.map_or(String::new(), |filter| format!(" {filter}"));
        let full = if self.effort == Effort::Full { " --full" } else { "" };
        format!("granular validate{filter}{full} --report {}", self.path.display())
    }

    /// One line a case.
    fn overview(&self) -> String {
        let mut text = "\n## Overview\n\n| case | what | evidence | required rows that pass | claims that are met | time [s] |\n\
                        |---|---|---|--:|--:|--:|\n"
            .to_owned();
        for (case, rows) in self.blocks() {
            let Case { name, about, .. } = case;
            let evidence = cases::evidence(rows);
            let _ = writeln!(text, "| [{name}](#{name}) | {about} | {evidence} | {}", counted(rows));
        }
        let _ = writeln!(text, "| **all** | | | {}", counted(self.rows));
        text
    }

    /// Rows that a reader should know of first.
    fn disagreements(&self) -> String {
        let (mut text, mut last) = (String::new(), "");
        for row in self.rows.iter().filter(|row| row.judged && !row.pass) {
            if text.is_empty() {
                text += "\n## What does not agree\n\n";
            }
            if row.case != last {
                let _ = writeln!(text, "- [{0}](#{0})", row.case);
            }
            let _ = writeln!(text, "  - {} ({})", cases::escaped(&row.metric), cases::verdict(row));
            last = row.case;
        }
        text
    }
}

/// What became of rows, and the time they took: three cells.
fn counted(rows: &[Row]) -> String {
    let Tally { required, passed, claims, met, small } = Tally::of(rows);
    let share = |some: usize, all: usize| match all {
        0 => "–".to_owned(),
        all if some < all => format!("**{some} of {all}**"),
        all => format!("{some} of {all}"),
    };
    let unjudged = if small > 0 { format!(", {small} small") } else { String::new() };
    let seconds: f64 = rows.iter().map(|row| row.seconds).sum();
    format!("{} | {}{unjudged} | {seconds:.1} |", share(passed, required), share(met, claims))
}

#[cfg(test)]
mod tests;
