//! Oscillating flow between plates.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("womersley");
}
