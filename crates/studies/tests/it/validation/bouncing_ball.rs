//! Heights of a bouncing ball.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("bouncing_ball");
}
