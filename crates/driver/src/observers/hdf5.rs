//! One temporal `.vtkhdf` file.

use super::source::Source;
use super::{Failure, Flow, Observer, ObserverError, Section, Simulation, SnapshotError};
use granular_core::Location;
use granular_io::{Frame, IoError, VtkHdfGrid, VtkHdfPoints};
use std::path::{Path, PathBuf};

/// The file, of points or of a grid.
enum File {
    Points(VtkHdfPoints),
    Grid(VtkHdfGrid),
}

impl File {
    fn steps(&self) -> usize {
        match self {
            Self::Points(file) => file.steps(),
            Self::Grid(file) => file.steps(),
        }
    }

    fn append(&mut self, location: &Location<'_>, frame: &Frame, time: f64) -> Result<(), IoError> {
        match self {
            Self::Points(file) => file.append(location, frame, time),
            Self::Grid(file) => file.append(frame, time),
        }
    }
}

pub(super) struct Hdf5Observer {
    path: PathBuf,
    source: Source,
    fields: Vec<String>,
    /// The grid on which the fields are; none for points, which move.
    grid: Option<Location<'static>>,
    file: Option<File>,
}

impl Hdf5Observer {
    pub(super) fn new(
        stem: &Path,
        source: Source,
        fields: &[String],
        simulation: &Simulation,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let grid = match source.location(simulation) {
            Location::Grid { origin, spacing, cells } => Some(Location::Grid { origin, spacing, cells }),
            Location::Points(_) => None,
        };
        // The name may hold a dot.
        let mut path = stem.as_os_str().to_owned();
        path.push(".vtkhdf");
        let path = PathBuf::from(path);
        let file = match &grid {
            _ if !fresh => None,
            Some(grid) => Some(File::Grid(VtkHdfGrid::create(&path, grid)?)),
            None => Some(File::Points(VtkHdfPoints::create(&path)?)),
        };
        Ok(Self { path, source, fields: fields.to_vec(), grid, file })
    }
}

impl Observer for Hdf5Observer {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let frame = self.source.frame(&self.fields, simulation);
        if let Some(file) = &mut self.file {
            file.append(&self.source.location(simulation), &frame, simulation.clock().time())?;
        }
        Ok(Flow::Continue)
    }

    fn save(&self, to: &mut Section) {
        to.put_one("steps", self.file.as_ref().map_or(0, File::steps) as u64);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let steps = from.one::<u64>("steps")? as usize;
        self.file = Some(match &self.grid {
            Some(grid) => File::Grid(VtkHdfGrid::reopen_at(&self.path, grid, steps)?),
            None => File::Points(VtkHdfPoints::reopen_at(&self.path, steps)?),
        });
        Ok(())
    }
}
