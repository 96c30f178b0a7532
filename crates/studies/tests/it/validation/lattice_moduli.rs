//! Elastic moduli of lattices.

use super::passes;

#[test]
fn required_rows_pass() {
    passes("lattice_moduli");
}
