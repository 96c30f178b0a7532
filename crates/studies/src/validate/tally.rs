//! How many rows passed.

use super::row::Row;

/// Rows counted by what became of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    /// Rows that must pass.
    pub(super) required: usize,
    /// Those of them that do.
    pub(super) passed: usize,
    /// Claims that are judged.
    pub(super) claims: usize,
    /// Those of them that are met.
    pub(super) met: usize,
    /// Claims that were measured on too few grains to be judged.
    pub(super) small: usize,
}

impl Tally {
    pub(super) fn of(rows: &[Row]) -> Self {
        let count = |is: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| is(row)).count();
        let is_claim = |row: &Row| !row.gate && row.judged;
        Self {
            required: count(&|row| row.gate),
            passed: count(&|row| row.gate && row.pass),
            claims: count(&is_claim),
            met: count(&|row| is_claim(row) && row.pass),
            small: count(&|row| !row.judged),
        }
    }
}
