//! VTK's XML files with raw appended data.

use crate::atomic::write_atomically;
use crate::error::IoError;
use crate::frame::{Field, Frame, Values};
use crate::table::shortest;
use std::io::{self, Write};
use std::path::Path;

/// A borrowed array of a file.
#[derive(Clone, Copy)]
pub(super) enum Array<'a> {
    Double(&'a [f64]),
    Float(&'a [f32]),
    Unsigned(&'a [u32]),
    Long(&'a [i64]),
    Vectors(&'a [[f64; 3]]),
    Tensors(&'a [[f64; 6]]),
}

impl<'a> Array<'a> {
    fn of(values: &'a Values) -> Self {
        match values {
            Values::Scalar(v) => Self::Double(v),
            Values::Single(v) => Self::Float(v),
            Values::Vector(v) => Self::Vectors(v),
            Values::Tensor(v) => Self::Tensors(v),
            Values::Index(v) => Self::Unsigned(v),
        }
    }

    fn kind(self) -> &'static str {
        match self {
            Self::Double(_) => "type=\"Float64\"",
            Self::Float(_) => "type=\"Float32\"",
            Self::Unsigned(_) => "type=\"UInt32\"",
            Self::Long(_) => "type=\"Int64\"",
            Self::Vectors(_) => "type=\"Float64\" NumberOfComponents=\"3\"",
            Self::Tensors(_) => {
                "type=\"Float64\" NumberOfComponents=\"6\" ComponentName0=\"XX\" ComponentName1=\"YY\" \
                 ComponentName2=\"ZZ\" ComponentName3=\"XY\" ComponentName4=\"YZ\" ComponentName5=\"XZ\""
            }
        }
    }

    fn bytes(self) -> Vec<u8> {
        fn all<const N: usize>(values: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
            values.flatten().collect()
        }
        match self {
            Self::Double(v) => all(v.iter().map(|x| x.to_le_bytes())),
            Self::Float(v) => all(v.iter().map(|x| x.to_le_bytes())),
            Self::Unsigned(v) => all(v.iter().map(|x| x.to_le_bytes())),
            Self::Long(v) => all(v.iter().map(|x| x.to_le_bytes())),
            Self::Vectors(v) => all(v.as_flattened().iter().map(|x| x.to_le_bytes())),
            Self::Tensors(v) => all(v.as_flattened().iter().map(|x| x.to_le_bytes())),
        }
    }
}

/// The text of a file and the blocks of numbers that follow it.
pub(super) struct Document {
    kind: String,
    text: String,
    blocks: Vec<Vec<u8>>,
    offset: u64,
}

impl Document {
    /// A file whose data set element is `<kind>`, which may hold attributes.
    pub(super) fn new(kind: &str) -> Self {
        let name = kind.split(' ').next().unwrap_or(kind);
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{name}\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<{kind}>\n"
        );
        Self { kind: name.to_owned(), text, blocks: Vec::new(), offset: 0 }
    }

    pub(super) fn open(&mut self, tag: &str) {
        self.text.push_str(tag);
        self.text.push('\n');
    }

    pub(super) fn close(&mut self, tag: &str) {
        self.open(tag);
    }

    /// Time, numbers and units, as text: they are few.
    pub(super) fn field_data(&mut self, frame: &Frame, fields: &[Field], time: f64) {
        self.open("<FieldData>");
        self.field_number("TimeValue", time);
        for number in frame.numbers() {
            self.field_number(&number.name, number.value);
        }
        let units = super::units(frame, fields);
        let count = units.len();
        if count > 0 {
            let codes = units.iter().flat_map(|unit| unit.bytes().chain([0])).map(|byte| byte.to_string());
            let codes = codes.collect::<Vec<_>>().join(" ");
            self.open(&format!(
                "<Array type=\"String\" Name=\"units\" NumberOfTuples=\"{count}\" format=\"ascii\">{codes}</Array>"
            ));
        }
        self.close("</FieldData>");
    }

    fn field_number(&mut self, name: &str, value: f64) {
        let (name, value) = (escaped(name), shortest(value));
        self.open(&format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{value}</DataArray>"
        ));
    }

    /// Point or cell data; the first vector and scalar are what readers pick at first.
    pub(super) fn data(&mut self, group: &str, fields: &[Field]) {
        let arrays: Vec<_> = fields.iter().map(|f| (f.name.as_str(), Array::of(&f.values))).collect();
        self.group(group, &arrays);
    }

    pub(super) fn group(&mut self, group: &str, arrays: &[(&str, Array<'_>)]) {
        self.open(&format!("<{group}>"));
        for (name, array) in arrays {
            let (kind, name, offset) = (array.kind(), escaped(name), self.offset);
            self.open(&format!(
                "<DataArray {kind} Name=\"{name}\" format=\"appended\" offset=\"{offset}\"/>"
            ));
            let bytes = array.bytes();
            self.offset += 8 + bytes.len() as u64;
            self.blocks.push(bytes);
        }
        self.close(&format!("</{group}>"));
    }

    pub(super) fn save(self, path: &Path) -> Result<(), IoError> {
        write_atomically(path, |to| self.write(to))
    }

    fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        writeln!(to, "{}</{}>", self.text, self.kind)?;
        to.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
        for block in &self.blocks {
            to.write_all(&(block.len() as u64).to_le_bytes())?;
            to.write_all(block)?;
        }
        to.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}

/// Text that may stand in an attribute.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Numbers with spaces between.
pub(super) fn numbers(values: &[f64]) -> String {
    values.iter().map(|&value| shortest(value)).collect::<Vec<_>>().join(" ")
}
