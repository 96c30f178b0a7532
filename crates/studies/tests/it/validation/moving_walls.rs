//! Walls that move.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("moving_walls");
}
