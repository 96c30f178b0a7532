use super::*;
use crate::testing::Scratch;
use proptest::prelude::*;
use std::fs;

fn sections() -> Vec<Section> {
    let mut grains = Section::new("grains");
    grains.put("position", &[1.0, -0.0, f64::NAN]);
    grains.put_text("law", "μ(I)");
    let mut clock = Section::new("clock");
    clock.put_one("step", 7_u64);
    clock.put::<f64>("none", &[]);
    vec![grains, Section::new(""), clock]
}

fn encoded(sections: &[Section]) -> Vec<u8> {
    let mut bytes = Vec::new();
    encode(sections, &mut bytes).unwrap();
    bytes
}

fn decoded(bytes: &[u8]) -> Result<Vec<Section>, Flaw> {
    decode(bytes, bytes.len() as u64)
}

#[test]
fn what_is_written_comes_back() {
    let folder = Scratch::new("snapshot");
    let path = folder.path("a.bin");
    write_snapshot(&path, &sections()).unwrap();
    assert_eq!(read_snapshot(&path).unwrap(), sections());
    assert_eq!(decoded(&encoded(&[])).unwrap(), []);
    assert_eq!(fs::read(&path).unwrap(), encoded(&sections()));
}

#[test]
fn every_flipped_bit_and_every_cut_is_refused() {
    let good = encoded(&sections());
    for bit in 0..good.len() * 8 {
        let mut bad = good.clone();
        bad[bit / 8] ^= 1 << (bit % 8);
        assert!(decoded(&bad).is_err(), "bit {bit}");
    }
    for length in 0..good.len() {
        assert!(decoded(&good[..length]).is_err(), "{length} bytes");
        // A cut may also hide from the length, as zeros after a power cut do.
        let mut zeros = good.clone();
        zeros[length..].fill(0);
        assert!(decoded(&zeros).is_err(), "zeros from {length}");
    }
    let longer = [good.as_slice(), &[0]].concat();
    assert!(decoded(&longer).is_err());
}

#[test]
fn sections_may_not_be_swapped() {
    let good = sections();
    let swapped = [good[2].clone(), good[1].clone(), good[0].clone()];
    let (a, b) = (encoded(&good), encoded(&swapped));
    let tail = a.len() - 16;
    let mixed = [&b[..tail], &a[tail..]].concat();
    assert!(decoded(&mixed).is_err());
}

#[test]
fn the_message_names_the_section() {
    let folder = Scratch::new("named");
    let path = folder.path("a.bin");
    let mut bytes = encoded(&sections());
    let at = bytes.windows(4).position(|w| w == b"step").unwrap() + 14;
    bytes[at] ^= 1;
    fs::write(&path, &bytes).unwrap();
    let message = read_snapshot(&path).unwrap_err().to_string();
    assert!(message.starts_with("section `clock` of the snapshot is damaged: its checksum"), "{message}");
    assert!(message.contains("a.bin"), "{message}");
    fs::write(&path, b"PK\x03\x04 something else").unwrap();
    assert!(read_snapshot(&path).unwrap_err().to_string().ends_with("it is not a snapshot"));
    bytes[8] = 9;
    fs::write(&path, &bytes).unwrap();
    assert!(read_snapshot(&path).unwrap_err().to_string().contains("format version 9"));
    let missing = read_snapshot(&folder.path("b.bin")).unwrap_err().to_string();
    assert!(missing.contains("b.bin") && missing.contains("No such file"), "{missing}");
}

#[test]
fn the_hash_sees_names_bytes_and_bounds() {
    let good = sections();
    let mut hashes = vec![state_hash(&good), state_hash(&good[..2]), state_hash(&[])];
    for (name, entry, bytes) in [("a", "bc", vec![1]), ("ab", "c", vec![1]), ("a", "bc", vec![1, 0])] {
        let mut section = Section::new(name);
        section.put_bytes(entry, bytes);
        hashes.push(state_hash(&[section]));
    }
    let count = hashes.len();
    hashes.sort_unstable();
    hashes.dedup();
    assert_eq!(hashes.len(), count);
    assert_eq!(hash_hex(10), "0000000000000000000000000000000a");
    assert_eq!(hash_hex(state_hash(&sections())), hash_hex(state_hash(&sections())));
}

#[test]
fn the_two_newest_are_kept_and_a_damaged_one_is_passed_over() {
    let folder = Scratch::new("store");
    let store = SnapshotStore::new(folder.path(""));
    assert!(store.latest().unwrap_err().to_string().contains("holds no snapshot"));
    for step in [5, 100, 2000] {
        let mut state = Section::new("clock");
        state.put_one("step", step);
        store.save(step, &[state]).unwrap();
    }
    assert_eq!(folder.names(), ["snapshot-000000000100.bin", "snapshot-000000002000.bin"]);
    let latest = store.latest().unwrap();
    assert_eq!((latest.step, latest.sections[0].one::<u64>("step").unwrap()), (2000, 2000));
    assert!(latest.warnings.is_empty());

    fs::write(folder.path("snapshot-000000002000.bin"), b"GRANSNAP").unwrap();
    let latest = store.latest().unwrap();
    assert_eq!((latest.step, latest.warnings.len()), (100, 1));
    assert!(latest.warnings[0].contains("snapshot-000000002000.bin"));

    // The run goes on from step 100; what lies ahead of it is void.
    store.save(150, &sections()).unwrap();
    assert_eq!(folder.names(), ["snapshot-000000000100.bin", "snapshot-000000000150.bin"]);
    fs::write(folder.path("snapshot-000000000100.bin"), b"").unwrap();
    fs::write(folder.path("snapshot-000000000150.bin"), b"").unwrap();
    let none = store.latest().unwrap_err().to_string();
    assert!(none.contains("no snapshot can be read") && none.contains("000150"), "{none}");
}

#[test]
fn a_kill_in_mid_write_costs_nothing() {
    let folder = Scratch::new("kill");
    let store = SnapshotStore::new(folder.path(""));
    store.save(1, &sections()).unwrap();
    let half = &encoded(&sections())[..60];
    fs::write(folder.path("snapshot-000000000002.bin.tmp"), half).unwrap();
    fs::write(folder.path("snapshot-000000000003.bin.tmp"), half).unwrap();
    assert_eq!(store.latest().unwrap().step, 1);
    store.save(2, &sections()).unwrap();
    assert_eq!(folder.names(), ["snapshot-000000000001.bin", "snapshot-000000000002.bin"]);
    assert_eq!(store.latest().unwrap().sections, sections());
}

/// Takes so many bytes and then says that the disk is full.
struct FullAfter(usize);

impl Write for FullAfter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        if taken == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(taken) }
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_at_every_byte() {
    for bytes in 0..encoded(&sections()).len() {
        assert!(encode(&sections(), &mut FullAfter(bytes)).is_err(), "{bytes}");
    }
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(
        mut bytes in proptest::collection::vec(any::<u8>(), 0..200),
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8),
        framed: bool,
    ) {
        if framed {
            bytes = encoded(&sections());
            for (index, value) in edits {
                let at = index.index(bytes.len());
                bytes[at] = value;
            }
        }
        if let Ok(read) = decoded(&bytes) {
            prop_assert_eq!(read, sections());
        }
    }
}
