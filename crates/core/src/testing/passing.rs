//! The promise on states that are hashed and not kept.

use super::allocator::CountingAllocator;
use super::contract::{Breach, Contract, in_pool, state_of};
use crate::snapshot::{EntrySink, Section};

/// Bytes that passing a state on may ask for, however small the state.
const ROOM: u64 = 12 * 1024;

impl Contract {
    /// A section that passes its entries on, as it is used to hash a state, is given what another keeps, without a copy: less
    /// than a quarter of the bytes are asked for. Needs [`CountingAllocator`] as the global allocator.
    ///
    /// # Errors
    /// When the promise is not kept, or the allocator is not installed.
    pub fn passing_on(&self) -> Result<(), Breach> {
        const WHY: &str = "a state is passed on without a copy";
        in_pool(1, || {
            if !CountingAllocator::is_installed() {
                let found = "install `CountingAllocator` with #[global_allocator] in the test binary";
                return Err(Breach::new(WHY, found));
            }
            let mut solver = (self.build)();
            self.go(solver.as_mut(), self.steps, WHY)?;
            let kept = state_of(solver.as_ref());
            let bytes: u64 = kept.entries().map(|(_, bytes)| bytes.len() as u64).sum();
            let mut section =
                Section::passing_on("solver", Compare { kept, entry: 0, at: 0, differs: false });
            let before = CountingAllocator::bytes_on_this_thread();
            solver.save(&mut section);
            let asked = CountingAllocator::bytes_on_this_thread() - before;
            let compare: Compare = section.into_sink().expect("it is the sink of this section");
            if compare.differs || !compare.is_at_the_end() {
                return Err(Breach::new(
                    WHY,
                    format!("what is passed on differs in entry {}", compare.entry),
                ));
            }
            if asked > ROOM + bytes / 4 {
                return Err(Breach::new(WHY, format!("{asked} bytes are asked for to pass on {bytes}")));
            }
            Ok(())
        })
    }
}

/// Compares what is passed on with what is kept.
struct Compare {
    kept: Section,
    /// Number of the next entry, and of the next byte in the one before.
    entry: usize,
    at: usize,
    differs: bool,
}

impl Compare {
    /// Bytes of the entry that has begun.
    fn expected(&self) -> &[u8] {
        let begun = self.entry.checked_sub(1).and_then(|entry| self.kept.entries().nth(entry));
        begun.map_or(&[], |(_, bytes)| bytes)
    }

    fn is_at_the_end(&self) -> bool {
        self.entry == self.kept.entries().count() && self.at == self.expected().len()
    }
}

impl EntrySink for Compare {
    fn begin(&mut self, name: &str, bytes: u64) -> bool {
        self.differs |= self.at != self.expected().len();
        let next = self.kept.entries().nth(self.entry);
        self.differs |= next.is_none_or(|(other, kept)| other != name || kept.len() as u64 != bytes);
        self.entry += 1;
        self.at = 0;
        true
    }

    fn bytes(&mut self, bytes: &[u8]) {
        let end = self.at + bytes.len();
        self.differs |= self.expected().get(self.at..end) != Some(bytes);
        self.at = end;
    }
}
