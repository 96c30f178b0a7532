//! Critical state of the grains of the thesis.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("critical_state");
}
