//! Arrays of a page: blocks of base64 that the page decodes when it needs them.

use base64::engine::{Engine, general_purpose::STANDARD};
use std::io::{self, Write};

/// Writes arrays and numbers them.
pub(crate) struct Arrays<'a> {
    to: &'a mut dyn Write,
    count: usize,
}

impl<'a> Arrays<'a> {
    pub(crate) fn new(to: &'a mut dyn Write) -> Self {
        Self { to, count: 0 }
    }

    /// Writes bytes and returns their number, by which the page finds them.
    pub(crate) fn push(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let number = self.count;
        self.count += 1;
        // Base64 has no `<`, so nothing in it can end the element.
        writeln!(
            self.to,
            "<script type=\"text/plain\" id=\"a{number}\">{}</script>",
            STANDARD.encode(bytes)
        )?;
        Ok(number)
    }

    /// Writes numbers in double precision.
    pub(crate) fn numbers(&mut self, values: impl Iterator<Item = f64>) -> io::Result<usize> {
        self.push(&values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
    }
}

/// Bytes in a page for so many bytes of numbers.
pub(crate) fn in_base64(bytes: u64) -> u64 {
    bytes.div_ceil(3) * 4
}
