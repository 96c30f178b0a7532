//! Strength of regular packings.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("regular_packings");
}
