//! Decaying vortices.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("taylor_green");
}
