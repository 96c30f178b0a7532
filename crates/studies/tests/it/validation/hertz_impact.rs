//! Impacts of elastic grains, and the order of their restitution.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("hertz_impact");
}
