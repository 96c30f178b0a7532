//! The hash of a state that is not copied for it.

use super::{encode_entry_head, encode_head};
use granular_core::{EntrySink, Section, Simulation};
use xxhash_rust::xxh3::Xxh3;

/// The [`state_hash`](super::state_hash) of the sections of a simulation, hashed as they are put: no copy of the state is made.
pub fn simulation_hash(simulation: &Simulation) -> u128 {
    let mut hash = Xxh3::new();
    simulation.each_section(&mut |name, fill| {
        // The number of entries goes before them.
        let mut counting = Section::passing_on(name, Count(0));
        fill(&mut counting);
        let Count(entries) = counting.into_sink().expect("it is the sink of this section");
        let mut head = Vec::new();
        encode_head(name, entries, &mut head).expect("a vector takes all bytes");
        hash.update(&head);
        let mut hashing = Section::passing_on(name, HashedEntries(hash.clone()));
        fill(&mut hashing);
        HashedEntries(hash) = hashing.into_sink().expect("it is the sink of this section");
    });
    hash.digest128()
}

/// Counts entries.
struct Count(usize);

impl EntrySink for Count {
    fn begin(&mut self, _: &str, _: u64) -> bool {
        self.0 += 1;
        false
    }
    fn bytes(&mut self, _: &[u8]) {}
}

/// Hashes entries as they stand in a file.
struct HashedEntries(Xxh3);

impl EntrySink for HashedEntries {
    fn begin(&mut self, name: &str, bytes: u64) -> bool {
        let mut head = Vec::new();
        encode_entry_head(name, bytes, &mut head).expect("a vector takes all bytes");
        self.0.update(&head);
        true
    }
    fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }
}
