//! Memory for populations, in huge pages where the system offers them: a step touches a page per
//! direction and row, more than the table of small pages in a processor holds.

use crate::real::Real;
use std::ops::{Deref, DerefMut};

/// Bytes below which huge pages bring nothing.
#[cfg(target_os = "linux")]
const HUGE: usize = 4 << 20;

/// Numbers as populations lie in memory: in huge pages where there are many and the system has them.
#[derive(Debug)]
pub struct Pages<T>(Kind<T>);

#[derive(Debug)]
enum Kind<T> {
    Small(Vec<T>),
    #[cfg(target_os = "linux")]
    Huge(memmap2::MmapMut),
}

impl<T: Real> Pages<T> {
    /// So many numbers, all zero.
    pub fn zeroed(count: usize) -> Self {
        #[cfg(target_os = "linux")]
        if count * size_of::<T>() >= HUGE
            && let Ok(map) = memmap2::MmapMut::map_anon(count * size_of::<T>())
        {
            // Refused on systems without huge pages, where small ones do.
            let _ = map.advise(memmap2::Advice::HugePage);
            return Self(Kind::Huge(map));
        }
        Self(Kind::Small(vec![T::default(); count]))
    }
}

impl<T: Real> Deref for Pages<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match &self.0 {
            Kind::Small(values) => values,
            #[cfg(target_os = "linux")]
            Kind::Huge(map) => bytemuck::cast_slice(map),
        }
    }
}

impl<T: Real> DerefMut for Pages<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Kind::Small(values) => values,
            #[cfg(target_os = "linux")]
            Kind::Huge(map) => bytemuck::cast_slice_mut(map),
        }
    }
}
