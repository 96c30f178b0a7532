//! Validation: cases with known answers, and how near this program comes.
//!
//! A [`Case`] gives [`Row`]s, each a measured number beside its reference. A row that gates must
//! pass; one that does not is a claim of the literature, printed with its verdict and the reason
//! for a difference. Sources, set-ups and weaknesses are in `validation/<case>/README.md`.
//!
//! ```
//! use granular_studies::validate::{Effort, find};
//! let rows = find(Some("grading"))?[0].run(Effort::Quick);
//! assert!(rows.iter().all(|row| row.pass));
//! # Ok::<(), granular_driver::failure::Failure>(())
//! ```

mod boundaries;
mod claims;
mod coarse;
pub(crate) mod collapse;
mod conservation;
pub(crate) mod fluid;
mod frames;
mod grading;
pub(crate) mod hertz;
pub(crate) mod impact;
mod incline;
mod lattices;
mod laws;
mod oblique;
mod packing;
mod packing_density;
mod plane;
mod recorded;
pub(crate) mod reference;
pub(crate) mod restitution;
mod rolling;
mod row;
mod shear;
mod slope_impact;
pub mod stability;
mod stages;
pub(crate) mod strike;
mod studies;
mod table;
mod tessellation;

pub use row::{Row, Tier};
pub use table::table;

pub use granular_driver::Effort;
use granular_driver::failure::Failure;
use granular_driver::problems::nearest;
use row::{Measure, Rows};

/// A validation case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name, also that of its folder in `validation/`.
    pub name: &'static str,
    /// What it shows, in a line.
    pub about: &'static str,
    run: fn(&mut Rows, Effort) -> Result<(), Failure>,
}

/// All cases.
pub const CASES: &[Case] = &[
    Case { name: "disk_on_incline", about: "a disk slips or rolls down 45 degrees", run: incline::disk },
    Case { name: "ball_on_incline", about: "a sphere slips or rolls down 45 degrees", run: incline::sphere },
    Case {
        name: "restitution",
        about: "restitution for both treatments of tension",
        run: restitution::error,
    },
    Case { name: "contact_time", about: "contact time and largest overlap", run: restitution::contact },
    Case { name: "hertz_impact", about: "impacts of elastic grains and their order", run: hertz::impact },
    Case { name: "chung_ooi", about: "benchmark impacts 1 to 4 and 7", run: hertz::chung_ooi },
    Case { name: "oblique_impact", about: "gross sliding and sticking on a plane", run: oblique::run },
    Case { name: "sliding_to_rolling", about: "when and how fast a ball rolls", run: rolling::run },
    Case { name: "bouncing_ball", about: "heights of a bouncing ball", run: rolling::bounces },
    Case { name: "momentum", about: "momentum of free collisions", run: conservation::momentum },
    Case { name: "sample_densities", about: "samples of a wanted density", run: packing::densities },
    Case { name: "grading", about: "sizes follow the beta curve", run: grading::run },
    Case {
        name: "wall_forces",
        about: "stress of contacts and forces on walls",
        run: boundaries::wall_forces,
    },
    Case { name: "moving_walls", about: "pistons, belts, lids under a force", run: boundaries::moving_walls },
    Case { name: "flat_surface", about: "a flat strip of parts is a plane", run: boundaries::flat_surface },
    Case { name: "energy_balance", about: "energy balance of a collapse", run: conservation::energy },
    Case { name: "tessellation", about: "cells of weighted Voronoi diagrams", run: tessellation::run },
    Case {
        name: "packing_density",
        about: "density of the bulk from Voronoi cells, over the threshold of the free surface",
        run: packing_density::run,
    },
    Case { name: "coarse_graining", about: "continuum fields from grains", run: coarse::run },
    Case { name: "regular_packings", about: "strength of lattices of grains", run: lattices::strength },
    Case { name: "lattice_moduli", about: "elastic moduli of lattices of grains", run: lattices::moduli },
    Case { name: "chain_waves", about: "waves on a chain of grains", run: lattices::waves },
    Case { name: "periodic_cell", about: "shifts of a periodic cell, and its stress", run: frames::shifts },
    Case { name: "rotating_frame", about: "a turned and a turning frame", run: frames::rotation },
    Case { name: "critical_state", about: "shear of the grains of the thesis", run: shear::run },
    Case {
        name: "poiseuille",
        about: "flow between plates, steady and started",
        run: fluid::channel::poiseuille,
    },
    Case { name: "couette", about: "a plate starts to move", run: fluid::channel::couette },
    Case { name: "womersley", about: "oscillating flow between plates", run: fluid::channel::womersley },
    Case {
        name: "taylor_green",
        about: "decaying vortices: viscosity and order",
        run: fluid::decay::taylor_green,
    },
    Case { name: "cavity", about: "a cavity under a moving lid", run: fluid::cavity::run },
    Case { name: "cylinder", about: "drag and lift of a cylinder in a channel", run: fluid::cylinder::run },
    Case { name: "wall_in_channel", about: "the stream turns back behind a wall", run: fluid::wall::run },
    Case { name: "vortex_street", about: "Strouhal numbers of a disk and a square", run: fluid::street::run },
    Case { name: "square_array", about: "drag of a square array of disks", run: fluid::bodies::square_array },
    Case {
        name: "disk_in_channel",
        about: "drag of a disk in a channel",
        run: fluid::bodies::disk_in_channel,
    },
    Case { name: "carried_disk", about: "a disk carried by a stream", run: fluid::bodies::carried_disk },
    Case { name: "fluid_mass", about: "mass of a fluid between walls", run: fluid::balance::mass },
    Case { name: "hydrostatic", about: "a fluid at rest under gravity", run: fluid::balance::hydrostatic },
    Case {
        name: "slope_impact",
        about: "a pile is pushed: energy, momentum, run-out, decay",
        run: slope_impact::run,
    },
    Case { name: "column_runout", about: "run-out of a column of aspect ratio 0.8", run: claims::run_out },
    Case {
        name: "column_studies",
        about: "columns over their aspect ratio: run-out, height, flow, energies",
        run: studies::run,
    },
    Case { name: "column_density", about: "dense and loose columns", run: studies::density },
];

impl Case {
    /// Runs the case. A solver that gives up is a row that fails.
    pub fn run(&self, effort: Effort) -> Vec<Row> {
        let mut rows = Rows::new(self.name);
        if let Err(failure) = (self.run)(&mut rows, effort) {
            let stopped = Measure::absolute(Tier::Identity, "the case runs to its end", f64::NAN, 0.0, 0.0);
            rows.add(stopped.note(failure.to_string()));
        }
        rows.finish()
    }
}

/// The cases whose name contains `filter`; all without one.
///
/// # Errors
/// When there is none.
pub fn find(filter: Option<&str>) -> Result<Vec<Case>, Failure> {
    let wanted = filter.unwrap_or_default();
    let found: Vec<Case> = CASES.iter().copied().filter(|case| case.name.contains(wanted)).collect();
    if found.is_empty() {
        let names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
        let known = names.join(", ");
        let hint = nearest(wanted, names);
        let hint = if hint.is_empty() { hint } else { format!("{hint} ") };
        return Err(Failure::Io(format!("no validation case is called `{wanted}`; {hint}known: {known}")));
    }
    Ok(found)
}

/// What a run of cases comes to.
///
/// # Errors
/// When a gating row failed.
pub fn verdict(rows: &[Row]) -> Result<(), Failure> {
    let failed: Vec<String> = rows
        .iter()
        .filter(|row| row.gate && !row.pass)
        .map(|row| format!("{}: {}", row.case, row.metric))
        .collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::Invalid(format!("{} of {} rows failed: {}", failed.len(), rows.len(), failed.join("; "))))
}
