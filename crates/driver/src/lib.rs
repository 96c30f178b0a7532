//! From one scene file to a run: the library behind the `granular` command.
//!
//! A [`scene::Scene`] is read from RON by [`scene_file`], checked and built into a
//! [`model::Model`], and run stage by stage.

#[cfg(feature = "dem")]
pub mod calibrate;
pub mod check;
pub mod column;
pub mod compare;
mod effort;
pub mod failure;
pub mod figures;
pub mod folder;
mod json;
mod lock;
pub mod machine;
#[cfg(any(feature = "dem", feature = "mpm"))]
pub mod material_file;
pub mod methods;
pub mod model;
pub mod observers;
pub mod parallel;
pub mod parts;
pub mod problems;
mod progress;
pub mod records;
pub mod run;
pub mod scene;
pub mod scene_file;
#[cfg(any(feature = "lbm", feature = "mpm"))]
mod solids;
pub mod statistics;
pub mod sweep;
#[cfg(any(feature = "dem", feature = "mpm"))]
mod walls;

pub use effort::Effort;
#[cfg(feature = "mpm")]
pub use methods::mpm::element;

/// Scenes to start from: name and text. The first line of each is a comment that describes it.
pub const TEMPLATES: &[(&str, &str)] = &[
    ("cavity", include_str!("../templates/cavity.ron")),
    ("channel-flow", include_str!("../templates/channel-flow.ron")),
    ("column-collapse", include_str!("../templates/column-collapse.ron")),
    ("continuum-column", include_str!("../templates/continuum-column.ron")),
    ("cylinder", include_str!("../templates/cylinder.ron")),
    ("disk-on-incline", include_str!("../templates/disk-on-incline.ron")),
    ("sample", include_str!("../templates/sample.ron")),
    ("slope-impact", include_str!("../templates/slope-impact.ron")),
    ("two-scales", include_str!("../templates/two-scales.ron")),
];
