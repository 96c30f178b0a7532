//! `granular bench`.

use super::{Common, show};
use clap::{Args, Subcommand, ValueEnum};
use granular_driver::failure::Failure;
use granular_driver::machine;
use granular_studies::bench::{self, Precision, lattice, operators, speed, tessellate};
use serde_json::json;
use std::path::{Path, PathBuf};

/// What `granular bench` measures.
#[derive(Subcommand, Debug)]
pub(super) enum Bench {
    /// Error against run time, as a table and a figure.
    Precision {
        /// Study.
        case: Precision,
        /// Folder for the figure and the points; `bench/<case>` by default.
        #[arg(short, long, value_name = "FOLDER")]
        out: Option<PathBuf>,
    },
    /// Collision operators side by side: walls, pores, free flow, moving frames, cost; takes a minute.
    Operators,
    /// Steps per second over sizes and threads.
    Speed {
        /// Solver.
        solver: Solver,
        #[command(flatten)]
        flags: Speed,
    },
}

/// Solvers.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Solver {
    /// Discrete element method.
    Dem,
    /// Lattice Boltzmann method; takes 2 GB of memory.
    Lbm,
    /// Weighted Voronoi diagrams, on one thread; takes half a minute.
    Tessellate,
}

#[derive(Args, Debug)]
#[group(id = "speed flags")]
pub(super) struct Speed {
    /// Numbers of disks in a collapsing column.
    #[arg(long, num_args = 0.., value_delimiter = ',', default_value = "3000,13000,100000", value_name = "LIST")]
    disks: Vec<usize>,
    /// Numbers of spheres that settle in a box.
    #[arg(long, num_args = 0.., value_delimiter = ',', default_value = "50000", value_name = "LIST")]
    spheres: Vec<usize>,
    /// Numbers of sites of a tessellation.
    #[arg(long, value_delimiter = ',', default_value = "1000,10000,100000,1000000", value_name = "LIST")]
    sites: Vec<usize>,
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

impl Bench {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        match self {
            Self::Precision { case, out } => {
                let study = bench::precision(case)?;
                let folder = out.unwrap_or_else(|| Path::new("bench").join(study.case));
                bench::save(&study, &folder)?;
                let files = format!("  figure: {0}.svg, {0}.png\n", folder.join("precision").display());
                show(common, &json!(study), || format!("{study}{files}"));
            }
            Self::Operators => {
                let found = operators::operators()?;
                show(common, &json!(found), || found.to_string());
            }
            Self::Speed { solver, flags } => {
                flags.refuse_many()?;
                let Speed { disks, spheres, sites, pools: threads, repeats, state, write_state } = flags;
                let speeds = match solver {
                    Solver::Tessellate => {
                        let rates = tessellate::tessellate(&sites, repeats)?;
                        show(common, &json!(rates), || tessellate::table(&rates));
                        return Ok(());
                    }
                    Solver::Dem => {
                        speed::dem(&speed::Request { disks, spheres, threads, repeats, state, write_state })?
                    }
                    Solver::Lbm => lattice::lbm(&lattice::Request { threads, repeats })?,
                };
                show(common, &json!(speeds), || speed::table(&speeds));
            }
        }
        Ok(())
    }
}

impl Speed {
    /// Refuses what this machine has neither memory nor cores for.
    fn refuse_many(&self) -> Result<(), Failure> {
        let counts = [
            ("--disks", &self.disks, 700.0),
            ("--spheres", &self.spheres, 1100.0),
            ("--sites", &self.sites, 500.0),
        ];
        for (flag, list, bytes) in counts {
            let largest = list.iter().copied().max().unwrap_or(0);
            machine::room_for(largest as f64, bytes)
                .map_err(|allowed| Failure::io(flag, format!("{largest}; allowed: {allowed}")))?;
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
