//! What a section can hold.

use glam::{DVec2, DVec3};

/// Values that can be stored in a [`Section`](super::Section), in little-endian order.
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
