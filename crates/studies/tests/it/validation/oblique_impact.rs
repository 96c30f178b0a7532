//! Gross sliding and sticking.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("oblique_impact");
}
