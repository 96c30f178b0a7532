//! Reference data: columns of the CSV texts of `granular-validation-data`.

/// The numbers of some columns, row by row; a cell that is no number is `NaN`.
///
/// Only the last column of a reference may hold text with commas.
pub(crate) fn columns<const N: usize>(text: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let places = names.map(|name| {
        header.iter().position(|column| *column == name).expect("reference data has the columns of its case")
    });
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        places.map(|place| cells.get(place).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN))
    };
    lines.filter(|line| !line.is_empty()).map(row).collect()
}

/// The number in `column` of the row whose first cell is `name`.
pub(super) fn named(text: &str, name: &str, column: &str) -> f64 {
    let index = text.lines().skip(1).position(|line| line.split(',').next() == Some(name));
    columns(text, [column])[index.expect("reference data has the rows of its case")][0]
}

/// The texts of a column, row by row.
pub(super) fn named_texts(text: &str, column: &str) -> Vec<String> {
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default();
    let place = header.split(',').position(|name| name == column);
    let place = place.expect("reference data has the columns of its case");
    lines.map(|line| line.split(',').nth(place).unwrap_or_default().to_owned()).collect()
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
    }
}
