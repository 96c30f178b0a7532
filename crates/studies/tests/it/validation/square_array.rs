//! Drag of a square array of disks.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("square_array");
}
