//! Weighted Voronoi diagrams.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("tessellation");
}
