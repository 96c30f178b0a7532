//! Reading back `.vti` files that this crate wrote, for figures made after a run.

use super::read::{Content, magnitude};
use crate::error::IoError;
use std::path::Path;

/// What a `.vti` file of this crate holds, as numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GridFields {
    /// Time \[s\].
    pub time: f64,
    /// Lower corner \[m\].
    pub origin: [f64; 3],
    /// Edge lengths of a cell \[m\].
    pub spacing: [f64; 3],
    /// Cells along each axis; 1 along z in the plane.
    pub cells: [usize; 3],
    /// Name, number of components, and values of each field, the cells along x fastest.
    pub fields: Vec<(String, usize, Vec<f64>)>,
    /// Name and unit of each field and number whose unit the file tells.
    pub units: Vec<(String, String)>,
}

impl GridFields {
    /// One number per cell: the field itself, or the length of its vectors.
    pub fn magnitude(&self, name: &str) -> Option<Vec<f64>> {
        magnitude(&self.fields, name)
    }

    /// One number per cell: a component of a field, counted from zero.
    pub fn component(&self, name: &str, axis: usize) -> Option<Vec<f64>> {
        let (_, components, values) = self.fields.iter().find(|(field, ..)| field == name)?;
        (axis < *components).then(|| values.iter().skip(axis).step_by(*components).copied().collect())
    }

    /// The plane of cells number `index` along the axis `normal` (0 to 2) out of one number per
    /// cell, and its cells along the other two axes, of which the first is the fastest: x and y
    /// for a normal along z. `None` when there is no such plane, or not one number per cell.
    pub fn plane(&self, values: &[f64], normal: usize, index: usize) -> Option<(Vec<f64>, [usize; 2])> {
        let strides = [1, self.cells[0], self.cells[0].checked_mul(self.cells[1])?];
        let whole = strides[2].checked_mul(self.cells[2])? == values.len();
        if !(whole && normal < 3 && index < self.cells[normal]) {
            return None;
        }
        let [fast, slow] = [[1, 2], [0, 2], [0, 1]][normal];
        let start = index * strides[normal];
        let row = |j: usize| {
            (0..self.cells[fast]).map(move |i| values[start + j * strides[slow] + i * strides[fast]])
        };
        Some(((0..self.cells[slow]).flat_map(row).collect(), [self.cells[fast], self.cells[slow]]))
    }

    /// Lower left and upper right corner \[m\] of the planes with this normal (0 to 2), along the
    /// same two axes as in [`GridFields::plane`]. Along z for any other number.
    pub fn corners(&self, normal: usize) -> [[f64; 2]; 2] {
        let axes = [[1, 2], [0, 2], [0, 1]][normal.min(2)];
        let end = |k: usize| self.origin[k] + self.cells[k] as f64 * self.spacing[k];
        [axes.map(|k| self.origin[k]), axes.map(end)]
    }
}

/// Reads a `.vti` file that [`write_vti`](super::write_vti) wrote.
///
/// # Errors
/// When the file cannot be read, is of another kind, or a field does not have one value per cell.
pub fn read_vti(path: &Path) -> Result<GridFields, IoError> {
    let content = Content::read(path, "ImageData")?;
    let fail = |reason: String| IoError::new("read", path, reason);
    let image = content.element("ImageData").ok_or_else(|| fail("it has no ImageData".to_owned()))?;
    let three = |name: &str| {
        let found = image.numbers::<f64, 3>(name).filter(|three| three.iter().all(|x| x.is_finite()));
        found.ok_or_else(|| fail(format!("its `{name}` is not three finite numbers")))
    };
    let (origin, spacing) = (three("Origin")?, three("Spacing")?);
    let extent = image.numbers::<usize, 6>("WholeExtent").filter(|e| [e[0], e[2], e[4]] == [0; 3]);
    let extent = extent.ok_or_else(|| fail("its `WholeExtent` does not begin at 0".to_owned()))?;
    // A flat image is one layer of cells.
    let cells = [extent[1], extent[3], extent[5].max(1)];
    let count = cells[0].checked_mul(cells[1]).and_then(|n| n.checked_mul(cells[2]));
    for (name, components, values) in &content.arrays {
        if count.and_then(|count| count.checked_mul(*components)) != Some(values.len()) {
            let [x, y, z] = cells;
            let found = values.len();
            let reason =
                format!("field `{name}` has {found} values of {components} for {x} × {y} × {z} cells");
            return Err(fail(reason));
        }
    }
    let (time, units) = (content.time, content.units());
    Ok(GridFields { time, origin, spacing, cells, fields: content.arrays, units })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Scratch;
    use crate::{Frame, write_vti, write_vtp};
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{FieldRef, FieldSink, Location};

    #[test]
    fn a_plane_that_is_written_is_read() {
        let scratch = Scratch::new("read-vti");
        let path = scratch.path("fluid.vti");
        let (origin, spacing) = ([-0.1, 1e-300, 0.0], [0.1, 0.3, 0.7]);
        let mut frame = Frame::wanting_all();
        let density: Vec<f64> = (0..6).map(|i| 1.0 + f64::from(i) / 3.0).collect();
        let velocity: Vec<DVec2> = (0..6).map(|i| DVec2::new(3.0, 4.0) * f64::from(i)).collect();
        frame.field("density", "kg/m³", FieldRef::Scalar(&density));
        frame.field("velocity <1>", "m/s", FieldRef::Vector2(&velocity));
        frame.field("kind", "-", FieldRef::Index(&[0, 1, 2, 3, 4, u32::MAX]));
        frame.number("TimeValues", "s", 3.0);
        write_vti(&path, &Location::Grid { origin, spacing, cells: [2, 3, 1] }, &frame, 0.125).unwrap();
        let read = read_vti(&path).unwrap();
        assert_eq!((read.time, read.origin, read.spacing), (0.125, origin, spacing));
        assert_eq!(read.cells, [2, 3, 1]);
        let names = read.fields.iter().map(|(name, components, _)| (name.as_str(), *components));
        assert_eq!(names.collect::<Vec<_>>(), [("density", 1), ("velocity <1>", 3), ("kind", 1)]);
        assert_eq!(read.magnitude("density").unwrap(), density);
        assert_eq!(read.magnitude("velocity <1>").unwrap(), [0.0, 5.0, 10.0, 15.0, 20.0, 25.0]);
        assert_eq!(read.component("velocity <1>", 1).unwrap(), [0.0, 4.0, 8.0, 12.0, 16.0, 20.0]);
        assert_eq!(read.component("kind", 0).unwrap()[5], f64::from(u32::MAX));
        assert!(read.component("velocity <1>", 3).is_none() && read.magnitude("none").is_none());
        assert_eq!(read.plane(&density, 2, 0).unwrap(), (density.clone(), [2, 3]));
        assert!(read.plane(&density, 2, 1).is_none() && read.plane(&density, 3, 0).is_none());
        assert!(read.plane(&density[1..], 2, 0).is_none());
    }

    #[test]
    fn a_box_that_is_written_is_read() {
        let scratch = Scratch::new("read-vti-box");
        let path = scratch.path("fluid.vti");
        let (origin, spacing, cells) = ([1.0, 2.0, 3.0], [0.5, 0.25, 2.0], [2, 3, 4]);
        let place: Vec<DVec3> =
            (0..24).map(|i| DVec3::new(f64::from(i % 2), f64::from(i / 2 % 3), f64::from(i / 6))).collect();
        let mut frame = Frame::wanting_all();
        frame.field("place", "-", FieldRef::Vector3(&place));
        write_vti(&path, &Location::Grid { origin, spacing, cells }, &frame, 2.0).unwrap();
        let read = read_vti(&path).unwrap();
        assert_eq!((read.time, read.origin, read.spacing, read.cells), (2.0, origin, spacing, cells));
        let [x, y, z] = [0, 1, 2].map(|axis| read.component("place", axis).unwrap());
        assert_eq!(read.plane(&z, 2, 3).unwrap(), (vec![3.0; 6], [2, 3]));
        assert_eq!(read.plane(&y, 1, 1).unwrap(), (vec![1.0; 8], [2, 4]));
        assert_eq!(read.plane(&x, 1, 2).unwrap().0, [0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0]);
        assert_eq!(read.plane(&y, 0, 1).unwrap().0, [0.0, 1.0, 2.0].repeat(4));
        assert_eq!(read.corners(1), [[1.0, 3.0], [2.0, 11.0]]);
        assert_eq!(read.corners(2), [[1.0, 2.0], [2.0, 2.75]]);
    }

    #[test]
    fn other_files_are_refused() {
        let scratch = Scratch::new("read-vti-other");
        let path = scratch.path("a.vti");
        std::fs::write(&path, b"noise").unwrap();
        assert!(read_vti(&path).unwrap_err().reason.contains("not a file with raw appended data"));
        let frame = Frame::wanting_all();
        write_vtp(&path, &Location::Points(FieldRef::Vector2(&[DVec2::ZERO])), &frame, 0.0).unwrap();
        assert!(read_vti(&path).unwrap_err().reason.contains("it does not hold ImageData"));
        let mut frame = Frame::wanting_all();
        frame.field("density", "kg/m³", FieldRef::Scalar(&[1.0, 2.0]));
        let grid = Location::Grid { origin: [0.0; 3], spacing: [1.0; 3], cells: [2, 1, 1] };
        write_vti(&path, &grid, &frame, 0.0).unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        let extent = b"WholeExtent=\"0 2 ";
        let at = bytes.windows(extent.len()).position(|window| window == extent).unwrap();
        bytes[at + extent.len() - 2] = b'3';
        std::fs::write(&path, bytes).unwrap();
        let reason = read_vti(&path).unwrap_err().reason;
        assert!(reason.contains("`density` has 2 values of 1 for 3 × 1 × 1 cells"), "{reason}");
        assert!(crate::vtk::read_vtp(&path).unwrap_err().reason.contains("it does not hold PolyData"));
    }
}
