//! Columns over their aspect ratio.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("column_studies");
}
