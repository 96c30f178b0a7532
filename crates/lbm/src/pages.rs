//! Memory for populations, in huge pages where the system offers them: a step touches a page per
//! direction and row, more than the table of small pages in a processor holds.

use crate::real::Real;
use std::ops::{Deref, DerefMut};

/// Bytes below which huge pages bring nothing.
#[cfg(target_os = "linux")]
const HUGE: usize = 4 << 20;

/// Numbers, all zero at first.
#[derive(Debug)]
pub(crate) enum Pages<T> {
    Small(Vec<T>),
    #[cfg(target_os = "linux")]
    Huge(memmap2::MmapMut),
}

impl<T: Real> Pages<T> {
    pub(crate) fn zeroed(count: usize) -> Self {
        #[cfg(target_os = "linux")]
        if count * size_of::<T>() >= HUGE
            && let Ok(map) = memmap2::MmapMut::map_anon(count * size_of::<T>())
        {
            // Refused on systems without huge pages, where small ones do.
            let _ = map.advise(memmap2::Advice::HugePage);
            return Self::Huge(map);
        }
        Self::Small(vec![T::default(); count])
    }
}

impl<T: Real> Deref for Pages<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            Self::Small(values) => values,
            #[cfg(target_os = "linux")]
            Self::Huge(map) => bytemuck::cast_slice(map),
        }
    }
}

impl<T: Real> DerefMut for Pages<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            Self::Small(values) => values,
            #[cfg(target_os = "linux")]
            Self::Huge(map) => bytemuck::cast_slice_mut(map),
        }
    }
}
