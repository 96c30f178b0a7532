//! The benchmark impacts of Chung and Ooi.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("chung_ooi");
}
