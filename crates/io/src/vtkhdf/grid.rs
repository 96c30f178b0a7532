//! Cells of a regular grid over time.

use super::steps::{FieldArrays, NumberArrays, Steps};
use crate::error::IoError;
use crate::frame::{Frame, Grid};
use granular_core::Location;
use hdf5::Result;
use std::path::{Path, PathBuf};

const GROUPS: [&str; 2] = ["CellData", "CellDataOffsets"];

/// Writes the cells of a grid that does not change, frame after frame, into one file. One cell
/// along z is the plane: a flat image.
#[derive(Debug)]
pub struct VtkHdfGrid {
    path: PathBuf,
    grid: Grid,
    steps: Steps,
    arrays: Option<(FieldArrays, NumberArrays)>,
}

impl VtkHdfGrid {
    /// Starts a file for this grid; an old file of this path is replaced.
    ///
    /// # Errors
    /// When `location` is not a grid with cells or the file cannot be written.
    pub fn create(path: &Path, location: &Location<'_>) -> Result<Self, IoError> {
        let grid = Grid::of(path, location)?;
        if grid.count() == 0 {
            return Err(IoError::new("create", path, "the grid has no cells"));
        }
        let steps = Self::create_steps(path, &grid).map_err(IoError::on("create", path))?;
        Ok(Self { path: path.to_path_buf(), grid, steps, arrays: None })
    }

    fn create_steps(path: &Path, grid: &Grid) -> Result<Steps> {
        let steps = Steps::create(path, b"ImageData")?;
        let root = &steps.root;
        root.new_attr_builder().with_data(&grid.extent()).create("WholeExtent")?;
        root.new_attr_builder().with_data(&grid.origin).create("Origin")?;
        root.new_attr_builder().with_data(&grid.spacing).create("Spacing")?;
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        root.new_attr_builder().with_data(&identity).create("Direction")?;
        Ok(steps)
    }

    /// Opens a file that was written here for the same grid and keeps its first `steps` frames,
    /// as at the time of a snapshot.
    ///
    /// # Errors
    /// When the file cannot be opened, is not of this kind and grid, or has fewer frames.
    pub fn reopen_at(path: &Path, location: &Location<'_>, steps: usize) -> Result<Self, IoError> {
        if steps == 0 && hdf5::File::open(path).is_ok() {
            return Self::create(path, location);
        }
        let grid = Grid::of(path, location)?;
        let (steps, arrays) = Self::reopen(path, &grid, steps).map_err(IoError::on("reopen", path))?;
        Ok(Self { path: path.to_path_buf(), grid, steps, arrays: Some(arrays) })
    }

    fn reopen(path: &Path, grid: &Grid, steps: usize) -> Result<(Steps, (FieldArrays, NumberArrays))> {
        let root = hdf5::File::open(path)?.group("VTKHDF")?;
        let extent = root.attr("WholeExtent")?.read_raw::<i64>()?;
        let corner = root.attr("Origin")?.read_raw::<f64>()?;
        let spacing = root.attr("Spacing")?.read_raw::<f64>()?;
        drop(root);
        if extent != grid.extent() || corner != grid.origin || spacing != grid.spacing {
            return Err("it is for another grid".into());
        }
        let steps = Steps::reopen(path, steps)?;
        let fields = FieldArrays::reopen(&steps, GROUPS, steps.done())?;
        let numbers = NumberArrays::reopen(&steps)?;
        Ok((steps, (fields, numbers)))
    }

    /// Number of frames, for [`VtkHdfGrid::reopen_at`].
    pub fn steps(&self) -> usize {
        self.steps.done()
    }

    /// Appends a frame at a time \[s\].
    ///
    /// # Errors
    /// When a field does not have one value per cell, the frame has other fields than the first,
    /// or the file cannot be written. What was written by then does not count; the file must be
    /// reopened before the next frame.
    pub fn append(&mut self, frame: &Frame, time: f64) -> Result<(), IoError> {
        Frame::check(&self.path, frame.fields(), self.grid.count(), "cells")?;
        self.append_cells(frame, time).map_err(IoError::on("write", &self.path))
    }

    fn append_cells(&mut self, frame: &Frame, time: f64) -> Result<()> {
        if self.arrays.is_none() {
            let [nx, ny, nz] = self.grid.cells;
            // A flat image has no z axis: readers would take the last axis for components.
            let space = [nz, ny, nx];
            let places = if nz == 1 { &space[1..] } else { &space[..] };
            let fields = FieldArrays::create(&self.steps, GROUPS, frame.fields(), places, 1)?;
            self.arrays = Some((fields, NumberArrays::create(&self.steps, frame.numbers())?));
        }
        let (fields, numbers) = self.arrays.as_ref().expect("they were made above");
        fields.check(frame.fields())?;
        self.steps.begin()?;
        fields.append(frame.fields(), self.steps.done() as i64)?;
        numbers.append(frame)?;
        self.steps.commit(time)
    }
}
