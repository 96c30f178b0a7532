//! Fields of a grid along a line, as rows of a table.

use super::series::Series;
use super::source::Source;
use crate::failure::Failure;
use granular_core::units::Length;
use granular_core::{Flow, Location, Observer, ObserverError, Section, Simulation, SnapshotError};
use granular_io::Frame;
use granular_io::frame::Values;
use std::path::PathBuf;

/// Points on a straight line \[m\].
#[derive(Clone, Debug)]
pub(crate) struct Line {
    points: Vec<[f64; 3]>,
}

impl Line {
    /// Equally spaced from one end to the other.
    pub(crate) fn of(from: &[Length], to: &[Length], points: usize) -> Self {
        let at = |values: &[Length], axis: usize| values.get(axis).map_or(0.0, |x| x.value());
        let last = points.saturating_sub(1).max(1) as f64;
        let point = |k: usize| {
            let share = k as f64 / last;
            std::array::from_fn(|axis| at(from, axis) * (1.0 - share) + at(to, axis) * share)
        };
        Self { points: (0..points).map(point).collect() }
    }

    /// The points.
    pub(crate) fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    fn distance(&self, index: usize) -> f64 {
        let ([a, b, c], [x, y, z]) = (self.points[0], self.points[index]);
        ((x - a).powi(2) + (y - b).powi(2) + (z - c).powi(2)).sqrt()
    }
}

/// Cells around a point with their weights: linear between cell centres, and the parabola through the last three from
/// there to the ends of the grid.
#[derive(Clone, Debug)]
struct Stencil(Vec<(usize, f64)>);

impl Stencil {
    fn at(point: [f64; 3], origin: [f64; 3], spacing: [f64; 3], cells: [usize; 3]) -> Self {
        let mut corners = vec![(0, 1.0)];
        let mut stride = 1;
        for axis in 0..3 {
            let count = cells[axis];
            if count > 1 {
                let place = (point[axis] - origin[axis]) / spacing[axis] - 0.5;
                let along = weights(place, count);
                let step = |(index, weight): (usize, f64)| {
                    along.iter().map(move |(cell, share)| (index + cell * stride, weight * share))
                };
                corners = corners.iter().flat_map(|corner| step(*corner).collect::<Vec<_>>()).collect();
            }
            stride *= count;
        }
        Self(corners)
    }

    fn of(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.0.iter().map(|&(index, weight)| weight * value(index)).sum()
    }
}

/// Cells along an axis with their weights, for a place counted in cells from the centre of the first.
fn weights(place: f64, count: usize) -> Vec<(usize, f64)> {
    let last = (count - 1) as f64;
    if count > 2 && !(0.0..=last).contains(&place) {
        let low = if place < 0.0 { 0 } else { count - 3 };
        let s = place - low as f64;
        let shares = [0.5 * (s - 1.0) * (s - 2.0), -s * (s - 2.0), 0.5 * s * (s - 1.0)];
        return shares.into_iter().enumerate().map(|(k, share)| (low + k, share)).collect();
    }
    let low = place.floor().clamp(0.0, last - 1.0);
    let share = place - low;
    vec![(low as usize, 1.0 - share), (low as usize + 1, share)]
}

/// Appends the fields along a line at each look.
pub(super) struct ProfileObserver {
    series: Series,
    source: Source,
    line: Line,
    stencils: Vec<Stencil>,
    axes: usize,
    fields: Vec<String>,
}

impl ProfileObserver {
    pub(super) fn new(
        path: PathBuf,
        (line, source): (Line, Source),
        fields: &[String],
        simulation: &Simulation,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let Location::Grid { origin, spacing, cells } = source.location(simulation) else {
            return Err(Failure::io(path.display(), "profiles are of fields on a grid"));
        };
        let axes = if cells[2] > 1 { 3 } else { 2 };
        let stencil = |point: &[f64; 3]| Stencil::at(*point, origin, spacing, cells);
        let columns = header(&source.frame(fields, simulation), fields, axes);
        Ok(Self {
            series: Series::new(path, columns, fresh)?,
            stencils: line.points().iter().map(stencil).collect(),
            source,
            line,
            axes,
            fields: fields.to_vec(),
        })
    }

    fn row(&self, frame: &Frame, index: usize, time: f64) -> Vec<f64> {
        let stencil = &self.stencils[index];
        let mut row = vec![time, self.line.distance(index)];
        row.extend_from_slice(&self.line.points()[index][..self.axes]);
        for field in self.fields.iter().filter_map(|name| frame.get(name)) {
            match &field.values {
                Values::Scalar(values) => row.push(stencil.of(|i| values[i])),
                Values::Single(values) => row.push(stencil.of(|i| f64::from(values[i]))),
                Values::Index(values) => row.push(stencil.of(|i| f64::from(values[i]))),
                Values::Vector(values) => {
                    row.extend((0..self.axes).map(|axis| stencil.of(|i| values[i][axis])));
                }
                Values::Tensor(values) => row.push(stencil.of(|i| values[i][0])),
            }
        }
        row
    }
}

/// Names and units of columns: those of vectors have one per axis.
fn header(frame: &Frame, fields: &[String], axes: usize) -> Vec<(String, String)> {
    let own = [("time", "s"), ("distance", "m"), ("x", "m"), ("y", "m"), ("z", "m")];
    let own = own.iter().take(2 + axes).map(|(name, unit)| ((*name).to_owned(), (*unit).to_owned()));
    let fields = fields.iter().filter_map(|name| frame.get(name)).flat_map(|field| {
        let unit = field.unit.clone();
        match field.values {
            Values::Vector(_) => ["x", "y", "z"][..axes]
                .iter()
                .map(|axis| (format!("{}_{axis}", field.name), unit.clone()))
                .collect(),
            _ => vec![(field.name.clone(), unit)],
        }
    });
    own.chain(fields).collect()
}

impl Observer for ProfileObserver {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let (frame, time) = (self.source.frame(&self.fields, simulation), simulation.clock().time());
        for index in 0..self.stencils.len() {
            let row = self.row(&frame, index, time);
            self.series.row(&row)?;
        }
        self.series.looked_at(simulation);
        Ok(Flow::Continue)
    }

    fn finish(&mut self, _: &Simulation) -> Result<(), ObserverError> {
        self.series.sync()
    }

    fn save(&self, to: &mut Section) {
        self.series.save(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.series.restore(from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_is_met_exactly_up_to_the_ends_of_the_grid() {
        let (origin, spacing, cells) = ([1.0, 2.0, -0.05], [0.1; 3], [4, 3, 1]);
        let value = |index: usize| {
            let (x, y) = (index % 4, index / 4);
            3.0 * (1.0 + 0.1 * (x as f64 + 0.5)) - 2.0 * (2.0 + 0.1 * (y as f64 + 0.5))
        };
        for point in [[1.0, 2.0, 0.0], [1.4, 2.3, 0.0], [1.23, 2.11, 0.0], [1.05, 2.15, 0.0]] {
            let found = Stencil::at(point, origin, spacing, cells).of(value);
            assert!((found - (3.0 * point[0] - 2.0 * point[1])).abs() < 1e-13, "{point:?}: {found}");
        }
    }

    #[test]
    fn a_line_has_its_ends() {
        let length = |values: [f64; 2]| values.map(Length::from);
        let line = Line::of(&length([0.0, 1.0]), &length([3.0, 5.0]), 6);
        assert_eq!((line.points()[0], line.points()[5]), ([0.0, 1.0, 0.0], [3.0, 5.0, 0.0]));
        assert_eq!(line.distance(5), 5.0);
    }
}
