//! Tracks of single grains, as rows of a table.

use super::series::Series;
use super::{Failure, Flow, Observer, ObserverError, Section, Simulation, SnapshotError};
use crate::methods::member::Member;
use crate::scene::Chosen;
use granular_core::{FieldRef, Location};
use granular_io::Frame;
use granular_io::frame::Values;
use granular_tessellate::FREE_SURFACE;
use std::path::PathBuf;
use std::sync::Arc;

const AXES: [&str; 3] = ["x", "y", "z"];
const ENTRIES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// One row per chosen grain and look.
pub(super) struct TracksObserver {
    series: Series,
    member: Arc<dyn Member>,
    chosen: Chosen,
    fields: Vec<String>,
    axes: usize,
}

impl TracksObserver {
    pub(super) fn new(
        path: PathBuf,
        (member, simulation): (Arc<dyn Member>, &Simulation),
        chosen: &Chosen,
        fields: &[String],
        fresh: bool,
    ) -> Result<Self, Failure> {
        let axes = match member.solver(simulation).location() {
            Location::Points(FieldRef::Vector2(_)) => 2,
            Location::Points(_) => 3,
            Location::Grid { .. } => return Err(Failure::io(path.display(), "tracks are of grains")),
        };
        let columns = head(&frame(&*member, fields, simulation), fields, axes);
        let series = Series::new(path, columns, fresh)?;
        Ok(Self { series, member, chosen: chosen.clone(), fields: fields.to_vec(), axes })
    }

    fn row(&self, frame: &Frame, index: usize) -> Vec<f64> {
        let mut row = Vec::new();
        for field in self.fields.iter().filter_map(|name| frame.get(name)) {
            let parts = parts(&field.values, self.axes);
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

fn frame(member: &dyn Member, fields: &[String], simulation: &Simulation) -> Frame {
    let mut frame = Frame::wanting(fields.iter().map(String::as_str).chain(["id"]));
    member.show(simulation, FREE_SURFACE, &mut frame);
    frame
}

/// Columns of one field: one per axis of a vector, one per entry of a tensor.
fn parts(values: &Values, axes: usize) -> &'static [&'static str] {
    match values {
        Values::Vector(_) => &AXES[..axes],
        Values::Tensor(_) if axes == 2 => &["xx", "yy", "xy"],
        Values::Tensor(_) => &ENTRIES,
        _ => &[],
    }
}

/// Names and units of all columns.
fn head(frame: &Frame, fields: &[String], axes: usize) -> Vec<(String, String)> {
    let own = [("time", "s"), ("id", "1"), ("x", "m"), ("y", "m"), ("z", "m")];
    let own = own.iter().take(2 + axes).map(|(name, unit)| ((*name).to_owned(), (*unit).to_owned()));
    let fields = fields.iter().filter_map(|name| frame.get(name)).flat_map(|field| {
        let parts = parts(&field.values, axes);
        let single = parts.is_empty().then(|| field.name.clone());
        let names = parts.iter().map(|part| format!("{}_{part}", field.name)).chain(single);
        names.map(|name| (name, field.unit.clone())).collect::<Vec<_>>()
    });
    own.chain(fields).collect()
}

impl Observer for TracksObserver {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let frame = frame(&*self.member, &self.fields, simulation);
        let time = simulation.clock().time();
        self.series.looked_at(simulation);
        let Some(Values::Index(ids)) = frame.get("id").map(|field| &field.values) else {
            return Ok(Flow::Continue);
        };
        let Location::Points(points) = self.member.solver(simulation).location() else {
            return Ok(Flow::Continue);
        };
        let Values::Vector(points) = Values::from(points) else { return Ok(Flow::Continue) };
        let found = ids.iter().zip(0..).map(|(&id, index)| (id, index));
        let mut found: Vec<(u32, usize)> = found.filter(|(id, _)| self.chosen.holds(*id)).collect();
        // Grains are sorted in memory now and then; rows are by their stable identifiers.
        found.sort_unstable();
        for (id, index) in found {
            let mut row = vec![time, f64::from(id)];
            row.extend_from_slice(&points[index][..self.axes]);
            row.extend(self.row(&frame, index));
            self.series.row(&row)?;
        }
        Ok(Flow::Continue)
    }

    fn finish(&mut self, simulation: &Simulation) -> Result<(), ObserverError> {
        if self.series.lacks(simulation) {
            self.observe(simulation)?;
        }
        self.series.sync()
    }

    fn save(&self, to: &mut Section) {
        self.series.save(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.series.restore(from)
    }
}
