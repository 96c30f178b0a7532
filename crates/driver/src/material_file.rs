//! The file that a calibration leaves for continuum solvers.

use crate::failure::Failure;
use crate::scene::Dimension;
use crate::statistics::mean_and_error;
use serde::{Deserialize, Serialize};

/// A mean over seeds and its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// Mean.
    pub value: f64,
    /// Standard error; zero from one seed, which tells nothing of it.
    pub error: f64,
}

impl Estimate {
    /// Of the values of all seeds.
    pub fn of(values: &[f64]) -> Self {
        let (value, error) = mean_and_error(values);
        Self { value, error: if values.len() > 1 { error } else { 0.0 } }
    }
}

/// `value + slope I`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Value at rest.
    #[serde(rename = "at_rest")]
    pub static_friction: Estimate,
    /// Slope over the inertial number.
    pub slope: Estimate,
}

/// `mu_s + (mu_2 - mu_s) / (1 + I_0 / I)` \[Jop2006\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jop {
    /// `mu_s`.
    pub static_friction: Estimate,
    /// `mu_2`.
    pub dynamic_friction: Estimate,
    /// `I_0`, looked for between 0.01 and 10.
    pub inertial_number: Estimate,
}

/// Means over seeds of one steady flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Normal stress asked for over the modulus of the packing \[-\].
    pub stress_over_modulus: f64,
    /// Normal stress \[Pa; N/m in the plane\].
    pub normal_stress: Estimate,
    /// The same less what the motion of the cell took: the one asked for, but for the looks. Not kept in files.
    #[serde(skip)]
    pub held_stress: Estimate,
    /// Inertial number \[-\].
    pub inertial_number: Estimate,
    /// Shear over normal stress \[-\].
    pub friction: Estimate,
    /// Solid fraction \[-\].
    pub solid_fraction: Estimate,
}

/// A material for continuum solvers, from shear of its grains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialFile {
    /// Version of this format: 1.
    pub version: u32,
    /// Title of the scene.
    pub title: String,
    /// Plane or space: stresses of the plane are per metre of depth.
    pub dimension: Dimension,
    /// Grains in a sample.
    pub grains: usize,
    /// Number of seeds.
    pub seeds: u64,
    /// Density of the grains \[kg/m^3\].
    pub density: f64,
    /// Mean diameter of the grains \[m\].
    pub diameter: f64,
    /// Friction between two grains \[-\].
    pub contact_friction: f64,
    /// Shear over normal stress of slow flow, inertial number below 0.02 \[-\].
    pub critical_friction: Estimate,
    /// Its angle \[degrees\].
    pub critical_angle: Estimate,
    /// Largest friction of a dense sample, slowest shear \[-\].
    pub peak_friction: Estimate,
    /// Largest angle of dilation of a dense sample, slowest shear \[degrees\].
    pub peak_dilation: Estimate,
    /// Friction over the inertial number as a line.
    pub linear: Linear,
    /// Friction over the inertial number as a curve that saturates.
    pub jop: Jop,
    /// Solid fraction over the inertial number as a line.
    pub solid_fraction: Linear,
    /// Young's modulus of the dense sample \[Pa; N/m in the plane\], from compression held sideways.
    pub young_modulus: Estimate,
    /// Poisson's ratio of the dense sample \[-\].
    pub poisson_ratio: Estimate,
    /// Every steady flow.
    pub points: Vec<Point>,
}

impl MaterialFile {
    /// The file as RON.
    ///
    /// # Errors
    /// When a number cannot be written.
    pub fn to_ron(&self) -> Result<String, Failure> {
        let config = ron::ser::PrettyConfig::new().depth_limit(3);
        let text =
            ron::ser::to_string_pretty(self, config).map_err(|error| Failure::io("material", error))?;
        Ok(text + "\n")
    }

    /// From RON.
    ///
    /// # Errors
    /// When the text is not a material of this version.
    pub fn from_ron(text: &str) -> Result<Self, Failure> {
        let file: Self = ron::from_str(text).map_err(|error| Failure::io("material", error))?;
        if file.version != 1 {
            return Err(Failure::Io(format!(
                "material: version {}, but this program reads version 1",
                file.version
            )));
        }
        Ok(file)
    }
}

/// A number for tests.
#[cfg(test)]
fn exact(value: f64) -> Estimate {
    Estimate { value, error: 0.01 }
}

/// A material for tests.
#[cfg(test)]
pub(crate) fn example(dimension: Dimension) -> MaterialFile {
    let point = |level: f64, number: f64| Point {
        stress_over_modulus: level,
        normal_stress: exact(1e3),
        held_stress: Estimate::default(),
        inertial_number: exact(number),
        friction: exact(0.25 + number),
        solid_fraction: exact(0.8 - 0.3 * number),
    };
    let linear = Linear { static_friction: exact(0.25), slope: exact(1.0) };
    MaterialFile {
        version: 1,
        title: "Glass".to_owned(),
        dimension,
        grains: 10,
        seeds: 2,
        density: 2650.0,
        diameter: 1e-3,
        contact_friction: 0.5,
        critical_friction: exact(0.26),
        critical_angle: exact(14.6),
        peak_friction: exact(0.4),
        peak_dilation: exact(10.0),
        linear,
        jop: Jop { static_friction: exact(0.25), dynamic_friction: exact(0.6), inertial_number: exact(0.3) },
        solid_fraction: Linear { static_friction: exact(0.8), slope: exact(-0.3) },
        young_modulus: exact(1e6),
        poisson_ratio: exact(0.3),
        points: vec![point(1e-3, 0.01), point(1e-3, 0.1), point(3e-4, 0.03)],
    }
}
