//! `granular validate`.

use super::{Common, show};
use clap::builder::PossibleValuesParser;
use granular_driver::failure::Failure;
use granular_studies::validate::{self, Effort, stability};
use serde_json::json;

/// Flags of `granular validate`.
#[derive(clap::Args, Debug)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Validate {
    #[command(subcommand)]
    study: Option<Study>,
    #[command(flatten)]
    cases: Cases,
}

#[derive(clap::Args, Debug)]
struct Cases {
    /// Only cases whose name contains this.
    filter: Option<String>,
    /// Run the complete cases, which take hours, instead of the quick ones.
    #[arg(long)]
    full: bool,
}

/// What is studied instead of cases.
#[derive(clap::Subcommand, Debug)]
enum Study {
    /// Compare the limits that a solver predicts with those at which its runs fail; takes up to a minute. Exit code 1
    /// if a guard is silent or a run fails within its bounds.
    Stability {
        /// Solver.
        solver: Solver,
        /// Use a finer search; takes many minutes.
        #[arg(long)]
        full: bool,
        /// Collision operators of `lbm`; all by default.
        #[arg(long, value_delimiter = ',', value_name = "LIST", value_parser = operators())]
        operator: Vec<String>,
        /// Flows of `lbm`; all by default.
        #[arg(long, value_delimiter = ',', value_name = "LIST", value_parser = flows())]
        flow: Vec<String>,
    },
}

/// Solvers whose limits are studied.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Solver {
    /// Discrete element method.
    Dem,
    /// Lattice Boltzmann method.
    Lbm,
}

fn operators() -> PossibleValuesParser {
    PossibleValuesParser::new(stability::OPERATORS.map(|(name, _)| name))
}

fn flows() -> PossibleValuesParser {
    PossibleValuesParser::new(stability::FLOWS)
}

fn effort(full: bool) -> Effort {
    if full { Effort::Full } else { Effort::Quick }
}

impl Validate {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        if let Some(Study::Stability { solver, full, operator, flow }) = self.study {
            let request = stability::Request { effort: effort(full), operators: operator, flows: flow };
            let rows = limits(solver, &request)?;
            show(common, &json!(rows), || stability::table(&rows));
            return stability::verdict(&rows);
        }
        let mut rows = Vec::new();
        for case in validate::find(self.cases.filter.as_deref())? {
            if !common.quiet {
                eprintln!("{}: {}", case.name, case.about);
            }
            rows.extend(case.run(effort(self.cases.full)));
        }
        show(common, &json!(rows), || validate::table(&rows));
        validate::verdict(&rows)
    }
}

fn limits(solver: Solver, request: &stability::Request) -> Result<Vec<stability::Row>, Failure> {
    match solver {
        Solver::Lbm => stability::lbm(request),
        Solver::Dem if request.operators.is_empty() && request.flows.is_empty() => {
            stability::dem(request.effort)
        }
        Solver::Dem => {
            Err(Failure::Io("--operator and --flow are of `lbm`; leave them out for `dem`".to_owned()))
        }
    }
}
