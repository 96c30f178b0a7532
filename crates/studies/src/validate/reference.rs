//! Reference data: columns of the CSV texts of `granular-validation-data`.

use granular_io::{CsvRow, csv_rows};

/// The numbers of some columns, row by row; a cell that is no number is `NaN`.
pub(crate) fn columns<const N: usize>(text: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let (header, rows) = parts(text);
    let places = names.map(|name| place(&header, name));
    let number =
        |row: &CsvRow, place| row.field(place).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN);
    rows.map(|row| places.map(|place| number(&row, place))).collect()
}

/// The number in `column` of the row whose first cell is `name`.
pub(crate) fn named(text: &str, name: &str, column: &str) -> f64 {
    let index = parts(text).1.position(|row| row.field(0) == Some(name));
    columns(text, [column])[index.expect("reference data has the rows of its case")][0]
}

/// The texts of a column, row by row.
pub(crate) fn named_texts(text: &str, column: &str) -> Vec<String> {
    let (header, rows) = parts(text);
    let place = place(&header, column);
    rows.map(|row| row.field(place).unwrap_or_default().to_owned()).collect()
}

/// The header and the rows below it.
fn parts(text: &str) -> (CsvRow, impl Iterator<Item = CsvRow>) {
    let mut rows = csv_rows(text);
    (rows.next().expect("reference data has a header"), rows)
}

fn place(header: &CsvRow, name: &str) -> usize {
    let place = header.fields().position(|column| column == name);
    place.expect("reference data has the columns of its case")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_and_rows_are_found_by_name() {
        let text = "name,a,b,source\nfirst,1,2,\"here, there\"\nsecond,3,x,\n";
        assert_eq!(columns(text, ["b", "a"])[0], [2.0, 1.0]);
        assert!(columns(text, ["b"])[1][0].is_nan());
        assert_eq!(named(text, "second", "a"), 3.0);
        assert_eq!(named_texts(text, "source"), ["here, there", ""]);
    }
}
