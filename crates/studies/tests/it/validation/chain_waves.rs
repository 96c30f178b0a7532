//! Waves on a chain of disks.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("chain_waves");
}
