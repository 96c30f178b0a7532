//! `granular bench`.

use super::{Common, show};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgMatches, Args, FromArgMatches, Subcommand, value_parser};
use granular_driver::failure::Failure;
use granular_driver::machine;
use granular_studies::METHODS;
use granular_studies::bench::{self, Printed, speed};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What `granular bench` measures.
#[derive(Subcommand, Debug)]
pub(super) enum Bench {
    /// Error against run time, as a table and a figure.
    Precision {
        /// Study.
        #[arg(value_parser = studies())]
        case: String,
        /// Folder for the figure and the points; `bench/<case>` by default.
        #[arg(short, long, value_name = "FOLDER")]
        out: Option<PathBuf>,
    },
    #[command(flatten)]
    Compare(Comparison),
    /// Steps per second over sizes and threads.
    Speed {
        /// Solver.
        #[arg(value_parser = solvers())]
        solver: String,
        #[command(flatten)]
        flags: Speed,
    },
}

/// One of the comparisons that methods bring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparison(bench::Comparison);

#[derive(Args, Debug)]
#[group(id = "speed flags")]
pub(super) struct Speed {
    #[command(flatten)]
    sizes: Sizes,
    /// Numbers of threads; each has its own pool.
    #[arg(long, value_delimiter = ',', default_value = "1,2", value_name = "LIST")]
    pools: Vec<usize>,
    /// Windows of one second; the median is shown.
    #[arg(long, default_value_t = 3, value_name = "N")]
    repeats: usize,
    /// Measure with the state in this file, which has rows `x y vx vy omega r` or `x y r` for disks, and
    /// `x y z vx vy vz wx wy wz r` or `x y z r` for spheres.
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Write the states that were measured to this folder.
    #[arg(long, value_name = "FOLDER")]
    write_state: Option<PathBuf>,
}

/// Lists of sizes, each under the flag that its method gives it.
#[derive(Debug)]
struct Sizes(BTreeMap<String, Vec<usize>>);

fn studies() -> PossibleValuesParser {
    PossibleValuesParser::new(
        bench::precision().map(|study| PossibleValue::new(study.name).help(study.about)),
    )
}

fn solvers() -> PossibleValuesParser {
    let timed = METHODS
        .iter()
        .filter_map(|method| method.speed.map(|speed| PossibleValue::new(method.name).help(speed.about)));
    PossibleValuesParser::new(timed)
}

impl Bench {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let Printed { json, text } = match self {
            Self::Precision { case, out } => precision(&case, out)?,
            Self::Compare(Comparison(comparison)) => comparison.run()?,
            Self::Speed { solver, flags } => {
                flags.refuse_many()?;
                let Speed { sizes: Sizes(sizes), pools: threads, repeats, state, write_state } = flags;
                let request = speed::Request { sizes, threads, repeats, state, write_state };
                speed::measure(&solver, &request)?
            }
        };
        show(common, &json, || text);
        Ok(())
    }
}

/// Runs a study of precision and writes its figure and points.
fn precision(case: &str, out: Option<PathBuf>) -> Result<Printed, Failure> {
    let study = bench::precision().find(|study| study.name == case);
    let study = study.expect("the parser lets the names of studies pass").run()?;
    let folder = out.unwrap_or_else(|| Path::new("bench").join(study.case));
    bench::save(&study, &folder)?;
    let files = format!("  figure: {0}.svg, {0}.png\n", folder.join("precision").display());
    Ok(Printed { json: json!(study), text: format!("{study}{files}") })
}

impl Speed {
    /// Refuses what this machine has neither memory nor cores for.
    fn refuse_many(&self) -> Result<(), Failure> {
        for sizes in speed::sizes() {
            let largest = self.sizes.0[sizes.flag].iter().copied().max().unwrap_or(0);
            machine::room_for(largest as f64, sizes.bytes).map_err(|allowed| {
                Failure::io(format!("--{}", sizes.flag), format!("{largest}; allowed: {allowed}"))
            })?;
        }
        let most = machine::most_threads();
        match self.pools.iter().find(|&&threads| threads > most) {
            Some(threads) => {
                Err(Failure::io("--pools", format!("{threads}; allowed: at most {most} on this machine")))
            }
            None => Ok(()),
        }
    }
}

impl Args for Sizes {
    fn augment_args(mut command: clap::Command) -> clap::Command {
        for speed in METHODS.iter().filter_map(|method| method.speed) {
            // Of several scenes some may be left out, by an empty list.
            let may_be_empty = speed.sizes.len() > 1;
            for sizes in speed.sizes {
                let flag = Arg::new(sizes.flag).long(sizes.flag).help(sizes.about).value_name("LIST");
                let flag = flag.value_parser(value_parser!(usize)).value_delimiter(',');
                let flag = if may_be_empty { flag.num_args(0..) } else { flag };
                command = command.arg(flag.action(clap::ArgAction::Append).default_value(sizes.default));
            }
        }
        command
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Sizes {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let of = |flag: &str| matches.get_many(flag).into_iter().flatten().copied().collect();
        Ok(Self(speed::sizes().map(|sizes| (sizes.flag.to_owned(), of(sizes.flag))).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Subcommand for Comparison {
    fn augment_subcommands(command: clap::Command) -> clap::Command {
        command.subcommands(bench::comparisons().map(|one| clap::Command::new(one.name).about(one.about)))
    }

    fn augment_subcommands_for_update(command: clap::Command) -> clap::Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        bench::comparisons().any(|one| one.name == name)
    }
}

impl FromArgMatches for Comparison {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let found = bench::comparisons().find(|one| Some(one.name) == matches.subcommand_name());
        let missing = || clap::Error::new(clap::error::ErrorKind::MissingSubcommand);
        found.map(|one| Self(*one)).ok_or_else(missing)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
