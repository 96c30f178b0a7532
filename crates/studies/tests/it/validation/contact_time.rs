//! Contact time and largest overlap.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("contact_time");
}
