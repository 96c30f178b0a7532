//! A wall in a channel.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("wall_in_channel");
}
