//! Energy balance of a column collapse.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("energy_balance");
}
