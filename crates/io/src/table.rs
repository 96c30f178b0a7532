//! Tables of numbers as CSV with units in the header.

mod row;

pub use row::{CsvRow, csv_row, csv_rows};

use crate::error::IoError;
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Appends rows of numbers to a CSV file whose header is `name [unit]`.
///
/// Numbers are written in the shortest form that gives the same `f64` back. `pandas.read_csv`
/// reads them exactly with `float_precision="round_trip"`.
///
/// ```
/// # fn main() -> Result<(), granular_io::IoError> {
/// # let path = std::env::temp_dir().join(format!("doc-table-{}.csv", std::process::id()));
/// let columns = [("time", "s"), ("kinetic_energy", "J")];
/// let mut table = granular_io::TableWriter::create(&path, &columns)?;
/// table.row(&[0.0, 1.5e-7])?;
/// let bytes = table.position(); // goes into the snapshot
/// table.row(&[0.1, 1.25e-7])?;
/// drop(table);
/// // On resume rows after the snapshot are dropped.
/// granular_io::TableWriter::reopen_at(&path, &columns, bytes)?.row(&[0.1, 1.2e-7])?;
/// let table = granular_io::read_table(&path)?;
/// assert_eq!(table.rows, [[0.0, 1.5e-7], [0.1, 1.2e-7]]);
/// # std::fs::remove_file(path).ok();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct TableWriter {
    path: PathBuf,
    file: File,
    columns: usize,
    written: u64,
    pending: Vec<u8>,
    flush_every_row: bool,
}

impl TableWriter {
    /// Starts a file with these columns, each a name and a unit (`-` for a plain number, empty
    /// for none). An old file of this path is replaced.
    ///
    /// # Errors
    /// When the file cannot be written, there is no column, or a name or unit holds a comma,
    /// quote, bracket or line break, or a name is empty or taken twice.
    pub fn create(path: &Path, columns: &[(&str, &str)]) -> Result<Self, IoError> {
        let header = header_line(columns).map_err(IoError::on("write", path))?;
        let file = File::create(path).map_err(IoError::on("create", path))?;
        let mut writer = Self::around(path, file, columns.len(), 0);
        writer.pending = header.into_bytes();
        writer.flush()?;
        Ok(writer)
    }

    /// Opens a file that [`TableWriter::create`] made and drops all after its first `bytes`
    /// bytes, a former [`TableWriter::position`].
    ///
    /// # Errors
    /// When the file cannot be opened, its header is not that of `columns`, or it has no row
    /// that ends at `bytes`.
    pub fn reopen_at(path: &Path, columns: &[(&str, &str)], bytes: u64) -> Result<Self, IoError> {
        let fail = IoError::on("reopen", path);
        let header = header_line(columns).map_err(&fail)?;
        let system = IoError::on("reopen", path);
        let mut file = OpenOptions::new().read(true).write(true).open(path).map_err(&system)?;
        let mut first = String::new();
        BufReader::new(&mut file).take(header.len() as u64).read_line(&mut first).map_err(&system)?;
        if first != header {
            let (found, wanted) = (first.trim_end(), header.trim_end());
            return Err(fail(format!("its header is `{found}` where `{wanted}` is expected")));
        }
        let length = file.metadata().map_err(&system)?.len();
        if bytes < header.len() as u64 || bytes > length {
            return Err(fail(format!("it has {length} bytes and cannot be cut at {bytes}")));
        }
        let mut last = [0];
        file.seek(SeekFrom::Start(bytes - 1)).map_err(&system)?;
        file.read_exact(&mut last).map_err(&system)?;
        if last != [b'\n'] {
            return Err(fail(format!("no row ends at byte {bytes}")));
        }
        file.set_len(bytes).map_err(&system)?;
        Ok(Self::around(path, file, columns.len(), bytes))
    }

    fn around(path: &Path, file: File, columns: usize, written: u64) -> Self {
        let path = path.to_path_buf();
        Self { path, file, columns, written, pending: Vec::new(), flush_every_row: true }
    }

    /// Whether each row goes to the system at once (the default), so that a table can be watched
    /// and survives a crash of the program, or only with [`TableWriter::flush`].
    pub fn flush_every_row(mut self, yes: bool) -> Self {
        self.flush_every_row = yes;
        self
    }

    /// Appends a row.
    ///
    /// # Errors
    /// When there is not one value per column, or the file cannot be written; then the row can
    /// be tried again with [`TableWriter::flush`].
    pub fn row(&mut self, values: &[f64]) -> Result<(), IoError> {
        if values.len() != self.columns {
            let reason = format!("a row of {} values for {} columns", values.len(), self.columns);
            return Err(IoError::new("write", &self.path, reason));
        }
        row::append_row(&mut self.pending, values.iter().map(|&value| shortest(value)));
        if self.flush_every_row || self.pending.len() > 1 << 16 { self.flush() } else { Ok(()) }
    }

    /// Hands all rows to the system.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn flush(&mut self) -> Result<(), IoError> {
        let written = self.file.seek(SeekFrom::Start(self.written));
        let written = written.and_then(|_| self.file.write_all(&self.pending));
        if let Err(error) = written {
            // Half a row must not stay; if even that fails the first error is the one to report.
            let _ = self.file.set_len(self.written);
            return Err(IoError::new("write", &self.path, error));
        }
        self.written += self.pending.len() as u64;
        self.pending.clear();
        Ok(())
    }

    /// Hands all rows to the disk.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn sync(&mut self) -> Result<(), IoError> {
        self.flush()?;
        self.file.sync_data().map_err(IoError::on("write", &self.path))
    }

    /// Length of the file in bytes with all rows so far, for [`TableWriter::reopen_at`].
    pub fn position(&self) -> u64 {
        self.written + self.pending.len() as u64
    }
}

impl Drop for TableWriter {
    fn drop(&mut self) {
        let _ = self.flush();
    }
}

/// Whether a table can have a column of this name.
pub fn can_be_a_column(name: &str) -> bool {
    let bad = name.contains([',', '"', '[', ']', '\n', '\r']) || name.trim() != name;
    !(bad || name.is_empty() || name.starts_with('#'))
}

fn header_line(columns: &[(&str, &str)]) -> Result<String, String> {
    if columns.is_empty() {
        return Err("a table needs a column".to_owned());
    }
    for (i, (name, unit)) in columns.iter().enumerate() {
        if !can_be_a_column(name) || !(unit.is_empty() || can_be_a_column(unit)) {
            return Err(format!("`{name} [{unit}]` cannot be the head of a column"));
        }
        if columns[..i].iter().any(|(taken, _)| taken == name) {
            return Err(format!("column `{name}` is given twice"));
        }
    }
    Ok(csv_row(columns.iter().map(|(name, unit)| match *unit {
        "" => (*name).to_owned(),
        unit => format!("{name} [{unit}]"),
    })))
}

/// The shortest text that reads back as the same number; powers of ten where plain digits would
/// need many zeros.
pub(crate) fn shortest(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        "nan".to_owned()
    } else if size == 0.0 || value.is_infinite() || (1e-4..1e16).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// A table of numbers in memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name and unit of each column; the unit is empty when the header gives none.
    pub columns: Vec<(String, String)>,
    /// Rows, each with one value per column; an empty field is NaN.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// The values of the column of this name.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.columns.iter().position(|(n, _)| n == name)?;
        Some(self.rows.iter().map(|row| row[index]).collect())
    }

    /// The unit of the column of this name.
    pub fn unit(&self, name: &str) -> Option<&str> {
        self.columns.iter().find(|(n, _)| n == name).map(|(_, unit)| unit.as_str())
    }
}

/// Reads a CSV file of numbers with a header. Empty lines and lines that begin with `#` are skipped; fields may be
/// quoted.
///
/// # Errors
/// When the file cannot be read, has no header, or a line does not fit: the message has its
/// number.
pub fn read_table(path: &Path) -> Result<Table, IoError> {
    let fail = IoError::on("read", path);
    let text = fs::read_to_string(path).map_err(|error| fail(error.to_string()))?;
    parse_table(&text).map_err(fail)
}

fn parse_table(text: &str) -> Result<Table, String> {
    let mut rows = csv_rows(text);
    let header = rows.next().ok_or("it has no header line")?;
    let columns: Vec<_> = header.fields().map(name_and_unit).collect();
    let rows = rows.map(|row| numbers(&row, &columns)).collect::<Result<_, _>>()?;
    Ok(Table { columns, rows })
}

fn numbers(row: &CsvRow, columns: &[(String, String)]) -> Result<Vec<f64>, String> {
    let (line, found, wanted) = (row.line(), row.fields().len(), columns.len());
    if found != wanted {
        return Err(format!("line {line} has {found} fields where the header has {wanted}"));
    }
    let values = row.fields().zip(columns).map(|(field, (name, _))| {
        let value = if field.is_empty() { Ok(f64::NAN) } else { field.parse() };
        value.map_err(|_| format!("line {line}, column `{name}`: `{field}` is not a number"))
    });
    values.collect()
}

fn name_and_unit(head: &str) -> (String, String) {
    let split = head.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
    let (name, unit) = split.unwrap_or((head, ""));
    (name.trim().to_owned(), unit.trim().to_owned())
}

#[cfg(test)]
mod tests;
