//! Shifts of a periodic cell and its stress.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("periodic_cell");
}
