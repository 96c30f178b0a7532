//! Benchmarks: error against run time, and speed.
//!
//! A [`Precision`] study measures how the error of a case falls with what a run costs; it gives a [`Study`] with its Pareto
//! front and fitted orders. [`speed`] measures how many steps of grains, cell updates or Voronoi cells a second brings. A
//! [`Comparison`] puts variants of a method side by side. All belong to [methods](crate::METHODS).

mod figure;
pub mod speed;
pub(crate) mod study;
pub(crate) mod triad;

pub use speed::Throughput;
pub use study::{Point, Study};

use crate::METHODS;
use granular_driver::failure::Failure;
use serde::Serialize;
use serde_json::{Value, json};
use std::path::Path;

/// A work-precision study.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// Name.
    pub name: &'static str,
    /// What is measured, and how long it takes where that is long.
    pub about: &'static str,
    pub(crate) run: fn() -> Result<Study, Failure>,
}

/// Variants of a method side by side.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    /// Name.
    pub name: &'static str,
    /// What is compared, and how long it takes.
    pub about: &'static str,
    pub(crate) run: fn() -> Result<Printed, Failure>,
}

/// What a bench found.
#[derive(Clone, Debug, PartialEq)]
pub struct Printed {
    /// For programs.
    pub json: Value,
    /// For people.
    pub text: String,
}

impl Printed {
    pub(crate) fn new(found: &impl Serialize, text: String) -> Self {
        Self { json: json!(found), text }
    }
}

/// All studies of precision.
pub fn precision() -> impl Iterator<Item = &'static Precision> {
    METHODS.iter().flat_map(|method| method.precision)
}

/// All comparisons.
pub fn comparisons() -> impl Iterator<Item = &'static Comparison> {
    METHODS.iter().flat_map(|method| method.comparisons)
}

impl Precision {
    /// Runs the study.
    ///
    /// # Errors
    /// When a run fails.
    pub fn run(&self) -> Result<Study, Failure> {
        (self.run)()
    }
}

impl Comparison {
    /// Runs the comparison.
    ///
    /// # Errors
    /// When a run fails.
    pub fn run(&self) -> Result<Printed, Failure> {
        (self.run)()
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
