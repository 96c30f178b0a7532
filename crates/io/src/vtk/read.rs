//! Reading back files that this crate wrote, for figures made after a run.

use super::element::{Element, elements};
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
    /// Name and unit of each field and number whose unit the file tells.
    pub units: Vec<(String, String)>,
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
    let content = Content::read(path, "PolyData")?;
    let lines = content.element("Piece").and_then(|piece| piece.number::<usize>("NumberOfLines"));
    let mut read = Points { time: content.time, units: content.units(), ..Points::default() };
    let mut connectivity = Vec::new();
    for (name, components, values) in content.arrays {
        match name.as_str() {
            "Points" => read.points = values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect(),
            "connectivity" => connectivity = values,
            "offsets" => {}
            _ => read.fields.push((name, components, values)),
        }
    }
    if lines.is_some_and(|lines| lines > 0) {
        read.links = connectivity.chunks_exact(2).map(|pair| [pair[0] as u32, pair[1] as u32]).collect();
    }
    Ok(read)
}

/// The elements and the appended arrays of a file.
pub(super) struct Content {
    elements: Vec<Element>,
    /// Time \[s\]; not a number when the file has none.
    pub(super) time: f64,
    /// Name, number of components, and values.
    pub(super) arrays: Vec<(String, usize, Vec<f64>)>,
}

impl Content {
    /// Reads a file whose data set is of `kind`.
    pub(super) fn read(path: &Path, kind: &str) -> Result<Self, IoError> {
        let bytes = fs::read(path).map_err(IoError::on("read", path))?;
        Self::of(&bytes, kind).map_err(IoError::on("read", path))
    }

    fn of(bytes: &[u8], kind: &str) -> Result<Self, String> {
        let (head, blocks) = parts(bytes).ok_or("it is not a file with raw appended data")?;
        let head = std::str::from_utf8(head).map_err(|_| "its head is not text")?;
        let elements = elements(head).map_err(|error| error.to_string())?;
        let file = elements.iter().find(|element| element.name == "VTKFile");
        if file.and_then(|file| file.attribute("type")) != Some(kind) {
            return Err(format!("it does not hold {kind}"));
        }
        let layout = ["byte_order", "header_type", "compressor"].map(|name| file?.attribute(name));
        if layout != [Some("LittleEndian"), Some("UInt64"), None] {
            return Err(
                "its numbers are not little-endian, uncompressed and with lengths in UInt64".to_owned()
            );
        }
        let mut content = Self { elements: Vec::new(), time: f64::NAN, arrays: Vec::new() };
        for array in elements.iter().filter(|element| element.name == "DataArray") {
            let name = array.attribute("Name").ok_or("an array has no name")?;
            if let Some(offset) = array.number::<usize>("offset") {
                let kind = array.attribute("type").unwrap_or_default();
                let values = block(blocks, offset, kind).ok_or("it ends within an array")?;
                let components = array.number("NumberOfComponents").unwrap_or(1).max(1);
                content.arrays.push((name.to_owned(), components, values));
            } else if name == "TimeValue" {
                content.time = array.text.trim().parse().unwrap_or(f64::NAN);
            }
        }
        Ok(Self { elements, ..content })
    }

    /// Name and unit of each field and number: texts that end with a zero, as codes of their bytes.
    pub(super) fn units(&self) -> Vec<(String, String)> {
        let is_units = |element: &&Element| element.attribute("Name") == Some("units");
        let Some(array) = self.elements.iter().find(is_units) else { return Vec::new() };
        let bytes: Vec<u8> = array.text.split_whitespace().map_while(|code| code.parse().ok()).collect();
        let texts = bytes.split(|byte| *byte == 0).filter_map(|text| std::str::from_utf8(text).ok());
        // Names may hold what parts them from the unit, units do not.
        let parted = texts.filter_map(|text| text.rsplit_once(": "));
        parted.map(|(name, unit)| (name.to_owned(), unit.to_owned())).collect()
    }

    /// The first element of this name.
    pub(super) fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }
}

/// What stands before the appended data, and the data. These are no XML, so the two are parted first.
fn parts(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let tag = b"<AppendedData";
    let at = bytes.windows(tag.len()).position(|window| window == tag)?;
    let (head, rest) = bytes.split_at(at);
    let end = rest.iter().position(|byte| *byte == b'>')? + 1;
    let (tag, rest) = rest.split_at(end);
    let tag = elements(std::str::from_utf8(tag).ok()?).ok()?;
    let start = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
    let is_raw = tag.first()?.attribute("encoding") == Some("raw") && rest[start] == b'_';
    is_raw.then_some((head, &rest[start + 1..]))
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
        let units = [("radius", "m"), ("velocity", "m/s")].map(|(a, b)| (a.to_owned(), b.to_owned()));
        assert_eq!(read.units, units);
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

    /// The same file as another program might have laid it out.
    #[test]
    fn the_layout_of_the_text_does_not_matter() {
        let scratch = Scratch::new("read-layout");
        let path = scratch.path("points.vtp");
        let points = [DVec2::new(1.0, 2.0), DVec2::new(-3.0, 4.0)];
        let mut frame = Frame::wanting_all();
        frame.field("a \"b\" & <c>", "m", FieldRef::Scalar(&[0.5, 0.25]));
        super::super::write_vtp(&path, &Location::Points(FieldRef::Vector2(&points)), &frame, 0.125).unwrap();
        let read = read_vtp(&path).unwrap();
        assert_eq!(read.magnitude("a \"b\" & <c>").unwrap(), [0.5, 0.25]);
        let bytes = fs::read(&path).unwrap();
        let at = bytes.windows(13).position(|window| window == b"<AppendedData").unwrap();
        let head = std::str::from_utf8(&bytes[..at]).unwrap();
        let head = head
            .replace("?>\n", "?>\n<!-- <DataArray Name=\"none\" offset=\"7\"/> -->")
            .replace("/>\n<DataArray", "  />\t<DataArray")
            .replace("type=\"Float64\" NumberOfComponents=\"3\"", "NumberOfComponents='3'\n  type='Float64'")
            .replace(" format=\"appended\"", "\n format = 'appended'")
            .replace("0.125<", "\n  0.125\n<");
        let rest = String::from("<AppendedData\n encoding = 'raw' >  _").into_bytes();
        let data = &bytes[at + b"<AppendedData encoding=\"raw\">\n_".len()..];
        let same = [head.as_bytes(), &rest, data].concat();
        assert_eq!(Content::of(&same, "PolyData").unwrap().time, 0.125);
        fs::write(&path, &same).unwrap();
        assert_eq!(read_vtp(&path).unwrap(), read);
        let refused = |from: &str, to: &str| {
            let head = head.replace(from, to);
            Content::of(&[head.as_bytes(), &rest, data].concat(), "PolyData").err().unwrap()
        };
        assert!(refused("LittleEndian", "BigEndian").contains("little-endian"));
        assert!(refused("UInt64", "UInt32").contains("UInt64"));
        assert!(
            refused("byte_order", "compressor=\"vtkZLibDataCompressor\" byte_order").contains("uncompressed")
        );
        assert!(refused("</FieldData>", "</FieldDate>").contains("FieldDate"));
        assert_eq!(refused("offset=\"0\"", "offset=\"99999\""), "it ends within an array");
    }
}
