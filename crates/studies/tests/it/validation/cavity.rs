//! A cavity under a moving lid.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("cavity");
}
