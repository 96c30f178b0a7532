//! Vortex streets behind a disk and a square.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("vortex_street");
}
