//! All frames of a run in one `.vtkhdf` file (VTKHDF 2.2), for ParaView 5.13 or newer.
//!
//! Needs the cargo feature `hdf5`. A frame counts once the number of steps in the file has been
//! raised, which is done last, so a crash loses at most the frame being written. The file is
//! compressed with shuffle and deflate, which every reader has. To read a file while it is being
//! written, set `HDF5_USE_FILE_LOCKING=FALSE` for the reader. Links are not written; see
//! [`write_links_vtp`](crate::write_links_vtp).
//!
//! The set of fields and numbers is fixed by the first frame; the number of points may change.
//! Units are in the attribute `unit` of each array.

mod dataset;
mod grid;
mod points;
mod steps;

pub use grid::VtkHdfGrid;
pub use points::VtkHdfPoints;

#[cfg(test)]
mod tests;
