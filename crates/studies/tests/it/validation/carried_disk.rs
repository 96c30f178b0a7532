//! A disk carried by a stream.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("carried_disk");
}
