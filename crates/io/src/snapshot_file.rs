//! Snapshots on disk: sections with checksums, and the two newest of a run.
//!
//! All numbers are little-endian. A text is its length in bytes as `u32` and the bytes.
//!
//! | what | bytes |
//! |---|---|
//! | magic `GRANSNAP` | 8 |
//! | version of the format, 1 | `u32` |
//! | number of sections | `u32` |
//! | length of the file | `u64` |
//! | per section: name | text |
//! | number of entries | `u32` |
//! | per entry: name, length of its bytes, the bytes | text, `u64`, any |
//! | XXH3-128 of the section from its name on | `u128` |
//! | at the end: XXH3-128 of the first 24 bytes and all checksums of sections | `u128` |

use crate::atomic::write_atomically;
use crate::error::IoError;
use granular_core::{Section, SnapshotError};
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use xxhash_rust::xxh3::Xxh3;

mod hash;
mod store;
pub use hash::simulation_hash;
pub use store::{Latest, SnapshotStore};

const MAGIC: &[u8; 8] = b"GRANSNAP";
const VERSION: u32 = 1;
const HEADER: u64 = 24;
const CHECKSUM: u64 = 16;

/// Writes sections to a file, atomically and through to the disk.
///
/// # Errors
/// [`SnapshotError::File`] when the file cannot be written; an old file of this path stays.
pub fn write_snapshot(path: &Path, sections: &[Section]) -> Result<(), SnapshotError> {
    Ok(write_atomically(path, |to| encode(sections, to))?)
}

/// Reads the sections of a file that [`write_snapshot`] wrote.
///
/// # Errors
/// [`SnapshotError::File`] when the file cannot be read or is no snapshot of a known version,
/// [`SnapshotError::Damaged`] with the section when any bit differs from what was written.
pub fn read_snapshot(path: &Path) -> Result<Vec<Section>, SnapshotError> {
    let file = File::open(path).map_err(IoError::on("read", path))?;
    let length = file.metadata().map_err(IoError::on("read", path))?.len();
    decode(BufReader::with_capacity(1 << 16, file), length).map_err(|flaw| flaw.of(path))
}

/// A hash of names and bytes of all sections, in order: equal states have equal hashes on any
/// machine.
pub fn state_hash(sections: &[Section]) -> u128 {
    let mut hashing = Hashing { inner: io::sink(), hash: Xxh3::new() };
    for section in sections {
        encode_section(section, &mut hashing).expect("a sink takes all bytes");
    }
    hashing.hash.digest128()
}

/// A [`state_hash`] as 32 hexadecimal digits.
pub fn hash_hex(hash: u128) -> String {
    format!("{hash:032x}")
}

/// Passes bytes on and hashes them.
struct Hashing<T> {
    inner: T,
    hash: Xxh3,
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = self.inner.write(bytes)?;
        self.hash.update(&bytes[..taken]);
        Ok(taken)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

fn encode(sections: &[Section], mut to: &mut dyn Write) -> io::Result<()> {
    let mut whole = Xxh3::new();
    let mut header = Vec::with_capacity(HEADER as usize);
    header.extend_from_slice(MAGIC);
    header.extend_from_slice(&VERSION.to_le_bytes());
    header.extend_from_slice(&short(sections.len())?.to_le_bytes());
    let bytes: u64 = sections.iter().map(|section| section_bytes(section) + CHECKSUM).sum();
    header.extend_from_slice(&(HEADER + bytes + CHECKSUM).to_le_bytes());
    to.write_all(&header)?;
    whole.update(&header);
    for section in sections {
        let mut hashing = Hashing { inner: &mut to, hash: Xxh3::new() };
        encode_section(section, &mut hashing)?;
        let checksum = hashing.hash.digest128().to_le_bytes();
        to.write_all(&checksum)?;
        whole.update(&checksum);
    }
    to.write_all(&whole.digest128().to_le_bytes())
}

fn encode_section(section: &Section, to: &mut impl Write) -> io::Result<()> {
    encode_head(section.name(), section.entries().count(), to)?;
    for (name, bytes) in section.entries() {
        encode_entry_head(name, bytes.len() as u64, to)?;
        to.write_all(bytes)?;
    }
    Ok(())
}

fn encode_head(name: &str, entries: usize, to: &mut impl Write) -> io::Result<()> {
    write_text(name, to)?;
    to.write_all(&short(entries)?.to_le_bytes())
}

fn encode_entry_head(name: &str, bytes: u64, to: &mut impl Write) -> io::Result<()> {
    write_text(name, to)?;
    to.write_all(&bytes.to_le_bytes())
}

fn section_bytes(section: &Section) -> u64 {
    let entries = section.entries().map(|(name, bytes)| 4 + name.len() as u64 + 8 + bytes.len() as u64);
    4 + section.name().len() as u64 + 4 + entries.sum::<u64>()
}

fn write_text(text: &str, to: &mut impl Write) -> io::Result<()> {
    to.write_all(&short(text.len())?.to_le_bytes())?;
    to.write_all(text.as_bytes())
}

fn short(count: usize) -> io::Result<u32> {
    u32::try_from(count).map_err(|_| io::Error::other(format!("{count} is too many for a snapshot")))
}

/// What is wrong with the bytes of a snapshot.
#[derive(Debug)]
enum Flaw {
    /// It is no snapshot, of an unknown version, or the system refused.
    File(String),
    /// A section is damaged.
    Section { name: String, found: String },
}

impl Flaw {
    fn of(self, path: &Path) -> SnapshotError {
        let place = path.display().to_string();
        match self {
            Self::File(reason) => SnapshotError::File { place, reason },
            Self::Section { name, found } => {
                SnapshotError::Damaged { place: name, found: format!("{found} (file `{place}`)") }
            }
        }
    }
}

/// Reads numbers and texts, and never more bytes than are left: what a damaged file says about
/// lengths is checked before memory is taken.
struct Source<R> {
    inner: R,
    left: u64,
    hash: Xxh3,
}

impl<R: Read> Source<R> {
    fn bytes(&mut self, count: u64) -> Result<Vec<u8>, String> {
        if count > self.left {
            return Err(format!("it asks for {count} bytes where {} are left", self.left));
        }
        let mut bytes = vec![0; usize::try_from(count).map_err(|error| error.to_string())?];
        self.inner.read_exact(&mut bytes).map_err(|error| error.to_string())?;
        self.left -= count;
        self.hash.update(&bytes);
        Ok(bytes)
    }

    fn number<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let bytes = self.bytes(N as u64)?;
        Ok(bytes.try_into().expect("as many bytes as were asked for"))
    }

    fn text(&mut self) -> Result<String, String> {
        let length = u32::from_le_bytes(self.number()?);
        String::from_utf8(self.bytes(length.into())?).map_err(|_| "a name is not UTF-8".to_owned())
    }
}

fn decode(inner: impl Read, length: u64) -> Result<Vec<Section>, Flaw> {
    let mut source = Source { inner, left: length, hash: Xxh3::new() };
    let mut whole = Xxh3::new();
    let count = decode_header(&mut source, length, &mut whole)?;
    let mut sections = Vec::new();
    for index in 0..count {
        source.hash.reset();
        let mut name = format!("number {} of {count}", index + 1);
        let section = decode_section(&mut source, &mut name).and_then(|section| {
            let computed = source.hash.digest128();
            let checksum: [u8; 16] = source.number()?;
            whole.update(&checksum);
            let same = computed == u128::from_le_bytes(checksum);
            if same { Ok(section) } else { Err("its checksum differs".to_owned()) }
        });
        sections.push(section.map_err(|found| Flaw::Section { name, found })?);
    }
    let checksum: [u8; 16] = source.number().map_err(Flaw::File)?;
    if u128::from_le_bytes(checksum) != whole.digest128() || source.left != 0 {
        return Err(Flaw::File("it is damaged: the checksum of the whole differs".to_owned()));
    }
    Ok(sections)
}

fn decode_header(source: &mut Source<impl Read>, length: u64, whole: &mut Xxh3) -> Result<u32, Flaw> {
    let foreign = |_| Flaw::File("it is not a snapshot".to_owned());
    let magic: [u8; 8] = source.number().map_err(foreign)?;
    if &magic != MAGIC {
        return Err(foreign(String::new()));
    }
    let version: [u8; 4] = source.number().map_err(Flaw::File)?;
    if u32::from_le_bytes(version) != VERSION {
        let found = u32::from_le_bytes(version);
        let reason = format!("it has format version {found}; this program reads version {VERSION}");
        return Err(Flaw::File(reason));
    }
    let count: [u8; 4] = source.number().map_err(Flaw::File)?;
    let stated: [u8; 8] = source.number().map_err(Flaw::File)?;
    if u64::from_le_bytes(stated) != length {
        let stated = u64::from_le_bytes(stated);
        return Err(Flaw::File(format!("it is damaged: it has {length} bytes of {stated}")));
    }
    for part in [magic.as_slice(), &version, &count, &stated] {
        whole.update(part);
    }
    Ok(u32::from_le_bytes(count))
}

/// Puts the name of the section in `known` as soon as it is read, for messages.
fn decode_section(source: &mut Source<impl Read>, known: &mut String) -> Result<Section, String> {
    let name = source.text()?;
    known.clone_from(&name);
    let mut section = Section::new(name);
    for _ in 0..u32::from_le_bytes(source.number()?) {
        let name = source.text()?;
        let length = u64::from_le_bytes(source.number()?);
        let bytes = source.bytes(length).map_err(|found| format!("entry `{name}`: {found}"))?;
        section.put_bytes(&name, bytes);
    }
    Ok(section)
}

#[cfg(test)]
mod tests;
