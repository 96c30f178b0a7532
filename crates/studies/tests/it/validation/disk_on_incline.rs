//! A disk slips or rolls down an incline.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("disk_on_incline");
}
