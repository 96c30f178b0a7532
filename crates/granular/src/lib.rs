//! In the making.

pub mod scene_file;
