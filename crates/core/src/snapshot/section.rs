//! Sections of a snapshot.

use super::{SnapshotError, Stored};
use std::any::Any;
use std::fmt;

/// Takes the entries of a [`Section`] as they are put, in place of the section: a hash of a state needs no copy of it.
pub trait EntrySink: Any + Send + Sync {
    /// An entry of this name and so many bytes begins. Its bytes follow, in pieces, if they are wanted.
    fn begin(&mut self, name: &str, bytes: u64) -> bool;
    /// The next bytes of the entry.
    fn bytes(&mut self, bytes: &[u8]);
}

/// Named arrays, in the order in which they were put.
#[derive(Default)]
pub struct Section {
    name: String,
    entries: Vec<(String, Vec<u8>)>,
    sink: Option<Box<dyn EntrySink>>,
    /// Bytes on their way to the sink.
    piece: Vec<u8>,
}

/// A copy of what the section holds; of one that passes its entries on, that is nothing.
impl Clone for Section {
    fn clone(&self) -> Self {
        Self { name: self.name.clone(), entries: self.entries.clone(), ..Self::default() }
    }
}

impl PartialEq for Section {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.entries == other.entries
    }
}

impl Eq for Section {}

impl fmt::Debug for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let entries = self.entries.iter().map(|(name, bytes)| (name, bytes.len()));
        f.debug_struct("Section")
            .field("name", &self.name)
            .field("entries", &entries.collect::<Vec<_>>())
            .finish()
    }
}

/// Bytes that a section passes on at once.
const PIECE: usize = 8192;

impl Section {
    /// An empty section.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// A section that keeps nothing and passes all that is put on to a sink.
    pub fn passing_on(name: impl Into<String>, sink: impl EntrySink) -> Self {
        Self { sink: Some(Box::new(sink)), ..Self::new(name) }
    }

    /// Gives the sink back that [`Section::passing_on`] was given; none when there was none or it is of another type.
    pub fn into_sink<S: EntrySink>(self) -> Option<S> {
        let sink: Box<dyn Any> = self.sink?;
        sink.downcast().ok().map(|sink| *sink)
    }

    /// Name of the section.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Adds an array under a name that is not taken yet.
    pub fn put<T: Stored>(&mut self, name: &str, values: &[T]) {
        self.put_each(name, values.len(), |put| values.iter().for_each(|&value| put(value)));
    }

    /// Adds an array of `count` values that lie nowhere as an array: `give` calls its argument with each of them.
    ///
    /// # Panics
    /// When `give` gives another number of values.
    pub fn put_each<T: Stored>(&mut self, name: &str, count: usize, give: impl FnOnce(&mut dyn FnMut(T))) {
        debug_assert!(self.entries.iter().all(|(n, _)| n != name), "entry `{name}` is put twice");
        let total = count * T::BYTES;
        let mut given = 0;
        if let Some(sink) = &mut self.sink {
            if !sink.begin(name, total as u64) {
                return;
            }
            let piece = &mut self.piece;
            give(&mut |value| {
                value.write(piece);
                given += 1;
                if piece.len() >= PIECE {
                    sink.bytes(piece);
                    piece.clear();
                }
            });
            sink.bytes(piece);
            piece.clear();
        } else {
            let mut bytes = Vec::with_capacity(total);
            give(&mut |value| {
                value.write(&mut bytes);
                given += 1;
            });
            self.entries.push((name.to_owned(), bytes));
        }
        assert_eq!(given, count, "entry `{name}` has another number of values than was said");
    }

    /// Adds one value.
    pub fn put_one<T: Stored>(&mut self, name: &str, value: T) {
        self.put(name, &[value]);
    }

    /// Adds a text.
    pub fn put_text(&mut self, name: &str, text: &str) {
        self.put(name, text.as_bytes());
    }

    /// The array of this name, of any length.
    ///
    /// # Errors
    /// When it is missing or its bytes do not divide into values.
    pub fn array<T: Stored>(&self, name: &str) -> Result<Vec<T>, SnapshotError> {
        let place = || format!("{}/{name}", self.name);
        let bytes = self.entries.iter().find(|(n, _)| n == name).map(|(_, bytes)| bytes);
        let bytes = bytes.ok_or_else(|| SnapshotError::Missing { place: place() })?;
        if bytes.len() % T::BYTES.max(1) != 0 {
            let found = format!("{} bytes do not divide into values of {}", bytes.len(), T::BYTES);
            return Err(SnapshotError::Damaged { place: place(), found });
        }
        Ok(bytes.chunks_exact(T::BYTES.max(1)).map(T::read).collect())
    }

    /// The array of this name, which must hold `count` values.
    ///
    /// # Errors
    /// When it is missing or holds another number of values.
    pub fn array_of<T: Stored>(&self, name: &str, count: usize) -> Result<Vec<T>, SnapshotError> {
        let values = self.array(name)?;
        if values.len() != count {
            let found = format!("{} values where {count} are expected", values.len());
            return Err(SnapshotError::Damaged { place: format!("{}/{name}", self.name), found });
        }
        Ok(values)
    }

    /// The one value of this name.
    ///
    /// # Errors
    /// When it is missing or not exactly one.
    pub fn one<T: Stored>(&self, name: &str) -> Result<T, SnapshotError> {
        Ok(self.array_of(name, 1)?[0])
    }

    /// The text of this name.
    ///
    /// # Errors
    /// When it is missing or not UTF-8.
    pub fn text(&self, name: &str) -> Result<String, SnapshotError> {
        String::from_utf8(self.array(name)?).map_err(|error| SnapshotError::Damaged {
            place: format!("{}/{name}", self.name),
            found: error.to_string(),
        })
    }

    /// Names and bytes of all entries, in order.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.entries.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice()))
    }

    /// Adds an entry as it was read from a file.
    pub fn put_bytes(&mut self, name: &str, bytes: Vec<u8>) {
        match &mut self.sink {
            None => self.entries.push((name.to_owned(), bytes)),
            Some(sink) => {
                if sink.begin(name, bytes.len() as u64) {
                    sink.bytes(&bytes);
                }
            }
        }
    }
}

/// Refuses an entry of a solver's section with values that no step would notice, such as the spin of a grain that
/// touches nothing.
///
/// # Errors
/// When it does not fit.
pub fn check_entry(entry: &str, fits: bool) -> Result<(), SnapshotError> {
    if fits {
        return Ok(());
    }
    let found = "a value that is not finite or out of range".to_owned();
    Err(SnapshotError::Damaged { place: format!("solver/{entry}"), found })
}

#[cfg(test)]
mod tests;
