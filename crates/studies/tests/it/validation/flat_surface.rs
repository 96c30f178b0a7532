//! A flat surface of many parts is a plane.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("flat_surface");
}
