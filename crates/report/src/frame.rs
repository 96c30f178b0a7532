//! Grains, material points or cells at one time, in one form.

use granular_io::vtk::{GridFields, read_vti, read_vtp};
use std::path::Path;

/// What the files of a collection hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Points with their fields.
    Points,
    /// The middle plane of the cells of a grid with this normal (0 to 2).
    Plane { normal: usize },
}

/// One number per point or cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Channel {
    pub(crate) field: String,
    /// `x`, `xy` and so on; empty for the only one.
    pub(crate) component: &'static str,
    pub(crate) unit: String,
    pub(crate) values: Vec<f64>,
}

/// What is seen at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Frame {
    /// Number of points or cells.
    pub(crate) count: usize,
    pub(crate) channels: Vec<Channel>,
    /// Cells along both axes of a plane, and its corners \[m\].
    pub(crate) cells: [usize; 2],
    pub(crate) corners: [[f64; 2]; 2],
    /// Where the plane cuts its normal \[m\].
    pub(crate) cut: f64,
}

/// Name of the channels of places, which no field has.
pub(crate) const PLACE: &str = "\u{0}place";

impl Frame {
    /// Reads a file of a collection.
    pub(crate) fn read(path: &Path, kind: Kind) -> Result<Self, String> {
        match kind {
            Kind::Points => points(path),
            Kind::Plane { normal } => {
                let grid = read_vti(path).map_err(|error| error.reason)?;
                plane(&grid, normal).ok_or_else(|| "its fields do not fit its cells".to_owned())
            }
        }
    }
}

/// Kinds of what a file holds; none when nothing of it is shown.
pub(crate) fn kinds(path: &Path) -> Result<Vec<Kind>, String> {
    if path.extension().is_some_and(|ending| ending == "vti") {
        let grid = read_vti(path).map_err(|error| error.reason)?;
        let normals = if grid.cells[2] > 1 { vec![2, 1, 0] } else { vec![2] };
        return Ok(normals.into_iter().map(|normal| Kind::Plane { normal }).collect());
    }
    let read = read_vtp(path).map_err(|error| error.reason)?;
    Ok(if read.links.is_empty() { vec![Kind::Points] } else { Vec::new() })
}

fn points(path: &Path) -> Result<Frame, String> {
    let read = read_vtp(path).map_err(|error| error.reason)?;
    let count = read.points.len();
    if let Some((name, components, values)) = read.fields.iter().find(|(_, n, v)| v.len() != n * count) {
        let found = values.len() / components;
        return Err(format!("field `{name}` has {found} values for {count} points"));
    }
    let order = order(&read.fields, count);
    let mut channels: Vec<Channel> = (0..3)
        .map(|axis| {
            let values = order.iter().map(|&k| read.points[k][axis]).collect();
            Channel { field: PLACE.to_owned(), component: AXES[axis], unit: "m".to_owned(), values }
        })
        .collect();
    for (name, components, values) in &read.fields {
        let at = |component: usize| order.iter().map(|k| values[k * components + component]).collect();
        channels.extend(parts(name, *components, &read.units, at));
    }
    Ok(Frame { count, channels, ..Frame::default() })
}

/// Points by their identifiers, so that what stays the same for a grain has its place in every frame.
fn order(fields: &[(String, usize, Vec<f64>)], count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    if let Some((.., ids)) = fields.iter().find(|(name, components, _)| name == "id" && *components == 1) {
        order.sort_by(|a, b| ids[*a].total_cmp(&ids[*b]));
    }
    order
}

fn plane(grid: &GridFields, normal: usize) -> Option<Frame> {
    let index = grid.cells[normal] / 2;
    let mut frame = Frame { corners: grid.corners(normal), ..Frame::default() };
    frame.cut = grid.origin[normal] + (index as f64 + 0.5) * grid.spacing[normal];
    for (name, components, values) in &grid.fields {
        let mut channels = Vec::new();
        for component in 0..*components {
            let of_cells: Vec<f64> = values.iter().skip(component).step_by(*components).copied().collect();
            let (cut, cells) = grid.plane(&of_cells, normal, index)?;
            (frame.cells, frame.count) = (cells, cut.len());
            channels.push(cut);
        }
        frame.channels.extend(parts(name, *components, &grid.units, |k| channels[k].clone()));
    }
    Some(frame)
}

const AXES: [&str; 3] = ["x", "y", "z"];
const ENTRIES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// The channels of a field.
fn parts(
    field: &str,
    components: usize,
    units: &[(String, String)],
    at: impl Fn(usize) -> Vec<f64>,
) -> Vec<Channel> {
    let names: &[&'static str] = match components {
        1 => &[""],
        3 => &AXES,
        6 => &ENTRIES,
        // No writer of this workspace makes others.
        _ => &[],
    };
    let unit = units.iter().find(|(name, _)| name == field).map(|(_, unit)| unit.clone()).unwrap_or_default();
    let channel = |(k, component): (usize, &&'static str)| Channel {
        field: field.to_owned(),
        component,
        unit: unit.clone(),
        values: at(k),
    };
    names.iter().enumerate().map(channel).collect()
}
