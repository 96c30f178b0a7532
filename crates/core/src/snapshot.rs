//! Named arrays that hold the state of a solver, a coupling or an observer.
//!
//! A [`Section`] is a small map from names to little-endian arrays. It knows nothing of files;
//! `granular-io` writes sections with checksums. What a section holds is what matters for the
//! rest of a run: lists and scratch that can be rebuilt do not belong here.

use glam::{DVec2, DVec3};
use std::fmt;

/// Why a state could not be saved or restored.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotError {
    /// The section or entry is not there.
    Missing {
        /// Section and entry.
        place: String,
    },
    /// The section or entry does not hold what is expected there.
    Damaged {
        /// Section and entry.
        place: String,
        /// What was found instead.
        found: String,
    },
    /// The file could not be read or written.
    File {
        /// File.
        place: String,
        /// Message of the system.
        reason: String,
    },
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { place } => write!(f, "the snapshot has no section `{place}`"),
            Self::Damaged { place, found } => {
                write!(f, "section `{place}` of the snapshot is damaged: {found}")
            }
            Self::File { place, reason } => write!(f, "snapshot file `{place}`: {reason}"),
        }
    }
}

impl std::error::Error for SnapshotError {}

/// Values that can be stored in a [`Section`], in little-endian order.
pub trait Stored: Copy {
    /// Bytes of one value.
    const BYTES: usize;
    /// Appends the bytes.
    fn write(self, to: &mut Vec<u8>);
    /// Reads from exactly [`Stored::BYTES`] bytes.
    fn read(from: &[u8]) -> Self;
}

macro_rules! store_number {
    ($($number:ty),*) => {$(
        impl Stored for $number {
            const BYTES: usize = size_of::<$number>();
            fn write(self, to: &mut Vec<u8>) {
                to.extend_from_slice(&self.to_le_bytes());
            }
            fn read(from: &[u8]) -> Self {
                Self::from_le_bytes(from.try_into().expect("the caller passes BYTES bytes"))
            }
        }
    )*};
}
store_number!(f64, f32, u64, u32, u8);

impl Stored for () {
    const BYTES: usize = 0;
    fn write(self, _: &mut Vec<u8>) {}
    fn read(_: &[u8]) -> Self {}
}

impl<T: Stored, const N: usize> Stored for [T; N] {
    const BYTES: usize = N * T::BYTES;
    fn write(self, to: &mut Vec<u8>) {
        for value in self {
            value.write(to);
        }
    }
    fn read(from: &[u8]) -> Self {
        std::array::from_fn(|i| T::read(&from[i * T::BYTES..(i + 1) * T::BYTES]))
    }
}

impl<A: Stored, B: Stored> Stored for (A, B) {
    const BYTES: usize = A::BYTES + B::BYTES;
    fn write(self, to: &mut Vec<u8>) {
        self.0.write(to);
        self.1.write(to);
    }
    fn read(from: &[u8]) -> Self {
        let (first, second) = from.split_at(A::BYTES);
        (A::read(first), B::read(second))
    }
}

impl Stored for DVec2 {
    const BYTES: usize = 16;
    fn write(self, to: &mut Vec<u8>) {
        self.to_array().write(to);
    }
    fn read(from: &[u8]) -> Self {
        <[f64; 2]>::read(from).into()
    }
}

impl Stored for DVec3 {
    const BYTES: usize = 24;
    fn write(self, to: &mut Vec<u8>) {
        self.to_array().write(to);
    }
    fn read(from: &[u8]) -> Self {
        <[f64; 3]>::read(from).into()
    }
}

/// Named arrays, in the order in which they were put.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Section {
    name: String,
    entries: Vec<(String, Vec<u8>)>,
}

impl Section {
    /// An empty section.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), entries: Vec::new() }
    }

    /// Name of the section.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Adds an array under a name that is not taken yet.
    pub fn put<T: Stored>(&mut self, name: &str, values: &[T]) {
        debug_assert!(self.entries.iter().all(|(n, _)| n != name), "entry `{name}` is put twice");
        let mut bytes = Vec::with_capacity(values.len() * T::BYTES);
        for &value in values {
            value.write(&mut bytes);
        }
        self.entries.push((name.to_owned(), bytes));
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
        self.entries.push((name.to_owned(), bytes));
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
mod tests {
    use super::*;

    #[test]
    fn what_is_put_comes_back_and_the_rest_is_named() {
        let mut section = Section::new("grains");
        section.put("position", &[DVec2::new(1.0, f64::MIN_POSITIVE), DVec2::new(-0.0, 2.0)]);
        section.put_one("step", 7_u64);
        section.put_text("scene", "μ");
        let back: Vec<DVec2> = section.array_of("position", 2).unwrap();
        assert_eq!(back[1].x.to_bits(), (-0.0_f64).to_bits());
        assert_eq!(section.one::<u64>("step").unwrap(), 7);
        assert_eq!(section.text("scene").unwrap(), "μ");
        let missing = section.one::<u64>("clock").unwrap_err();
        assert_eq!(missing.to_string(), "the snapshot has no section `grains/clock`");
        let wrong = section.array_of::<DVec2>("position", 3).unwrap_err();
        assert!(wrong.to_string().contains("2 values where 3 are expected"));
        assert!(section.array::<DVec3>("position").is_err());
    }
}
