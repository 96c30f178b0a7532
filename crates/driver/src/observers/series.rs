//! A table that grows look by look, and goes on where it was after a restart.

use crate::failure::Failure;
use granular_core::{ObserverError, Section, Simulation, SnapshotError};
use granular_io::TableWriter;
use std::path::PathBuf;

/// A table file, its columns by name and unit, and the step of the last look.
pub(super) struct Series {
    path: PathBuf,
    columns: Vec<(String, String)>,
    /// None until a run that goes on has said where.
    writer: Option<TableWriter>,
    last_step: Option<u64>,
}

impl Series {
    /// A `fresh` file, or one that [`Series::restore`] will open again.
    pub(super) fn new(path: PathBuf, columns: Vec<(String, String)>, fresh: bool) -> Result<Self, Failure> {
        let mut series = Self { path, columns, writer: None, last_step: None };
        if fresh {
            series.writer = Some(TableWriter::create(&series.path, &series.header())?);
        }
        Ok(series)
    }

    fn header(&self) -> Vec<(&str, &str)> {
        self.columns.iter().map(|(name, unit)| (name.as_str(), unit.as_str())).collect()
    }

    pub(super) fn row(&mut self, values: &[f64]) -> Result<(), ObserverError> {
        if let Some(writer) = &mut self.writer {
            writer.row(values)?;
        }
        Ok(())
    }

    /// Notes that the present step was looked at.
    pub(super) fn looked_at(&mut self, simulation: &Simulation) {
        self.last_step = Some(simulation.clock().step());
    }

    /// Whether the present step was not looked at yet.
    pub(super) fn lacks(&self, simulation: &Simulation) -> bool {
        self.last_step != Some(simulation.clock().step())
    }

    pub(super) fn sync(&mut self) -> Result<(), ObserverError> {
        if let Some(writer) = &mut self.writer {
            writer.sync()?;
        }
        Ok(())
    }

    pub(super) fn save(&self, to: &mut Section) {
        to.put_one("bytes", self.writer.as_ref().map_or(0, TableWriter::position));
        to.put_one("last step", self.last_step.unwrap_or(u64::MAX));
    }

    pub(super) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let bytes: u64 = from.one("bytes")?;
        self.last_step = Some(from.one("last step")?).filter(|&step| step != u64::MAX);
        self.writer = Some(TableWriter::reopen_at(&self.path, &self.header(), bytes)?);
        Ok(())
    }
}
