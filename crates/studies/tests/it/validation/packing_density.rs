//! Density of the bulk of a column.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("packing_density");
}
