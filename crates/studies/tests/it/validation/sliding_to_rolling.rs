//! From sliding to rolling.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("sliding_to_rolling");
}
