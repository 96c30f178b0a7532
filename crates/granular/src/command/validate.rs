//! `granular validate`.

use super::{Common, show};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgMatches, Args, FromArgMatches};
use granular_driver::failure::Failure;
use granular_studies::METHODS;
use granular_studies::validate::report::{self, Report};
use granular_studies::validate::{self, Effort, stability};
use serde_json::json;
use stability::{Choice, Request};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Flags of `granular validate`.
#[derive(Args, Debug)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Validate {
    #[command(subcommand)]
    study: Option<Study>,
    #[command(flatten)]
    cases: Cases,
}

#[derive(Args, Debug)]
struct Cases {
    /// Only cases whose name contains this.
    filter: Option<String>,
    /// Run the complete cases, which take hours, instead of the quick ones.
    #[arg(long)]
    full: bool,
    /// Write what was measured to this file too, as a page of tables in Markdown.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

/// What is studied instead of cases.
#[derive(clap::Subcommand, Debug)]
enum Study {
    /// Compare the limits that a solver predicts with those at which its runs fail; takes up to a minute. Exit code 1
    /// if a guard is silent or a run fails within its bounds.
    Stability {
        /// Solver.
        #[arg(value_parser = solvers())]
        solver: String,
        /// Use a finer search; takes many minutes.
        #[arg(long)]
        full: bool,
        #[command(flatten)]
        chosen: Chosen,
    },
}

/// What a study is narrowed down to, each list under the flag that its method gives it.
#[derive(Debug)]
struct Chosen(BTreeMap<String, Vec<String>>);

fn solvers() -> PossibleValuesParser {
    let studied = METHODS.iter().filter(|method| method.stability.is_some());
    PossibleValuesParser::new(studied.map(|method| PossibleValue::new(method.name).help(method.about)))
}

/// All choices that methods offer, with the name of the method.
fn choices() -> impl Iterator<Item = (&'static str, &'static Choice)> {
    METHODS.iter().flat_map(|method| {
        method.stability.iter().flat_map(|study| study.choices).map(|choice| (method.name, choice))
    })
}

fn effort(full: bool) -> Effort {
    if full { Effort::Full } else { Effort::Quick }
}

impl Validate {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        match self.study {
            Some(Study::Stability { solver, full, chosen: Chosen(chosen) }) => {
                let rows = stability::limits(&solver, &Request { effort: effort(full), chosen })?;
                show(common, &json!(rows), || stability::table(&rows));
                stability::verdict(&rows)
            }
            None => self.cases.execute(common),
        }
    }
}

impl Cases {
    fn execute(self, common: &Common) -> Result<(), Failure> {
        let cases = validate::find(self.filter.as_deref())?;
        // Before anything is run, which may take hours.
        self.report.as_deref().map_or(Ok(()), report::can_write)?;
        let mut rows = Vec::new();
        for case in cases {
            if !common.quiet {
                eprintln!("{}: {}", case.name, case.about);
            }
            rows.extend(case.run(effort(self.full)));
        }
        if let Some(path) = &self.report {
            let (effort, filter) = (effort(self.full), self.filter.as_deref());
            Report { effort, filter, path, rows: &rows }.write()?;
        }
        show(common, &json!(rows), || validate::table(&rows));
        validate::verdict(&rows)
    }
}

impl Args for Chosen {
    fn augment_args(command: clap::Command) -> clap::Command {
        command.args(choices().map(|(method, choice)| {
            let about = format!("{} of `{method}`; all by default", choice.about);
            let flag = Arg::new(choice.flag).long(choice.flag).help(about).value_name("LIST");
            let flag = flag.value_parser(PossibleValuesParser::new(choice.names)).value_delimiter(',');
            flag.action(clap::ArgAction::Append)
        }))
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Chosen {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let of = |flag: &str| matches.get_many(flag).into_iter().flatten().cloned().collect();
        Ok(Self(choices().map(|(_, choice)| (choice.flag.to_owned(), of(choice.flag))).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
