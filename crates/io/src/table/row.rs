//! Rows of CSV: what all tables of this workspace are written and read with.

use csv::{ReaderBuilder, StringRecord, Trim, WriterBuilder};

/// A row of CSV, with its line break. A field with commas, quotes or line breaks is quoted (RFC 4180).
///
/// ```
/// assert_eq!(granular_io::csv_row(["disks, soft", "0.5"]), "\"disks, soft\",0.5\n");
/// ```
pub fn csv_row(fields: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let mut row = Vec::new();
    append_row(&mut row, fields);
    String::from_utf8(row).expect("fields that are text make a row that is text")
}

/// Appends a row of CSV, with its line break.
pub(super) fn append_row(to: &mut Vec<u8>, fields: impl IntoIterator<Item = impl AsRef<str>>) {
    let mut writer = WriterBuilder::new().buffer_capacity(256).from_writer(to);
    let fields = fields.into_iter().try_for_each(|field| writer.write_field(field.as_ref()));
    let row = fields.and_then(|()| writer.write_record(None::<&[u8]>)).and_then(|()| Ok(writer.flush()?));
    row.expect("a row of any length can be written to memory");
}

/// A row of a CSV file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsvRow {
    line: usize,
    record: StringRecord,
}

impl CsvRow {
    /// Number of the line on which the row begins, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Its fields, without quotes and without blanks around them.
    pub fn fields(&self) -> impl DoubleEndedIterator<Item = &str> + ExactSizeIterator {
        (0..self.record.len()).map(|index| &self.record[index])
    }

    /// The field of this index, from 0.
    pub fn field(&self, index: usize) -> Option<&str> {
        self.record.get(index)
    }
}

/// The rows of a CSV text, the header among them. They may differ in length; empty lines and lines that begin with `#`
/// are skipped, and so is a byte order mark.
///
/// ```
/// let text = "# measured\nlabel,x\n\n\"disks, soft\",0.5\n";
/// let rows: Vec<_> = granular_io::csv_rows(text).collect();
/// assert_eq!(rows[1].line(), 4);
/// assert_eq!(rows[1].fields().collect::<Vec<_>>(), ["disks, soft", "0.5"]);
/// ```
pub fn csv_rows(text: &str) -> impl Iterator<Item = CsvRow> {
    let mut reader = ReaderBuilder::new();
    reader.has_headers(false).flexible(true).comment(Some(b'#')).trim(Trim::All);
    let records = reader.from_reader(text.as_bytes()).into_records();
    let records = records.map(|record| record.expect("text in memory, rows of any length: nothing can fail"));
    let is_blank = |record: &StringRecord| record.len() == 1 && record[0].is_empty();
    records
        .filter(move |record| !is_blank(record))
        .map(|record| CsvRow { line: line_of(&record, text), record })
}

/// The position of a record is that of the lines skipped before it.
fn line_of(record: &StringRecord, text: &str) -> usize {
    let start = record.position().expect("records of a reader have a position");
    let rest = usize::try_from(start.byte()).ok().and_then(|byte| text.get(byte..)).unwrap_or_default();
    let skipped = rest.lines().take_while(|line| line.is_empty() || line.starts_with('#')).count();
    start.line() as usize + skipped
}
