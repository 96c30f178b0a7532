//! Benchmarks: error against run time, and speed.
//!
//! [`precision`] studies measure how the error of a case falls with what a run costs; they give a
//! [`Study`] with its Pareto front and fitted orders. [`speed`] measures how many grain-steps a
//! second grains take, [`lattice`] how many cell updates a fluid, [`tessellate`] how many cells of Voronoi diagrams;
//! [`operators`] puts collision operators side by side.

mod cells;
mod column;
mod figure;
mod flows;
mod hertz;
pub mod lattice;
pub mod operators;
mod restitution;
mod settling;
pub mod speed;
mod state;
mod study;
pub mod tessellate;
mod triad;

pub use study::{Point, Study};

use granular_driver::failure::Failure;
use std::path::Path;

/// A work-precision study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Precision {
    /// Restitution of a normal impact over the step, for both treatments of tension.
    Restitution,
    /// The same for elastic disks and spheres with damping.
    Hertz,
    /// Run-out of a column over stiffness and step, as a mean over seeds; takes minutes.
    Column,
    /// Areas of Voronoi cells: a raster, exact cells, an estimate from a grid; takes seconds.
    Cells,
    /// Decaying vortices over cells, Mach number, operator and storage; takes a minute.
    TaylorGreen,
    /// Lid-driven cavity over the same; takes one to two minutes.
    Cavity,
    /// Unsteady cylinder of Schaefer and Turek over the same; takes five to eight minutes on two cores.
    SchaeferTurek,
}

/// Runs a study.
///
/// # Errors
/// When a run fails.
pub fn precision(case: Precision) -> Result<Study, Failure> {
    match case {
        Precision::Restitution => restitution::study(),
        Precision::Hertz => hertz::study(),
        Precision::Column => column::study(),
        Precision::Cells => cells::study(),
        Precision::TaylorGreen => flows::taylor_green(),
        Precision::Cavity => flows::cavity(),
        Precision::SchaeferTurek => flows::schaefer_turek(),
    }
}

/// Writes `points.csv`, `precision.svg` and `precision.png` of a study to a folder.
///
/// # Errors
/// When something cannot be written.
pub fn save(study: &Study, folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::io(folder.display(), error))?;
    figure::chart(study).figure().save(&folder.join("precision"))?;
    let csv = study.csv();
    granular_io::write_atomically(&folder.join("points.csv"), |file| file.write_all(csv.as_bytes()))?;
    Ok(())
}
