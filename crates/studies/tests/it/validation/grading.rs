//! Sizes follow the beta curve.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("grading");
}
