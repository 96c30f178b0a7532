//! Element tests from the command: one point of a material of a scene is led along a path.
//!
//! ```
//! use granular_driver::element::{Material, Plan, Test};
//! use granular_driver::scene_file::SceneText;
//!
//! let sand = "(law: MohrCoulomb(young_modulus: \"1.98 MPa\", poisson_ratio: 0.23, friction_angle: \"30 deg\"))";
//! let sand = Material::of_text("sand", &SceneText::new("sand.ron", sand))?;
//! let found = sand.test(Plan { strain: 0.2, ..Plan::of(Test::Triaxial) })?;
//! // k = 3, so that the axial stress exceeds the lateral one by twice its 100 kPa.
//! assert!((found.end().stress / 200e3 - 1.0).abs() < 1e-9);
//! # Ok::<(), granular_driver::failure::Failure>(())
//! ```

mod figure;
mod material;
mod outcome;
mod plan;
#[cfg(test)]
mod tests;

pub use material::Material;
pub use outcome::{Element, Numbers};
pub use plan::{Plan, Test};
