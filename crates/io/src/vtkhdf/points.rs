//! Points over time.

use super::dataset::{append, growing, row, truncate};
use super::steps::{FieldArrays, NumberArrays, STEPS, Steps};
use crate::error::IoError;
use crate::frame::{Frame, coordinates};
use granular_core::Location;
use hdf5::{Dataset, Result};
use std::path::{Path, PathBuf};

/// Rows of points in a chunk.
const ROWS: usize = 4096;
/// The groups of cells that the format asks for; only the first is used.
const CELLS: [&str; 4] = ["Vertices", "Lines", "Polygons", "Strips"];
const GROUPS: [&str; 2] = ["PointData", "PointDataOffsets"];

/// Writes points with their fields, frame after frame, into one file.
///
/// ```
/// # fn main() -> Result<(), granular_io::IoError> {
/// use granular_core::{FieldRef, FieldSink, Location, glam::DVec2};
/// # let path = std::env::temp_dir().join(format!("doc-{}.vtkhdf", std::process::id()));
/// let mut writer = granular_io::VtkHdfPoints::create(&path)?;
/// let mut frame = granular_io::Frame::wanting(["radius"]);
/// frame.field("radius", "m", FieldRef::Scalar(&[1e-3]));
/// writer.append(&Location::Points(FieldRef::Vector2(&[DVec2::ZERO])), &frame, 0.0)?;
/// assert_eq!(writer.steps(), 1);
/// # std::fs::remove_file(path).ok();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct VtkHdfPoints {
    path: PathBuf,
    steps: Steps,
    layout: Option<Layout>,
}

#[derive(Debug)]
struct Layout {
    points: Dataset,
    counts: Dataset,
    part_offsets: Dataset,
    part_counts: Dataset,
    point_offsets: Dataset,
    cell_offsets: Dataset,
    id_offsets: Dataset,
    /// Number of cells, number of ids, offsets, ids of each group of cells.
    cells: Vec<[Dataset; 4]>,
    fields: FieldArrays,
    numbers: NumberArrays,
}

impl VtkHdfPoints {
    /// Starts a file; an old file of this path is replaced.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, IoError> {
        let steps = Steps::create(path, b"PolyData").map_err(IoError::on("create", path))?;
        Ok(Self { path: path.to_path_buf(), steps, layout: None })
    }

    /// Opens a file that was written here and keeps its first `steps` frames, as at the time of a
    /// snapshot.
    ///
    /// # Errors
    /// When the file cannot be opened, is not of this kind, or has fewer frames.
    pub fn reopen_at(path: &Path, steps: usize) -> Result<Self, IoError> {
        if steps == 0 && hdf5::File::open(path).is_ok() {
            return Self::create(path);
        }
        let fail = IoError::on("reopen", path);
        let steps = Steps::reopen(path, steps).map_err(&fail)?;
        let layout = Some(Layout::reopen(&steps).map_err(&fail)?);
        Ok(Self { path: path.to_path_buf(), steps, layout })
    }

    /// Number of frames, for [`VtkHdfPoints::reopen_at`].
    pub fn steps(&self) -> usize {
        self.steps.done()
    }

    /// Appends a frame at a time \[s\].
    ///
    /// # Errors
    /// When `location` is a grid, a field does not have one value per point, the frame has other
    /// fields than the first, or the file cannot be written. What was written by then does not
    /// count; the file must be reopened before the next frame.
    pub fn append(&mut self, location: &Location<'_>, frame: &Frame, time: f64) -> Result<(), IoError> {
        let points = coordinates(&self.path, location)?;
        Frame::check(&self.path, frame.fields(), points.len(), "points")?;
        self.append_points(&points, frame, time).map_err(IoError::on("write", &self.path))
    }

    fn append_points(&mut self, points: &[[f64; 3]], frame: &Frame, time: f64) -> Result<()> {
        if self.layout.is_none() {
            self.layout = Some(Layout::create(&self.steps, frame)?);
        }
        let layout = self.layout.as_ref().expect("it was made above");
        layout.fields.check(frame.fields())?;
        self.steps.begin()?;
        layout.append(points, frame, self.steps.done() as i64)?;
        self.steps.commit(time)
    }
}

impl Layout {
    fn create(steps: &Steps, frame: &Frame) -> Result<Self> {
        let (root, group) = (&steps.root, &steps.group);
        let cells = CELLS.map(|name| {
            let cells = root.create_group(name)?;
            Ok([
                growing::<i64>(&cells, "NumberOfCells", &[], STEPS)?,
                growing::<i64>(&cells, "NumberOfConnectivityIds", &[], STEPS)?,
                growing::<i64>(&cells, "Offsets", &[], ROWS)?,
                growing::<i64>(&cells, "Connectivity", &[], ROWS)?,
            ])
        });
        Ok(Self {
            points: growing::<f64>(root, "Points", &[3], ROWS)?,
            counts: growing::<i64>(root, "NumberOfPoints", &[], STEPS)?,
            part_offsets: growing::<i64>(group, "PartOffsets", &[], STEPS)?,
            part_counts: growing::<i64>(group, "NumberOfParts", &[], STEPS)?,
            point_offsets: growing::<i64>(group, "PointOffsets", &[], STEPS)?,
            cell_offsets: growing::<i64>(group, "CellOffsets", &[4], STEPS)?,
            id_offsets: growing::<i64>(group, "ConnectivityIdOffsets", &[4], STEPS)?,
            cells: cells.into_iter().collect::<Result<_>>()?,
            fields: FieldArrays::create(steps, GROUPS, frame.fields(), &[], ROWS)?,
            numbers: NumberArrays::create(steps, frame.numbers())?,
        })
    }

    /// Opens all arrays and cuts them to where the last step that counts ends. A crash may have
    /// left rows beyond that even when no step is dropped.
    fn reopen(steps: &Steps) -> Result<Self> {
        let (root, group, last) = (&steps.root, &steps.group, steps.done() - 1);
        let cells = CELLS.map(|name| {
            let cells = root.group(name)?;
            Ok([
                cells.dataset("NumberOfCells")?,
                cells.dataset("NumberOfConnectivityIds")?,
                cells.dataset("Offsets")?,
                cells.dataset("Connectivity")?,
            ])
        });
        let (counts, point_offsets) = (root.dataset("NumberOfPoints")?, group.dataset("PointOffsets")?);
        let rows = (row(&point_offsets, last)?[0] + row(&counts, last)?[0]) as usize;
        let layout = Self {
            points: root.dataset("Points")?,
            counts,
            part_offsets: group.dataset("PartOffsets")?,
            part_counts: group.dataset("NumberOfParts")?,
            point_offsets,
            cell_offsets: group.dataset("CellOffsets")?,
            id_offsets: group.dataset("ConnectivityIdOffsets")?,
            cells: cells.into_iter().collect::<Result<_>>()?,
            fields: FieldArrays::reopen(steps, GROUPS, rows)?,
            numbers: NumberArrays::reopen(steps)?,
        };
        layout.cut(steps.done(), rows)?;
        Ok(layout)
    }

    fn cut(&self, steps: usize, rows: usize) -> Result<()> {
        let last = steps - 1;
        truncate(&self.points, rows)?;
        let (cell_offsets, id_offsets) = (row(&self.cell_offsets, last)?, row(&self.id_offsets, last)?);
        for (k, [cells, ids, offsets, connectivity]) in self.cells.iter().enumerate() {
            // Offsets have one row more than cells in each part.
            let ends = cell_offsets[k] + row(cells, last)?[0] + steps as i64;
            truncate(offsets, ends as usize)?;
            truncate(connectivity, (id_offsets[k] + row(ids, last)?[0]) as usize)?;
            truncate(cells, steps)?;
            truncate(ids, steps)?;
        }
        let per_step = [&self.counts, &self.part_offsets, &self.part_counts, &self.point_offsets];
        per_step
            .into_iter()
            .chain([&self.cell_offsets, &self.id_offsets])
            .try_for_each(|d| truncate(d, steps))
    }

    fn append(&self, points: &[[f64; 3]], frame: &Frame, part: i64) -> Result<()> {
        let n = points.len() as i64;
        let start = append(&self.points, points.as_flattened())?;
        self.fields.append(frame.fields(), start)?;
        let offsets: Vec<i64> = (0..=n).collect();
        let (mut cell_offsets, mut id_offsets) = ([0; 4], [0; 4]);
        for (k, [cells, ids, ends, connectivity]) in self.cells.iter().enumerate() {
            let n = if k == 0 { n } else { 0 };
            cell_offsets[k] = append(ends, &offsets[..=n as usize])? - part;
            id_offsets[k] = append(connectivity, &offsets[..n as usize])?;
            append(cells, &[n])?;
            append(ids, &[n])?;
        }
        append(&self.counts, &[n])?;
        append(&self.part_offsets, &[part])?;
        append(&self.part_counts, &[1_i64])?;
        append(&self.point_offsets, &[start])?;
        append(&self.cell_offsets, &cell_offsets)?;
        append(&self.id_offsets, &id_offsets)?;
        self.numbers.append(frame)
    }
}
