//! Tables, ParaView files, snapshots and figures for granular simulations.
//!
//! | what | with | read by |
//! |---|---|---|
//! | numbers over time, `.csv` | [`TableWriter`], [`read_table`] | pandas, spreadsheets |
//! | fields at one time, `.vtp` or `.vti` | [`Frame`], [`write_fields`] | ParaView, VTK |
//! | contacts at one time, `.vtp` | [`write_links_vtp`] | ParaView, VTK |
//! | the list of such files, `.pvd` | [`Collection`] | ParaView |
//! | all times in one file, `.vtkhdf` | `VtkHdfPoints`, `VtkHdfGrid` (cargo feature `hdf5`) | ParaView 5.13 |
//! | states to go on from, `.bin` | [`SnapshotStore`], [`state_hash`] | this crate |
//! | triangles of a surface, `.stl` | [`read_stl`] | most drawing programs |
//! | figures, `.svg` and `.png` | [`figure::Chart`], [`figure::Panels`], [`figure::GrainFigure`], [`figure::MapFigure`] | everything |
//! | any other file, whole or not at all | [`write_atomically`] | |
//!
//! A run that is killed goes on as if nothing had happened: `position`, `len` and `steps` of the
//! writers go into the snapshot, and their `reopen_at` drops what was written after it.
//!
//! ```
//! use granular_core::glam::DVec2;
//! use granular_core::{FieldRef, FieldSink, Location, Section};
//! use granular_io::{Collection, Frame, SnapshotStore, write_fields};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let folder = std::env::temp_dir().join(format!("granular-io-{}", std::process::id()));
//!     std::fs::create_dir_all(&folder)?;
//!     let centers = [DVec2::new(0.0, 1e-3), DVec2::new(2e-3, 1e-3)];
//!     let mut frame = Frame::wanting(["radius"]); // a solver shows itself to the frame
//!     frame.field("radius", "m", FieldRef::Scalar(&[1e-3, 1e-3]));
//!     let mut list = Collection::create(&folder.join("grains.pvd"))?;
//!     write_fields(&folder, "grains-0", &Location::Points(FieldRef::Vector2(&centers)), &frame, 0.0)?;
//!     list.push(0.0, "grains-0.vtp")?;
//!     let mut state = Section::new("grains");
//!     state.put("center", &centers);
//!     let store = SnapshotStore::new(&folder);
//!     store.save(0, &[state.clone()])?;
//!     assert_eq!(store.latest()?.sections, [state]);
//!     Ok(std::fs::remove_dir_all(folder)?)
//! }
//! ```
//!
//! # Options
//!
//! | cargo feature | effect |
//! |---|---|
//! | `hdf5` | one temporal `.vtkhdf` file; links the system's HDF5 (Debian: `libhdf5-dev`) |
//! | `hdf5-static` | the same with an HDF5 built from source (CMake 3.26 or newer) |
//!
//! The default build is pure Rust. What a file holds is in its module; the VTK formats are
//! described at <https://docs.vtk.org/en/latest/vtk_file_formats/index.html>.
//!
//! # Limits
//!
//! - Tables hold `f64` only; a whole number above 2⁵³ is rounded.
//! - XML files are not compressed; each file needs its size in memory once more while it is
//!   written. Use `hdf5` for long runs.
//! - Snapshots are read whole into memory, and the next may only be written after the last one is.
//! - A folder is synced to disk on Unix only; elsewhere a power cut may bring back the old file.
//! - One process writes a file at a time; nothing locks it.
//! - Figures are for the plane and have one x and one y axis.

pub mod atomic;
pub mod error;
pub mod figure;
pub mod frame;
pub mod snapshot_file;
pub mod stl;
pub mod table;
#[cfg(test)]
mod testing;
pub mod vtk;
#[cfg(feature = "hdf5")]
pub mod vtkhdf;

pub use atomic::write_atomically;
pub use error::IoError;
pub use figure::Figure;
pub use frame::{Field, Frame, Number, Values};
pub use snapshot_file::{
    Latest, SnapshotStore, hash_hex, read_snapshot, simulation_hash, state_hash, write_snapshot,
};
pub use stl::read_stl;
pub use table::{CsvRow, Table, TableWriter, can_be_a_column, csv_row, csv_rows, read_table};
pub use vtk::{Collection, write_fields, write_links_vtp, write_vti, write_vtp};
#[cfg(feature = "hdf5")]
pub use vtkhdf::{VtkHdfGrid, VtkHdfPoints};
