//! Drag of a disk in a channel.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("disk_in_channel");
}
