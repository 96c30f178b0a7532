//! A pile that is pushed.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("slope_impact");
}
