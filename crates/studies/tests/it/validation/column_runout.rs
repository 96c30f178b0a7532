//! Run-out of a column.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("column_runout");
}
