//! Files for ParaView: points (`.vtp`), grids (`.vti`) and collections over time (`.pvd`).
//!
//! The XML files carry their numbers raw in little-endian order. All have the time \[s\] as
//! `TimeValue`, the numbers of the frame, and a text array `units` with one `name: unit` a field.

mod collection;
mod element;
mod read;
mod read_grid;
mod xml;

pub use collection::Collection;
pub use read::{Points, read_vtp};
pub use read_grid::{GridFields, read_vti};

use crate::error::IoError;
use crate::frame::{Field, Frame, Grid, coordinates};
use granular_core::Location;
use std::path::{Path, PathBuf};
use xml::{Array, Document};

/// Writes points with their fields as a `.vtp` file with one vertex a point. `time` is in
/// seconds.
///
/// # Errors
/// When `location` is a grid, a field does not have one value per point, or the file cannot be
/// written; an old file of this path stays.
pub fn write_vtp(path: &Path, location: &Location<'_>, frame: &Frame, time: f64) -> Result<(), IoError> {
    let points = coordinates(path, location)?;
    Frame::check(path, frame.fields(), points.len(), "points")?;
    let mut document = Document::new("PolyData");
    document.field_data(frame, frame.fields(), time);
    let n = points.len();
    document.open(&format!("<Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"{n}\">"));
    document.data("PointData", frame.fields());
    document.group("Points", &[("Points", Array::Vectors(&points))]);
    let connectivity: Vec<i64> = (0..n as i64).collect();
    let offsets: Vec<i64> = (1..=n as i64).collect();
    let cells = [("connectivity", Array::Long(&connectivity)), ("offsets", Array::Long(&offsets))];
    document.group("Verts", &cells);
    document.close("</Piece>");
    document.save(path)
}

/// Writes the links of a frame (contacts) as lines between their points in a `.vtp` file of its
/// own, with the link fields as cell data. A link is drawn straight between its points, across
/// the box when they are neighbours through a periodic side. `time` is in seconds.
///
/// # Errors
/// As [`write_vtp`], and when a link names a point that does not exist.
pub fn write_links_vtp(
    path: &Path,
    location: &Location<'_>,
    frame: &Frame,
    time: f64,
) -> Result<(), IoError> {
    let points = coordinates(path, location)?;
    let links = frame.pairs();
    Frame::check(path, frame.link_fields(), links.len(), "links")?;
    if let Some(bad) = links.iter().flatten().find(|&&end| end as usize >= points.len()) {
        let reason = format!("a link names point {bad} of {}", points.len());
        return Err(IoError::new("write", path, reason));
    }
    let mut document = Document::new("PolyData");
    document.field_data(frame, frame.link_fields(), time);
    let (n, lines) = (points.len(), links.len());
    document.open(&format!("<Piece NumberOfPoints=\"{n}\" NumberOfLines=\"{lines}\">"));
    document.data("CellData", frame.link_fields());
    document.group("Points", &[("Points", Array::Vectors(&points))]);
    let connectivity: Vec<i64> = links.iter().flatten().map(|&end| end.into()).collect();
    let offsets: Vec<i64> = (1..=lines as i64).map(|line| 2 * line).collect();
    let cells = [("connectivity", Array::Long(&connectivity)), ("offsets", Array::Long(&offsets))];
    document.group("Lines", &cells);
    document.close("</Piece>");
    document.save(path)
}

/// Writes the cells of a grid with their fields as a `.vti` file, x fastest. One cell along z is
/// the plane: a flat image. `time` is in seconds.
///
/// # Errors
/// When `location` is not a grid, a field does not have one value per cell, or the file cannot be
/// written; an old file of this path stays.
pub fn write_vti(path: &Path, location: &Location<'_>, frame: &Frame, time: f64) -> Result<(), IoError> {
    let grid = Grid::of(path, location)?;
    Frame::check(path, frame.fields(), grid.count(), "cells")?;
    let extent = grid.extent().map(|n| n.to_string()).join(" ");
    let mut document = Document::new(&format!(
        "ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\"",
        xml::numbers(&grid.origin),
        xml::numbers(&grid.spacing)
    ));
    document.field_data(frame, frame.fields(), time);
    document.open(&format!("<Piece Extent=\"{extent}\">"));
    document.data("CellData", frame.fields());
    document.close("</Piece>");
    document.save(path)
}

/// Writes `<stem>.vtp` for points or `<stem>.vti` for a grid into a folder, and returns the path.
///
/// # Errors
/// As [`write_vtp`] and [`write_vti`].
pub fn write_fields(
    folder: &Path,
    stem: &str,
    location: &Location<'_>,
    frame: &Frame,
    time: f64,
) -> Result<PathBuf, IoError> {
    let on_grid = matches!(location, Location::Grid { .. });
    let path = folder.join(format!("{stem}.{}", if on_grid { "vti" } else { "vtp" }));
    let write = if on_grid { write_vti } else { write_vtp };
    write(&path, location, frame, time)?;
    Ok(path)
}

/// One `name: unit` a field and number.
pub(crate) fn units(frame: &Frame, fields: &[Field]) -> Vec<String> {
    let fields = fields.iter().map(|field| format!("{}: {}", field.name, field.unit));
    let numbers = frame.numbers().iter().map(|number| format!("{}: {}", number.name, number.unit));
    fields.chain(numbers).collect()
}
