//! Tables of a run.

use crate::arrays::Arrays;
use crate::folder::Run;
use granular_io::read_table;
use serde_json::{Value, json};
use std::io;

/// Numbers of a table that a page holds at most.
const MOST_NUMBERS: usize = 250_000;

/// Writes the tables of a run: columns with their names and units, each with the number of its array.
pub(crate) fn write(run: &Run, arrays: &mut Arrays<'_>, lacks: &mut Vec<String>) -> io::Result<Vec<Value>> {
    let mut tables = Vec::new();
    for name in run.files_with(".csv") {
        let table = match read_table(&run.path.join(name)) {
            Ok(table) if table.rows.is_empty() => {
                lacks.push(format!("The table {name} has no rows."));
                continue;
            }
            Ok(table) => table,
            Err(error) => {
                lacks.push(format!("The table {name} is left out: {}.", error.reason));
                continue;
            }
        };
        let every = (table.rows.len() * table.columns.len()).div_ceil(MOST_NUMBERS).max(1);
        let last = table.rows.len() - 1;
        let kept: Vec<&Vec<f64>> = table.rows.iter().step_by(every).collect();
        // The last row is how the run ended.
        let end = (!last.is_multiple_of(every)).then(|| &table.rows[last]);
        let mut columns = Vec::new();
        for (k, (column, unit)) in table.columns.iter().enumerate() {
            let array = arrays.numbers(kept.iter().copied().chain(end).map(|row| row[k]))?;
            columns.push(json!({ "name": column, "unit": unit, "array": array }));
        }
        tables.push(json!({ "name": name, "rows": table.rows.len(), "every": every, "columns": columns }));
    }
    if tables.is_empty() {
        lacks.push("The folder holds no table of numbers over time, so there is nothing to plot.".to_owned());
    }
    Ok(tables)
}
