//! A fluid at rest under gravity.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("hydrostatic");
}
