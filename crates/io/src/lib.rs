//! In the making.

pub mod atomic;
pub mod error;
pub mod frame;
pub mod snapshot_file;
pub mod table;
#[cfg(test)]
mod testing;
pub mod vtk;
#[cfg(feature = "hdf5")]
pub mod vtkhdf;

pub use atomic::write_atomically;
pub use error::IoError;
pub use frame::{Field, Frame, Number, Values};
pub use snapshot_file::{Latest, SnapshotStore, hash_hex, read_snapshot, state_hash, write_snapshot};
pub use table::{Table, TableWriter, read_table};
pub use vtk::{Collection, write_fields, write_links_vtp, write_vti, write_vtp};
#[cfg(feature = "hdf5")]
pub use vtkhdf::{VtkHdfGrid, VtkHdfPoints};
