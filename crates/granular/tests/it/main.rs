//! All tests of the command, in one binary: linking is what takes time.

// Helpers of tests may fail as tests do.
#![allow(clippy::unwrap_used)]

mod command;
mod command_bad_input;
mod command_boundaries;
mod command_coarse;
mod command_disk;
#[cfg(feature = "mpm")]
mod command_element;
mod command_empty;
mod command_figures;
mod command_files;
mod command_flow;
mod command_interrupt;
mod command_limits;
mod command_push;
mod command_report;
mod command_sample;
mod command_several;
mod command_snapshots;
mod command_stability;
mod command_stir;
mod command_sweep;
mod command_validate;
mod fuzz;
mod scenes;
mod support;
mod workspace;
