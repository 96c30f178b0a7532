//! A plate starts to move.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("couette");
}
