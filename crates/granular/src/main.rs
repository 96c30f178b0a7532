//! The `granular` command.

mod command;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Some(commit) = option_env!("GRANULAR_COMMIT") {
        granular_driver::folder::set_commit(commit);
    }
    command::Command::parse().execute()
}
