//! Coarse graining of grains on a grid.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("coarse_graining");
}
