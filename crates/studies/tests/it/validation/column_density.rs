//! Dense and loose columns.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("column_density");
}
