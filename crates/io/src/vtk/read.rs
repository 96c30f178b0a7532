//! Reading back files that this crate wrote, for figures made after a run.

use super::xml::unescaped;
use crate::error::IoError;
use std::fs;
use std::path::Path;

/// What a `.vtp` file of this crate holds, as numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// Time \[s\].
    pub time: f64,
    /// Centres \[m\].
    pub points: Vec<[f64; 3]>,
    /// Pairs of points; none in a file of fields.
    pub links: Vec<[u32; 2]>,
    /// Name, number of components, and values of each field of points or links.
    pub fields: Vec<(String, usize, Vec<f64>)>,
}

impl Points {
    /// One number per point or link: the field itself, or the length of its vectors.
    pub fn magnitude(&self, name: &str) -> Option<Vec<f64>> {
        magnitude(&self.fields, name)
    }
}

pub(super) fn magnitude(fields: &[(String, usize, Vec<f64>)], name: &str) -> Option<Vec<f64>> {
    let (_, components, values) = fields.iter().find(|(field, ..)| field == name)?;
    if *components == 1 {
        return Some(values.clone());
    }
    let length = |vector: &[f64]| vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    Some(values.chunks(*components).map(length).collect())
}

/// Reads a `.vtp` file that [`write_vtp`](super::write_vtp) or
/// [`write_links_vtp`](super::write_links_vtp) wrote.
///
/// # Errors
/// When the file cannot be read or is of another kind.
pub fn read_vtp(path: &Path) -> Result<Points, IoError> {
    let Content { head, time, arrays } = Content::read(path, "PolyData")?;
    let mut read = Points { time, ..Points::default() };
    let mut connectivity = Vec::new();
    for (name, components, values) in arrays {
        match name.as_str() {
            "Points" => read.points = values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect(),
            "connectivity" => connectivity = values,
            "offsets" => {}
            _ => read.fields.push((name, components, values)),
        }
    }
    if head.contains("NumberOfLines=") {
        read.links = connectivity.chunks_exact(2).map(|pair| [pair[0] as u32, pair[1] as u32]).collect();
    }
    Ok(read)
}

/// The text and the appended arrays of a file.
pub(super) struct Content {
    /// All before the appended data.
    pub(super) head: String,
    /// Time \[s\]; not a number when the file has none.
    pub(super) time: f64,
    /// Name, number of components, and values.
    pub(super) arrays: Vec<(String, usize, Vec<f64>)>,
}

impl Content {
    /// Reads a file whose data set is of `kind`.
    pub(super) fn read(path: &Path, kind: &str) -> Result<Self, IoError> {
        let bytes = fs::read(path).map_err(IoError::on("read", path))?;
        let fail = |reason: &str| IoError::new("read", path, reason.to_owned());
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|window| window == mark);
        let at = at.ok_or_else(|| fail("it is no file of raw appended data"))?;
        let head = std::str::from_utf8(&bytes[..at]).map_err(|_| fail("its head is no text"))?;
        if !head.contains(&format!("<VTKFile type=\"{kind}\"")) {
            return Err(fail(&format!("it holds no {kind}")));
        }
        let blocks = &bytes[at + mark.len()..];
        let mut content = Self { head: head.to_owned(), time: f64::NAN, arrays: Vec::new() };
        for line in head.lines().filter(|line| line.starts_with("<DataArray ")) {
            let name = attribute(line, "Name").ok_or_else(|| fail("an array has no name"))?;
            if let Some(offset) = attribute(line, "offset").and_then(|text| text.parse::<usize>().ok()) {
                let kind = attribute(line, "type").unwrap_or_default();
                let values = block(blocks, offset, &kind).ok_or_else(|| fail("it ends within an array"))?;
                let components = attribute(line, "NumberOfComponents").and_then(|n| n.parse().ok());
                content.arrays.push((name, components.unwrap_or(1).max(1), values));
            } else if name == "TimeValue" {
                let value = line.split('>').nth(1).and_then(|rest| rest.split('<').next());
                content.time = value.and_then(|text| text.trim().parse().ok()).unwrap_or(f64::NAN);
            }
        }
        Ok(content)
    }
}

pub(super) fn attribute(line: &str, name: &str) -> Option<String> {
    let from = line.find(&format!(" {name}=\""))? + name.len() + 3;
    let to = from + line[from..].find('"')?;
    Some(unescaped(&line[from..to]))
}

fn block(blocks: &[u8], offset: usize, kind: &str) -> Option<Vec<f64>> {
    let start = offset.checked_add(8)?;
    let head = blocks.get(offset..start)?;
    let length = usize::try_from(u64::from_le_bytes(head.try_into().ok()?)).ok()?;
    let data = blocks.get(start..start.checked_add(length)?)?;
    let four = |chunk: &[u8]| <[u8; 4]>::try_from(chunk).expect("chunks of four bytes");
    let eight = |chunk: &[u8]| <[u8; 8]>::try_from(chunk).expect("chunks of eight bytes");
    Some(match kind {
        "Float64" => data.chunks_exact(8).map(|chunk| f64::from_le_bytes(eight(chunk))).collect(),
        "Int64" => data.chunks_exact(8).map(|chunk| i64::from_le_bytes(eight(chunk)) as f64).collect(),
        "Float32" => data.chunks_exact(4).map(|chunk| f64::from(f32::from_le_bytes(four(chunk)))).collect(),
        "UInt32" => data.chunks_exact(4).map(|chunk| f64::from(u32::from_le_bytes(four(chunk)))).collect(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Frame;
    use crate::testing::Scratch;
    use granular_core::glam::DVec2;
    use granular_core::{FieldRef, FieldSink, Location};

    #[test]
    fn what_is_written_is_read() {
        let scratch = Scratch::new("read-vtp");
        let path = scratch.path("points.vtp");
        let points = [DVec2::new(1.0, 2.0), DVec2::new(-3.0, 1e-300)];
        let location = Location::Points(FieldRef::Vector2(&points));
        let mut frame = Frame::wanting_all();
        frame.field("radius", "m", FieldRef::Scalar(&[0.5, 0.25]));
        frame.field("velocity", "m/s", FieldRef::Vector2(&[DVec2::new(3.0, 4.0), DVec2::ZERO]));
        frame.links(&[[0, 1]]);
        frame.link_field("normal_force", "N", FieldRef::Scalar(&[7.0]));
        super::super::write_vtp(&path, &location, &frame, 0.125).unwrap();
        let read = read_vtp(&path).unwrap();
        assert_eq!(read.time, 0.125);
        assert_eq!(read.points, [[1.0, 2.0, 0.0], [-3.0, 1e-300, 0.0]]);
        assert_eq!(read.magnitude("velocity").unwrap(), [5.0, 0.0]);
        assert!(read.links.is_empty());
        super::super::write_links_vtp(&path, &location, &frame, 1.0).unwrap();
        let read = read_vtp(&path).unwrap();
        assert_eq!(
            (read.links.as_slice(), read.magnitude("normal_force").unwrap()),
            (&[[0, 1]][..], vec![7.0])
        );
        std::fs::write(&path, b"noise").unwrap();
        assert!(read_vtp(&path).is_err());
    }
}
