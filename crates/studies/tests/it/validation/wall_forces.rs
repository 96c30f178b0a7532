//! Stress of contacts against forces on walls.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("wall_forces");
}
