//! Restitution and its order of convergence.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("restitution");
}
