//! A cylinder in a channel.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("cylinder");
}
