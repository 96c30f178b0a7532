//! Samples come out as dense as they were asked for.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("sample_densities");
}
