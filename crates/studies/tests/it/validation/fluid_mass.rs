//! Mass of a fluid between walls.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("fluid_mass");
}
