//! Turned and turning frames.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("rotating_frame");
}
