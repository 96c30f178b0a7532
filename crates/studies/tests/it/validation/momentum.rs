//! Momentum and angular momentum of free collisions.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("momentum");
}
