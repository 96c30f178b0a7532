//! Tracks of single grains, as rows of a table.

use super::{Failure, Flow, Observer, ObserverError, Section, Simulation, SnapshotError};
use crate::scene::Chosen;
use granular_core::{FieldRef, Location};
use granular_io::frame::Values;
use granular_io::{Frame, TableWriter};
use std::path::PathBuf;

const AXES: [&str; 3] = ["x", "y", "z"];
const ENTRIES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// One row per chosen grain and look.
pub(super) struct TracksObserver {
    path: PathBuf,
    chosen: Chosen,
    fields: Vec<String>,
    axes: usize,
    columns: Vec<(String, String)>,
    writer: Option<TableWriter>,
    last_step: Option<u64>,
}

impl TracksObserver {
    pub(super) fn new(
        path: PathBuf,
        chosen: &Chosen,
        fields: &[String],
        simulation: &Simulation,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let axes = match simulation.solver().location() {
            Location::Points(FieldRef::Vector2(_)) => 2,
            Location::Points(_) => 3,
            Location::Grid { .. } => return Err(Failure::io(path.display(), "tracks are of grains")),
        };
        let (chosen, fields) = (chosen.clone(), fields.to_vec());
        let mut observer =
            Self { path, chosen, fields, axes, columns: Vec::new(), writer: None, last_step: None };
        observer.columns = observer.head(&observer.frame(simulation));
        if fresh {
            observer.writer = Some(TableWriter::create(&observer.path, &observer.names())?);
        }
        Ok(observer)
    }

    fn frame(&self, simulation: &Simulation) -> Frame {
        let mut frame = Frame::wanting(self.fields.iter().map(String::as_str).chain(["id"]));
        simulation.solver().show(&mut frame);
        frame
    }

    /// Columns of one field: one per axis of a vector, one per entry of a tensor.
    fn parts(&self, values: &Values) -> &'static [&'static str] {
        match values {
            Values::Vector(_) => &AXES[..self.axes],
            Values::Tensor(_) if self.axes == 2 => &["xx", "yy", "xy"],
            Values::Tensor(_) => &ENTRIES,
            _ => &[],
        }
    }

    fn head(&self, frame: &Frame) -> Vec<(String, String)> {
        let own = [("time", "s"), ("id", "1"), ("x", "m"), ("y", "m"), ("z", "m")];
        let own = own.iter().take(2 + self.axes).map(|(name, unit)| ((*name).to_owned(), (*unit).to_owned()));
        let fields = self.fields.iter().filter_map(|name| frame.get(name)).flat_map(|field| {
            let parts = self.parts(&field.values);
            let single = parts.is_empty().then(|| field.name.clone());
            let names = parts.iter().map(|part| format!("{}_{part}", field.name)).chain(single);
            names.map(|name| (name, field.unit.clone())).collect::<Vec<_>>()
        });
        own.chain(fields).collect()
    }

    fn names(&self) -> Vec<(&str, &str)> {
        self.columns.iter().map(|(name, unit)| (name.as_str(), unit.as_str())).collect()
    }

    fn row(&self, frame: &Frame, index: usize) -> Vec<f64> {
        let mut row = Vec::new();
        for field in self.fields.iter().filter_map(|name| frame.get(name)) {
            let parts = self.parts(&field.values);
            match &field.values {
                Values::Scalar(values) => row.push(values[index]),
                Values::Single(values) => row.push(f64::from(values[index])),
                Values::Index(values) => row.push(f64::from(values[index])),
                Values::Vector(values) => row.extend_from_slice(&values[index][..parts.len()]),
                Values::Tensor(values) => {
                    let entry = |part: &&str| ENTRIES.iter().position(|entry| entry == part);
                    row.extend(parts.iter().filter_map(entry).map(|entry| values[index][entry]));
                }
            }
        }
        row
    }
}

impl Observer for TracksObserver {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let frame = self.frame(simulation);
        let time = simulation.clock().time();
        self.last_step = Some(simulation.clock().step());
        let Some(Values::Index(ids)) = frame.get("id").map(|field| &field.values) else {
            return Ok(Flow::Continue);
        };
        let Location::Points(points) = simulation.solver().location() else { return Ok(Flow::Continue) };
        let Values::Vector(points) = Values::from(points) else { return Ok(Flow::Continue) };
        let mut found: Vec<(u32, usize)> = ids
            .iter()
            .zip(0..)
            .map(|(&id, index)| (id, index))
            .filter(|(id, _)| self.chosen.holds(*id))
            .collect();
        // Grains are sorted in memory now and then; rows are by their stable identifiers.
        found.sort_unstable();
        for (id, index) in found {
            let mut row = vec![time, f64::from(id)];
            row.extend_from_slice(&points[index][..self.axes]);
            row.extend(self.row(&frame, index));
            if let Some(writer) = &mut self.writer {
                writer.row(&row)?;
            }
        }
        Ok(Flow::Continue)
    }

    fn finish(&mut self, simulation: &Simulation) -> Result<(), ObserverError> {
        if self.last_step != Some(simulation.clock().step()) {
            self.observe(simulation)?;
        }
        if let Some(writer) = &mut self.writer {
            writer.sync()?;
        }
        Ok(())
    }

    fn save(&self, to: &mut Section) {
        to.put_one("bytes", self.writer.as_ref().map_or(0, TableWriter::position));
        to.put_one("last step", self.last_step.unwrap_or(u64::MAX));
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let bytes: u64 = from.one("bytes")?;
        self.last_step = Some(from.one("last step")?).filter(|&step| step != u64::MAX);
        self.writer = Some(TableWriter::reopen_at(&self.path, &self.names(), bytes)?);
        Ok(())
    }
}
