//! A sphere slips or rolls down an incline.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("ball_on_incline");
}
